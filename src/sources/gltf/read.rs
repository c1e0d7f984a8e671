//! From the bytes of a glTF file to a scene.

use super::extras::{self, SceneExtras};
use super::groups::Groups;
use super::material::{Cover, Palette};
use super::nodes::Placed;
use super::notes;
use super::reader::Reader;
use super::source::Source;
use crate::base::error::{Error, Result};
use crate::scene::light::Shape;
use crate::scene::{Parts, Scene, Surface};
use crate::sources::overrides::Overrides;
use glam::DVec3;
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
/// the seed or the lights, or of the camera by a name that none bears.
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
    let (json, chunk) = source.split(bytes)?;
    let document = source.document(json)?;
    let buffers = source.buffers(&document, chunk)?;
    Reader { source, document: &document, buffers: &buffers }.read(overrides)
}

impl Reader<'_> {
    fn read(&self, overrides: &Overrides) -> Result<Scene> {
        self.check_asset()?;
        let palette = Palette::read(self)?;
        let placed = self.placed()?;
        self.check_size(&placed)?;
        let bounds = self.bounds(&placed, &palette)?;
        // f32 has 0.1 mm at 1 km.
        let origin = (0.5 * (bounds[0] + bounds[1]) / 1000.0).round() * 1000.0;
        let mut groups = Groups::default();
        let mut surfaces = Vec::new();
        for node in &placed {
            let name = self.document.nodes[node.id as usize].name.as_deref();
            if let Some(light) = self.punctual(node, origin)? {
                groups.add(name, light);
            }
            self.triangles(node, origin, &palette, &mut surfaces, &mut |light| groups.add(name, light))?;
        }
        let mut notes = notes::unused(self.document);
        let camera = self.camera(&placed, origin, bounds, overrides, &mut notes)?;
        let (lights, groups) = groups.finish();
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

    /// The corners of the box around all reflecting triangles, in the world.
    fn bounds(&self, placed: &[Placed], palette: &Palette) -> Result<[DVec3; 2]> {
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        self.pieces(placed, &mut |piece| {
            let reflects = matches!(piece.cover(palette)?, Cover::Reflector(_));
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
        emit: &mut dyn FnMut(Shape),
    ) -> Result<()> {
        self.pieces(std::slice::from_ref(node), &mut |piece| {
            let cover = piece.cover(palette)?;
            for corners in piece.triangles_from(origin) {
                let corners = corners?;
                match cover {
                    Cover::Reflector(material) => surfaces.push(Surface { corners, material }),
                    Cover::Emitter { radiance, double_sided } => {
                        emit(Shape::Triangle { corners, radiance });
                        if double_sided {
                            let [a, b, c] = corners;
                            emit(Shape::Triangle { corners: [a, c, b], radiance });
                        }
                    }
                }
            }
            Ok(())
        })
    }

    fn check_asset(&self) -> Result<()> {
        let asset = &self.document.asset;
        for (field, version) in [("version", Some(&asset.version)), ("minVersion", asset.min_version.as_ref())] {
            if let Some(version) = version.filter(|version| version.split('.').next() != Some("2")) {
                let shown: String = version.chars().take(20).collect();
                let text = format_args!("\"{shown}\" is given; glTF 2 is read here");
                return Err(self.wrong(format_args!("asset.{field}"), text));
            }
        }
        let required = self.document.extensions_required.iter().enumerate();
        if let Some((i, name)) = required.into_iter().find(|(_, name)| !notes::EXTENSIONS.contains(&name.as_str())) {
            let (shown, known): (String, _) = (name.chars().take(60).collect(), notes::EXTENSIONS.join(", "));
            let text = format_args!("\"{shown}\" is not read here; known are {known}");
            return Err(self.wrong(format_args!("extensionsRequired[{i}]"), text));
        }
        let used = self.document.extensions_used.iter().enumerate();
        if let Some((i, name)) = used.into_iter().find(|(_, name)| notes::CHANGE_THE_LIGHT.contains(&name.as_str())) {
            let text = format_args!("{name} is not read here, and without it the light would be another; remove it");
            return Err(self.wrong(format_args!("extensionsUsed[{i}]"), text));
        }
        Ok(())
    }
}
