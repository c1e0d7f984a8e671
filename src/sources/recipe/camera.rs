//! The camera of a recipe.

use super::toml_table::Table;
use crate::base::error::{Error, Result};
use crate::scene::camera::Camera;
use crate::sources::city::Standpoint;
use crate::sources::limits::FARTHEST;
use glam::{DVec2, DVec3};

/// Where the camera stands and what it looks at, as the table says.
pub(super) fn standpoint(table: &Table) -> Result<Standpoint> {
    table.only(&["position", "target", "fov", "resolution"])?;
    let eye = table.needed_vector("position", FARTHEST)?;
    Ok(Standpoint { eye, target: table.needed_vector("target", FARTHEST)? })
}

/// Reads the camera at a standpoint; `shift` is where the scene's origin lies.
pub(super) fn read(
    table: &Table,
    standpoint: Standpoint,
    shift: DVec3,
    resolution: Option<(u32, u32)>,
) -> Result<Camera> {
    let (eye, target) = (standpoint.eye - shift, standpoint.target - shift);
    let fov = table.number("fov", 1.0..=170.0, "degrees")?.unwrap_or(60.0);
    let given = table.pair("resolution", 1.0..=16_384.0, "pixels")?.unwrap_or(DVec2::new(240.0, 135.0));
    if given.fract() != DVec2::ZERO {
        return Err(table.wrong("resolution", format!("{given} is given; whole numbers of pixels are asked for")));
    }
    let (width, height) = resolution.unwrap_or((given.x as u32, given.y as u32));
    // A target nearer than this gives a direction of too few digits.
    if (target - eye).length() < 0.01 {
        return Err(table.wrong("target", "the camera needs a target at least 0.01 metres from its position"));
    }
    Camera::new(eye.as_vec3(), target.as_vec3(), fov as f32, width, height).map_err(|error| match error {
        Error::Invalid(message) => table.wrong("resolution", message),
        other => other,
    })
}
