//! From the bytes of a glTF file to a scene.

use super::extras::{self, SceneExtras};
use super::glow::Part;
use super::groups::Groups;
use super::material::{Cover, Palette};
use super::nodes::Placed;
use super::notes;
use super::reader::Reader;
use super::source::Source;
use crate::base::colour::luminance;
use crate::base::error::{Error, Result};
use crate::scene::light::Shape;
use crate::scene::{Parts, Scene, Surface};
use crate::sources::overrides::Overrides;
use glam::{DVec3, Vec3};
use std::path::Path;

/// Exposure values beyond this, up or down, overflow f32 on the way to a pixel.
const MOST_EV100: f64 = 60.0;

/// The scene of a glTF file.
///
/// # Errors
/// A file that cannot be read; as [`parse`].
pub fn load(path: &Path, overrides: &Overrides) -> Result<Scene> {
    parse(&Source(path).read()?, path, overrides)
}

/// The scene of a glTF file's bytes; `file` is the name that errors give, and where buffers beside it are looked for.
///
/// # Errors
/// A mistake, or what is not read here, with its field; a buffer beside the file that cannot be read; an override of
/// the seed, the lights or the view, or of the camera by a name that none bears.
pub fn parse(bytes: &[u8], file: &Path, overrides: &Overrides) -> Result<Scene> {
    let source = Source(file);
    if overrides.seed.is_some() {
        return Err(source.wrong("seed", "a glTF file generates nothing: no seed can be given"));
    }
    if overrides.lights.is_some() {
        return Err(
            source.wrong("city", "is missing; a generated city, whose number of lights is to be changed, is asked for")
        );
    }
    if let Some(view) = overrides.view {
        let text = "is missing; views (street, roof, sky) are placed in a recipe's generated city, and a glTF file has cameras";
        return Err(source.wrong("city", format_args!("{text}: `{}` cannot be given", view.name())));
    }
    let divided_by = overrides.lamps_divided_by.unwrap_or(1.0);
    if !(divided_by > 0.0 && divided_by.is_finite()) {
        let text = format_args!("lamps are to be divided by {divided_by}; a number above 0 is asked for");
        return Err(source.wrong("extensions.KHR_lights_punctual", text));
    }
    let container = source.split(bytes)?;
    let document = source.document(container.json)?;
    // Before any buffer is read: some extensions say where those lie.
    Reader { source, document: &document, buffers: &[] }.check()?;
    let buffers = source.buffers(&document, container.chunk)?;
    let mut notes = Vec::new();
    if container.after > 0 {
        notes.push(format!("bytes after the end that the file announces: {}; not read", container.after));
    }
    Reader { source, document: &document, buffers: &buffers }.read(overrides, notes)
}

/// What became of the triangles of textured emitters.
#[derive(Default)]
struct Tally {
    shining: usize,
    dark: usize,
    /// Radiance times area, by what shines and by what is dark.
    light: f64,
    lost: f64,
}

impl Tally {
    fn add(&mut self, part: &Part) {
        let [a, b, c] = part.corners;
        let light = f64::from(luminance(part.radiance) * (b - a).cross(c - a).length());
        let (count, sum) =
            if part.dark { (&mut self.dark, &mut self.lost) } else { (&mut self.shining, &mut self.light) };
        *count += 1;
        *sum += light;
    }

    fn note(&self) -> Option<String> {
        let Self { shining, dark, light, lost } = self;
        let share = if *lost > 0.0 { 100.0 * lost / (light + lost) } else { 0.0 };
        (shining + dark > 0).then(|| {
            format!(
                "emissive textures: their triangles shine in {shining} pieces, each with its mean; {dark} dark pieces \
                 reflect instead ({share:.2} % of the light)"
            )
        })
    }
}

