//! One light sample: point on the light, early outs, unshadowed contribution.

use super::by_angle::by_angle;
use crate::base::triangle::uniform_point;
use crate::scene::light::{Kind, Light};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Unshadowed light from one point of a light: what a shadow ray must still confirm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Reflected radiance in cd/m^2: `albedo / pi` times irradiance, of a triangle as if all of it sent what this point
    /// does: over the density of the point.
    pub radiance: Vec3,
    /// Unit direction from the receiver to the point.
    pub direction: Vec3,
    /// Distance to it in metres; infinite for a directional light.
    pub distance: f32,
}

/// Why a sample ended before a ray was cast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EarlyOut {
    /// The light sends nothing this way: black, or outside a spot's cone.
    ZeroIntensity,
    /// The light is below the receiver's horizon.
    BehindSurface,
    /// The receiver is behind a one-sided light.
    BehindLight,
}

/// What the point `uv` (in `[0, 1)^2`, used by triangles) of a light adds at a receiver, with nothing in between.
///
/// `by` says which point of a triangle that is. `KINDS` is the set of [`Kind::bit`]s that the scene holds: code for
/// others is not compiled in. Directional irradiance `E` gives `albedo/pi E (n.w)`; a point `albedo/pi I (n.w) / d^2`;
/// a triangle of area A `albedo/pi L A (n.w)(n_l.-w) / d^2` (Kajiya 1986 with a Lambertian emitter) by area, `albedo/pi
/// L S (n.w)` by its solid angle S, `albedo/pi E` by its irradiance E.
///
/// # Errors
/// Where nothing arrives, the [`EarlyOut`] that says why.
#[inline(always)]
pub fn contribution<const KINDS: u8>(
    by: LightSampling,
    light: &Light,
    uv: [f32; 2],
    at: &Receiver,
) -> Result<Arrival, EarlyOut> {
    let kind = light.kind();
    let reflected = light.colour * at.albedo * FRAC_1_PI;
    if KINDS & Kind::Directional.bit() != 0 && kind == Kind::Directional {
        let cosine = at.normal.dot(light.position);
        if cosine <= 0.0 {
            return Err(EarlyOut::BehindSurface);
        }
        return arrival(reflected * cosine, light.position, f32::INFINITY);
    }
    let (to_light, emitting) = if KINDS & Kind::Triangle.bit() != 0 && kind == Kind::Triangle {
        // Twice the area times the cosine at the light, times the distance. The corner stands for any of its points:
        // the product is the same all over the plane and loses no digits near it.
        let facing = light.c.dot(at.position - light.position);
        if facing <= 0.0 {
            return Err(EarlyOut::BehindLight);
        }
        let by = by.settled(light, at);
        if by != LightSampling::Area {
            let drawn = by_angle(light, uv, at, by == LightSampling::Projected).ok_or(EarlyOut::BehindSurface)?;
            if drawn.irradiance <= 0.0 {
                return Err(EarlyOut::BehindSurface);
            }
            let (direction, distance) = (drawn.to_light.normalize().as_vec3(), drawn.to_light.length() as f32);
            return arrival(reflected * drawn.irradiance as f32, direction, distance);
        }
        let [b1, b2] = uniform_point(uv);
        let to_light = (light.position - at.position) + light.a * b1 + light.b * b2;
        (to_light, 0.5 * facing)
    } else {
        (light.position - at.position, 1.0)
    };
    let height = at.normal.dot(to_light);
    if height <= 0.0 {
        return Err(EarlyOut::BehindSurface);
    }
    let distance = to_light.length();
    let direction = to_light / distance;
    let cubed = distance * distance * distance;
    let falloff = if KINDS & Kind::Triangle.bit() != 0 && kind == Kind::Triangle {
        height * emitting / (cubed * distance)
    } else if KINDS & Kind::Spot.bit() != 0 && kind == Kind::Spot {
        height * light.cone(-direction) / cubed
    } else {
        height / cubed
    };
    arrival(reflected * falloff, direction, distance)
}

#[inline(always)]
fn arrival(radiance: Vec3, direction: Vec3, distance: f32) -> Result<Arrival, EarlyOut> {
    // Also false for NaN, which a receiver exactly on a light would give: 0/0.
    if radiance.max_element() > 0.0 && radiance.is_finite() {
        Ok(Arrival { radiance, direction, distance })
    } else {
        Err(EarlyOut::ZeroIntensity)
    }
}
