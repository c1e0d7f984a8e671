//! Scenes from glTF 2.0 files, `.glb` or `.gltf`.
//!
//! | glTF | here |
//! |---|---|
//! | the scene it names, or the first | the nodes shown; metres, turned from +y up to +z up |
//! | triangles, strips and fans | surfaces; their base colour factor is the albedo of a Lambertian reflector |
//! | emissive materials | triangle lights of factor times `KHR_materials_emissive_strength` in cd/m^2, on the side that is counter-clockwise, or on both if the material is double-sided; they reflect nothing |
//! | `KHR_lights_punctual` | point, spot and directional lights, in cd and lx |
//! | cameras | the one asked for by the name of its node or its own, or the first; without any a view of the whole |
//! | names of nodes that carry lights | light groups, numbers at their end left off |
//!
//! What glTF has no word for is read from `extras` as our exports write it: `ev100` of a scene, `resolution` of a
//! camera in pixels, `street` of a material. What is not used is told in the scene's notes; what could not
//! be ignored without changing the light (textures that emit, sparse accessors, required extensions) is refused.
//!
//! Every mistake is an [`Error::Input`] with the path in the document, `meshes[3].primitives[0].attributes.POSITION`;
//! nothing that a file can say panics or asks for more than about a hundred bytes of memory for each of its own.
//!
//! Positions are worked out in f64 and kept in f32 relative to an origin near the middle of the surfaces.
//!
//! Source: Khronos Group, glTF 2.0 specification, 2021; `KHR_lights_punctual`, `KHR_materials_emissive_strength`.

mod accessor;
mod camera;
mod document;
mod extras;
mod groups;
mod lights;
mod material;
mod mesh;
mod nodes;
mod notes;
mod source;

use crate::base::error::{Error, Result};
use crate::scene::file::Overrides;
use crate::scene::light::Shape;
use crate::scene::{Parts, Scene, Surface, name};
use document::Document;
use extras::SceneExtras;
use glam::DVec3;
use groups::Groups;
use material::{Cover, Palette};
use nodes::Placed;
use source::Source;
use std::borrow::Cow;
use std::fmt::Display;
use std::path::Path;

/// Exposure values beyond this, up or down, overflow f32 on the way to a pixel.
const MOST_EV100: f64 = 60.0;

/// A file whose bytes are at hand.
struct Reader<'a> {
    source: Source<'a>,
    document: &'a Document<'a>,
    buffers: &'a [Cow<'a, [u8]>],
}

/// The scene of a glTF file.
pub fn load(path: &Path, overrides: &Overrides) -> Result<Scene> {
    parse(&Source(path).read()?, path, overrides)
}

/// The scene of a glTF file's bytes; `file` is the name that errors give, and where buffers beside it are looked for.
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

    /// The scene's name, or the file's.
    fn name(&self, given: Option<&str>) -> String {
        // Blender calls each scene so.
        let given = given.filter(|name| *name != "Scene").and_then(name::made_fit);
        let stem = || self.source.0.file_stem().and_then(|stem| name::made_fit(&stem.to_string_lossy()));
        given.or_else(stem).unwrap_or_else(|| "scene".into())
    }

    fn wrong(&self, field: impl Display, message: impl Display) -> Error {
        self.source.wrong(field, message)
    }

    /// An error about a number that names nothing.
    fn no_such(&self, what: &str, id: u32, count: usize, field: &dyn Display) -> Error {
        self.wrong(field, format_args!("there is no {what} {id}; the file has {count} of them, from 0"))
    }
}
