//! How does another renderer get a scene: in which files, and what can they not say?
//!
//! Each export renders there with the same absolute radiance and no hand edit: intensities, irradiances and radiances
//! are carried with factor 1, the camera with its pixel grid, the film without any curve. Coordinates are those of the
//! scene, relative to its origin.
//!
//! | question | where |
//! |---|---|
//! | for which renderers? | [`Renderer`] |
//! | how is a scene exported? | [`export`] |
//! | what comes of it, and how does it get to disk? | [`Export`](files::Export) |
//! | what does each format say? | `gltf`, `pbrt`, `mitsuba` with `serialized` |
//! | which triangles belong together? | `meshes` |
//! | what is a spot's cone where edges have another profile? | `cone` |
//! | how do numbers and names read back as the same? | `text` |

mod by_renderer;
mod cone;
mod files;
mod gltf;
mod meshes;
mod mitsuba;
mod pbrt;
mod renderer;
mod serialized;
mod text;

pub(crate) use by_renderer::export;
pub(crate) use renderer::Renderer;
