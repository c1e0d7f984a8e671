//! Scenes from glTF 2.0 files, `.glb` or `.gltf`.
//!
//! | glTF | here |
//! |---|---|
//! | the scene it names, or the first | the nodes shown; metres, turned from +y up to +z up |
//! | triangles, strips and fans | surfaces; their base colour factor, times the mean of its texture over the primitive, is the albedo of a Lambertian reflector |
//! | emissive materials | triangle lights of factor times `KHR_materials_emissive_strength` in cd/m^2, on the side that is counter-clockwise, or on both if the material is double-sided; they reflect nothing |
//! | emissive textures (PNG, JPEG) | triangles cut into pieces, each with the mean of its texels; black pieces reflect |
//! | `KHR_lights_punctual` | point, spot and directional lights, in cd and lx; spots under half a degree are widened with their flux kept |
//! | `EXT_mesh_gpu_instancing` | mesh, light and all below the node, once for each instance |
//! | `KHR_mesh_quantization`, sparse accessors, morph targets | the positions that they say, at the weights of the file |
//! | `KHR_texture_transform`, `texCoord`, wrap modes | where the texels lie |
//! | `KHR_materials_pbrSpecularGlossiness` | its diffuse colour is the albedo |
//! | `KHR_node_visibility` | what is hidden is left out |
//! | cameras | the one asked for by the name of its node or its own, or the first; without any a view of the whole; the near and far planes cut nothing |
//! | names of nodes that carry lights | light groups, numbers at their end left off |
//!
//! What glTF has no word for is read from `extras` as our exports write it: `ev100` of a scene, `resolution` of a
//! camera in pixels, `street` of a material. What is not used is told in the scene's notes, each kind of thing once; what
//! could not be ignored without changing the light or the shapes (lights of other extensions, compressed meshes, emission
//! in other formats) is refused with a way round.
//!
//! Blender's exporter by default writes lamps 683 times as bright as emissive materials beside them: a note says so, and
//! [`Overrides::lamps_divided_by`](crate::sources::Overrides::lamps_divided_by) mends it.
//!
//! Every mistake is an [`Error::Input`](crate::base::error::Error::Input) with the path in the document, `meshes[3].primitives[0].attributes.POSITION`;
//! nothing that a file can say panics or asks for more than about a hundred bytes of memory for each of its own, beside
//! 8 bytes for each texel that is decoded: 2^22 of an image, and 400 more for each byte of it.
//!
//! Positions are worked out in f64 and kept in f32 relative to an origin near the middle of the surfaces.
//!
//! Source: Khronos Group, glTF 2.0 specification, 2021; and of the extensions named above.

mod accessor;
mod albedo;
mod camera;
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
mod planes;
mod read;
mod reader;
mod source;

pub use read::{load, parse};
