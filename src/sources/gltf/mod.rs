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
//! Every mistake is an [`Error::Input`](crate::base::error::Error::Input) with the path in the document, `meshes[3].primitives[0].attributes.POSITION`;
//! nothing that a file can say panics or asks for more than about a hundred bytes of memory for each of its own.
//!
//! Positions are worked out in f64 and kept in f32 relative to an origin near the middle of the surfaces.
//!
//! Source: Khronos Group, glTF 2.0 specification, 2021; `KHR_lights_punctual`, `KHR_materials_emissive_strength`.

mod accessor;
mod albedo;
mod camera;
mod coverage;
mod document;
mod extensions;
mod extras;
mod glow;
mod groups;
mod images;
mod instances;
mod lights;
mod looks;
mod mapping;
mod material;
mod mesh;
mod nodes;
mod notes;
mod picture;
mod planes;
mod read;
mod reader;
mod source;

pub use read::{load, parse};
