//! Which camera looks at the scene?

use super::document::{CameraEntry, Perspective};
use super::extras::{CameraExtras, read};
use super::nodes::{Placed, turned, within};
use super::planes::Planes;
use super::reader::Reader;
use crate::base::error::{Error, Result};
use crate::scene::camera::Camera;
use crate::sources::limits::FARTHEST;
use crate::sources::name;
use crate::sources::overrides::Overrides;
use glam::DVec3;
use std::f64::consts::PI;

/// Pixels across and down where nothing says how many, as of a recipe.
const RESOLUTION: (u32, u32) = (240, 135);
/// Most names that an error lists.
const MOST_NAMES: usize = 20;

/// A camera that can be used.
struct Candidate<'a> {
    node: &'a Placed,
    id: u32,
    entry: &'a CameraEntry<'a>,
    perspective: &'a Perspective,
    names: [Option<&'a str>; 2],
}

impl Candidate<'_> {
    fn name(&self) -> String {
        let given = self.names.into_iter().flatten().find_map(name::made_fit);
        given.unwrap_or_else(|| format!("nodes[{}]", self.node.id))
    }
}

impl Reader<'_> {
    /// The camera that `overrides` name, or the first; without any, a view of the whole box from `low` to `high`, the
    /// scene's surfaces; and what its planes cut away elsewhere. What was decided here is told in `notes`.
    pub(super) fn camera(
        &self,
        placed: &[Placed],
        origin: DVec3,
        [low, high]: [DVec3; 2],
        overrides: &Overrides,
        notes: &mut Vec<String>,
    ) -> Result<(Camera, Planes)> {
        let candidates = self.candidates(placed)?;
        let chosen = match &overrides.camera {
            Some(wanted) => Some(self.named(&candidates, wanted, notes)?),
            None => candidates.first(),
        };
        let Some(chosen) = chosen else {
            notes.push("the file has no perspective camera: the view is of the whole scene, from the south".into());
            let (centre, radius) = (0.5 * (low + high) - origin, (0.5 * (high - low).length()).max(1.0));
            // The sphere around everything touches the upper and the lower edge: it fills 60 degrees.
            let eye = centre + DVec3::new(0.0, -0.8, 0.6) * (radius / 30f64.to_radians().sin());
            let (width, height) = overrides.resolution.unwrap_or(RESOLUTION);
            return Camera::new(eye.as_vec3(), centre.as_vec3(), 60.0, width, height)
                .map(|camera| (camera, Planes { near: 0.0, far: f64::INFINITY }))
                .map_err(|error| self.of_camera("cameras", error));
        };
        if overrides.camera.is_none() && candidates.len() > 1 {
            notes.push(format!("of {} cameras the first is used, {}", candidates.len(), chosen.name()));
        }
        let planes = Planes { near: chosen.perspective.znear, far: chosen.perspective.zfar.unwrap_or(f64::INFINITY) };
        Ok((self.view(chosen, origin, overrides)?, planes))
    }

    fn candidates<'a>(&'a self, placed: &'a [Placed]) -> Result<Vec<Candidate<'a>>> {
        let (nodes, cameras) = (&self.document.nodes, &self.document.cameras);
        let mut candidates = Vec::new();
        for node in placed {
            let entry = &nodes[node.id as usize];
            let Some(id) = entry.camera else { continue };
            let camera = cameras
                .get(id as usize)
                .ok_or_else(|| self.no_such("camera", id, cameras.len(), &format_args!("nodes[{}].camera", node.id)))?;
            if let Some(perspective) = &camera.perspective {
                let names = [entry.name.as_deref(), camera.name.as_deref()];
                candidates.push(Candidate { node, id, entry: camera, perspective, names });
            }
        }
        Ok(candidates)
    }

    /// The camera whose node, or else which itself, bears a name.
    fn named<'a, 'b>(
        &self,
        candidates: &'a [Candidate<'b>],
        wanted: &str,
        notes: &mut Vec<String>,
    ) -> Result<&'a Candidate<'b>> {
        for kind in 0..2 {
            let mut found = candidates.iter().filter(|candidate| candidate.names[kind] == Some(wanted));
            if let Some(first) = found.next() {
                let others = found.count();
                if others > 0 {
                    notes.push(format!("{} cameras are called {}: the first is used", others + 1, first.name()));
                }
                return Ok(first);
            }
        }
        let mut known: Vec<String> = candidates.iter().take(MOST_NAMES).map(|c| format!("`{}`", c.name())).collect();
        if candidates.len() > MOST_NAMES {
            known.push(format!("and {} more", candidates.len() - MOST_NAMES));
        }
        let known = if known.is_empty() { "none in perspective".into() } else { known.join(", ") };
        Err(self.wrong("cameras", format_args!("no camera is called `{wanted}`; there are: {known}")))
    }

    fn view(&self, chosen: &Candidate, origin: DVec3, overrides: &Overrides) -> Result<Camera> {
        let Candidate { id, entry, perspective, .. } = *chosen;
        if !(perspective.yfov > 0.0 && perspective.yfov < PI) {
            let text = format_args!("{} is given; an angle between 0 and pi radians is asked for", perspective.yfov);
            return Err(self.wrong(format_args!("cameras[{id}].perspective.yfov"), text));
        }
        let (width, height) = match overrides.resolution {
            Some(resolution) => resolution,
            None => self.film(id, entry, perspective.aspect_ratio)?,
        };
        let to_world = &chosen.node.to_world;
        let eye = turned(to_world.translation) - origin;
        if !within(eye, FARTHEST) {
            let text =
                format_args!("the camera stands at {eye} from the scene's middle {origin}; {FARTHEST} m is the most");
            return Err(self.wrong(format_args!("nodes[{}]", chosen.node.id), text));
        }
        let (forward, up) = (turned(-to_world.matrix3.z_axis), turned(to_world.matrix3.y_axis));
        let fov = perspective.yfov.to_degrees() as f32;
        let camera = Camera::oriented(eye.as_vec3(), forward, up.normalize_or_zero(), fov, width, height);
        camera.map_err(|error| self.of_camera(&format!("cameras[{id}]"), error))
    }

    /// Pixels across and down: those of our own exports, or about the usual number in the camera's proportions.
    fn film(&self, id: u32, entry: &CameraEntry, aspect: Option<f64>) -> Result<(u32, u32)> {
        let exported = read::<CameraExtras>(entry.extras).and_then(|extras| extras.resolution);
        if let Some([width, height]) = exported {
            return Ok((width, height));
        }
        let Some(aspect) = aspect else { return Ok(RESOLUTION) };
        if !(aspect > 1e-3 && aspect < 1e3) {
            let text = format_args!("{aspect} is given; width over height, from 0.001 to 1000, is asked for");
            return Err(self.wrong(format_args!("cameras[{id}].perspective.aspectRatio"), text));
        }
        let height = (f64::from(RESOLUTION.0 * RESOLUTION.1) / aspect).sqrt();
        Ok(((height * aspect).round() as u32, height.round() as u32))
    }

    fn of_camera(&self, field: &str, error: Error) -> Error {
        match error {
            Error::Invalid(message) => self.wrong(field, message),
            other => other,
        }
    }
}
