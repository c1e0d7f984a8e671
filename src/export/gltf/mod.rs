//! How is a scene said in glTF 2.0?
//!
//! glTF is +y up: our `(x, y, z)` is its `(x, z, -y)`, in the coordinates themselves, and there is no root that turns.
//! Candela, lux and radiance are carried unchanged. Colours are a factor within 0 and 1 times a power of two, so that
//! the product has every bit of ours. What glTF has no word for stands in `extras`: the camera's `resolution`, the
//! scene's `ev100`, a material's `street`.
//!
//! | question | where |
//! |---|---|
//! | what is the whole file? | `document` |
//! | how do the parts stand in it? | `camera`, `lights`, `triangles`, `materials` |
//! | what are our places, directions and turns in its axes? | `place` |
//! | and our colours as its factors? | `factored` |
//! | where does what it has no word for stand? | `extras` |
//!
//! Source: Khronos, glTF 2.0.1; `KHR_lights_punctual`, `KHR_materials_emissive_strength`, `KHR_materials_specular`.

mod camera;
mod document;
mod extras;
mod factored;
mod lights;
mod materials;
mod place;
mod triangles;

pub(super) use document::export;