impl Reader<'_> {
    fn read(&self, overrides: &Overrides, mut notes: Vec<String>) -> Result<Scene> {
        self.check_sparse()?;
        let placed = self.placed(&mut notes)?;
        self.check_size(&placed)?;
        let palette = Palette::read(self, &placed, &mut notes)?;
        let bounds = self.bounds(&placed, &palette)?;
        // f32 has 0.1 mm at 1 km.
        let origin = (0.5 * (bounds[0] + bounds[1]) / 1000.0).round() * 1000.0;
        let divided_by = f64::from(overrides.lamps_divided_by.unwrap_or(1.0));
        let mut groups = Groups::default();
        let mut surfaces = Vec::new();
        let mut tally = Tally::default();
        for node in &placed {
            let name = self.document.nodes[node.id as usize].name.as_deref();
            if let Some(light) = self.punctual(node, origin, divided_by)? {
                groups.add(name, light);
            }
            self.triangles(node, origin, &palette, &mut surfaces, &mut tally, &mut |light| groups.add(name, light))?;
        }
        notes.extend(tally.note());
        notes.extend(notes::unused(self.document));
        notes.extend(notes::blender(self.document, overrides.lamps_divided_by.is_some()));
        let (camera, planes) = self.camera(&placed, origin, bounds, overrides, &mut notes)?;
        let (lights, groups) = groups.finish();
        let emitters = lights.iter().filter_map(|light| match light {
            Shape::Triangle { corners, .. } => Some(*corners),
            _ => None,
        });
        notes.extend(planes.note(&camera, surfaces.iter().map(|surface| surface.corners).chain(emitters)));
        let scene = self.scene()?.1;
        let ev100 = extras::read::<SceneExtras>(scene.extras).and_then(|extras| extras.ev100);
        let ev100 = ev100.filter(|ev| ev.abs() <= MOST_EV100).map(|ev| ev as f32);
        Scene::new(Parts {
            name: self.name(scene.name.as_deref()),
            seed: 0,
            origin,
            lights,
            groups,
            materials: palette.finish(&surfaces),
            surfaces,
            camera,
            ev100: overrides.ev100.or(ev100),
            notes,
        })
        .map_err(|error| match error {
            Error::Invalid(message) => self.wrong("", message),
            other => other,
        })
    }

    /// The corners of the box around all triangles that reflect, or do where they are dark, in the world.
    fn bounds(&self, placed: &[Placed], palette: &Palette) -> Result<[DVec3; 2]> {
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        self.pieces(placed, &mut |piece| {
            let reflects = !matches!(palette.cover(self, piece)?, Cover::Emitter { .. });
            for corners in piece.triangles() {
                let corners = corners?;
                if reflects {
                    bounds = corners.iter().fold(bounds, |[low, high], p| [low.min(*p), high.max(*p)]);
                }
            }
            Ok(())
        })?;
        Ok(if bounds[0].is_finite() { bounds } else { [DVec3::ZERO; 2] })
    }

    /// The surfaces and the triangle lights of a node, relative to `origin`.
    fn triangles(
        &self,
        node: &Placed,
        origin: DVec3,
        palette: &Palette,
        surfaces: &mut Vec<Surface>,
        tally: &mut Tally,
        emit: &mut dyn FnMut(Shape),
    ) -> Result<()> {
        let mut emit = |corners: [Vec3; 3], radiance: Vec3, double_sided: bool| {
            emit(Shape::Triangle { corners, radiance });
            if double_sided {
                let [a, b, c] = corners;
                emit(Shape::Triangle { corners: [a, c, b], radiance });
            }
        };
        let mut parts = Vec::new();
        self.pieces(std::slice::from_ref(node), &mut |piece| {
            match palette.cover(self, piece)? {
                Cover::Reflector(material) => {
                    for corners in piece.triangles_from(origin) {
                        surfaces.push(Surface { corners: corners?, material });
                    }
                }
                Cover::Emitter { radiance, double_sided } => {
                    for corners in piece.triangles_from(origin) {
                        emit(corners?, radiance, double_sided);
                    }
                }
                Cover::Glowing { glow, dark, double_sided } => {
                    let glow = &palette.glows.all[glow];
                    for (corners, places) in piece.triangles_from(origin).zip(piece.places(&glow.mapping)?) {
                        palette.glows.cut(glow, corners?, places?, &mut parts);
                        for part in parts.drain(..) {
                            tally.add(&part);
                            if part.dark {
                                surfaces.push(Surface { corners: part.corners, material: dark });
                            } else {
                                emit(part.corners, part.radiance, double_sided);
                            }
                        }
                    }
                }
            }
            Ok(())
        })
    }

    fn check(&self) -> Result<()> {
        let asset = &self.document.asset;
        for (field, version) in [("version", Some(&asset.version)), ("minVersion", asset.min_version.as_ref())] {
            if let Some(version) = version.filter(|version| version.split('.').next() != Some("2")) {
                let shown: String = version.chars().take(20).collect();
                let text = format_args!("\"{shown}\" is given; glTF 2 is read here");
                return Err(self.wrong(format_args!("asset.{field}"), text));
            }
        }
        self.check_extensions()
    }
}
