//! Where things are placed.

use super::toml_table::Table;
use crate::base::error::Error;
use crate::sources::city::Solid;
use glam::{DVec3, Vec3};

/// What to say about a camera in a solid.
pub(super) fn inside(camera: &Table, what: &str, solid: Solid) -> Error {
    let Solid { low, high } = solid;
    camera.wrong(
        "position",
        format!("the camera stands inside {what}, from {low} to {high}: the image would be black; move it out"),
    )
}

/// A position in f32, relative to `shift`.
pub(super) fn near(position: DVec3, shift: DVec3) -> Vec3 {
    (position - shift).as_vec3()
}
