//! Which lights are placed by hand? The table of their kinds stands in the documentation of the recipe.

use super::place::near;
use super::toml_table::Table;
use crate::base::colour::black_body;
use crate::base::error::{Error, Result};
use crate::scene::light::{Shape, cone_flux};
use crate::sources::limits::{BRIGHTEST, FARTHEST, NARROWEST_CONE};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Least difference of a spot's half-angles, in degrees; less a little, for the rounding of 0.8 - 0.7.
const RAMP: f64 = 0.1 - 1e-9;

/// The fields of all kinds; each kind then refuses those of the others.
const FIELDS: [&str; 13] = [
    "kind",
    "position",
    "target",
    "inner",
    "outer",
    "towards",
    "corners",
    "intensity",
    "flux",
    "irradiance",
    "radiance",
    "colour",
    "kelvin",
];

/// A light in the recipe's frame, in f64: its shape, and the places that go into it.
pub(super) struct Placed {
    places: [DVec3; 3],
    shape: Shape,
}

impl Placed {
    /// The light relative to `shift`.
    pub(super) fn at(self, shift: DVec3) -> Shape {
        let [first, second, third] = self.places.map(|place| near(place, shift));
        match self.shape {
            Shape::Point { intensity, .. } => Shape::Point { position: first, intensity },
            Shape::Spot { axis, intensity, cos_inner, cos_outer, .. } => {
                Shape::Spot { position: first, axis, intensity, cos_inner, cos_outer }
            }
            Shape::Triangle { radiance, .. } => Shape::Triangle { corners: [first, second, third], radiance },
            Shape::Directional { .. } => self.shape,
        }
    }
}

/// Reads all `[[light]]` tables.
pub(super) fn read(top: &Table) -> Result<Vec<Placed>> {
    top.tables("light")?.iter().map(light).collect()
}

fn light(table: &Table) -> Result<Placed> {
    const KINDS: [&str; 4] = ["point", "spot", "directional", "triangle"];
    table.only(&FIELDS)?;
    let Some(kind) = table.choice("kind", &KINDS)? else {
        return Err(table.wrong("kind", format!("is missing; one of {} is asked for", KINDS.join(", "))));
    };
    match kind {
        0 => {
            table.only(&["kind", "position", "intensity", "flux", "colour", "kelvin"])?;
            let position = table.needed_vector("position", FARTHEST)?;
            let intensity = channels(table, peak(table, 4.0 * PI)?)?;
            Ok(Placed { places: [position; 3], shape: Shape::Point { position: Vec3::ZERO, intensity } })
        }
        1 => spot(table),
        2 => {
            table.only(&["kind", "towards", "irradiance", "colour", "kelvin"])?;
            let towards = direction(table, "towards", table.needed_vector("towards", 1e12)?)?;
            let irradiance = channels(table, table.needed_number("irradiance", 0.0..=BRIGHTEST, "lux")?)?;
            Ok(Placed { places: [DVec3::ZERO; 3], shape: Shape::Directional { towards, irradiance } })
        }
        _ => {
            table.only(&["kind", "corners", "radiance", "colour", "kelvin"])?;
            let places = table.needed_corners("corners", FARTHEST)?;
            let radiance = channels(table, table.needed_number("radiance", 0.0..=BRIGHTEST, "cd/m^2")?)?;
            Ok(Placed { places, shape: Shape::Triangle { corners: [Vec3::ZERO; 3], radiance } })
        }
    }
}

fn spot(table: &Table) -> Result<Placed> {
    table.only(&["kind", "position", "target", "inner", "outer", "intensity", "flux", "colour", "kelvin"])?;
    let position = table.needed_vector("position", FARTHEST)?;
    let axis = direction(table, "target", table.needed_vector("target", FARTHEST)? - position)?;
    let outer = table.number("outer", NARROWEST_CONE..=90.0, "degrees")?.unwrap_or(45.0);
    let inner = table.number("inner", 0.0..=90.0, "degrees")?.unwrap_or(0.0);
    // The cosine of 90 degrees is 6e-17 in f64 and below 0 in f32 arithmetic elsewhere: hold it at 0.
    let [cos_inner, cos_outer] = [inner, outer].map(|angle| angle.to_radians().cos().max(0.0) as f32);
    if outer - inner < RAMP {
        return Err(table.wrong(
            "inner",
            format!(
                "{inner} degrees is given; the inner half-angle must lie below the outer, {outer}, at least 0.1 below"
            ),
        ));
    }
    let intensity = channels(table, peak(table, f64::from(cone_flux(cos_inner, cos_outer)))?)?;
    Ok(Placed {
        places: [position; 3],
        shape: Shape::Spot { position: Vec3::ZERO, axis, intensity, cos_inner, cos_outer },
    })
}

/// The peak intensity in cd, given as such or as a flux over `solid_angle` sr.
fn peak(table: &Table, solid_angle: f64) -> Result<f64> {
    let intensity = table.number("intensity", 0.0..=BRIGHTEST, "candelas")?;
    let flux = table.number("flux", 0.0..=BRIGHTEST, "lumens")?;
    match (intensity, flux) {
        (Some(intensity), None) => Ok(intensity),
        (None, Some(flux)) => Ok(flux / solid_angle),
        (None, None) => {
            Err(table.wrong("flux", "is missing; `flux` in lumens or `intensity` in candelas is asked for"))
        }
        (Some(_), Some(_)) => {
            Err(table.wrong("flux", "`flux` and `intensity` are both given; one of them is asked for"))
        }
    }
}

/// A value in three channels.
fn channels(table: &Table, value: f64) -> Result<Vec3> {
    let kelvin = table.number("kelvin", 1_700.0..=15_000.0, "kelvin")?;
    let colour = table.colour("colour", 100.0)?;
    let colour = match (colour, kelvin) {
        (Some(_), Some(_)) => {
            return Err(table.wrong("kelvin", "`colour` and `kelvin` are both given; one of them is asked for"));
        }
        (Some(colour), None) => colour,
        (None, Some(kelvin)) => black_body(kelvin as f32).as_dvec3(),
        (None, None) => DVec3::ONE,
    };
    Ok((colour * value).as_vec3())
}

fn direction(table: &Table, name: &str, vector: DVec3) -> Result<Vec3> {
    let too_short = || -> Error { table.wrong(name, "the direction has no length; a point elsewhere is asked for") };
    vector.try_normalize().map(DVec3::as_vec3).ok_or_else(too_short)
}
