//! How much could a light add at a receiver, nothing in between?
//!
//! Exact for point, spot and directional lights; an estimate for triangles that is positive wherever a part of the
//! triangle can add anything. So it is safe to choose by: weight 0 means contribution 0.

use crate::base::colour::luminance;
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use glam::Vec3;

/// Luminance of the irradiance that `light` sends to `at`, in lx; the receiver's albedo is left out.
#[inline]
pub fn importance(light: &Light, at: &Receiver) -> f32 {
    let strength = luminance(light.colour);
    match light.kind() {
        Kind::Directional => strength * at.normal.dot(light.position).max(0.0),
        Kind::Point => {
            let to_light = light.position - at.position;
            let d2 = to_light.length_squared();
            positive(strength * at.normal.dot(to_light).max(0.0) / (d2 * d2.sqrt()))
        }
        Kind::Spot => {
            let to_light = light.position - at.position;
            let distance = to_light.length();
            let lit = light.cone(-to_light / distance);
            positive(strength * lit * at.normal.dot(to_light).max(0.0) / (distance * distance * distance))
        }
        Kind::Triangle => {
            let from_corner = at.position - light.position;
            let facing = light.c.dot(from_corner);
            if facing <= 0.0 {
                return 0.0;
            }
            // Heights of the corners over the receiver's horizon.
            let first = -at.normal.dot(from_corner);
            let (a, b) = (at.normal.dot(light.a), at.normal.dot(light.b));
            let top = first + a.max(b).max(0.0);
            let bottom = first + a.min(b).min(0.0);
            if top <= 0.0 {
                // Points of the triangle are rounded otherwise: where one may count as above the horizon, this does
                // too.
                let sum = |edge: Vec3| edge.abs().element_sum();
                let rounding = 1e-6 * (sum(from_corner) + sum(light.a) + sum(light.b));
                if top <= -rounding {
                    return 0.0;
                }
                return triangle(light, facing, rounding, from_corner);
            }
            // Mean height; of a triangle cut by the horizon, the mean of what is above it as if spread evenly.
            let height = if bottom >= 0.0 { first + (a + b) / 3.0 } else { 0.5 * top * top / (top - bottom) };
            triangle(light, facing, height, from_corner)
        }
    }
}

/// What a triangle adds whose points are so high above the horizon on average; `facing` is twice its area times the cosine
/// there, times the distance, and positive.
#[inline]
fn triangle(light: &Light, facing: f32, height: f32, from_corner: Vec3) -> f32 {
    let strength = luminance(light.colour);
    let to_centre = (light.a + light.b) / 3.0 - from_corner;
    // A quarter of the area keeps a receiver next to the light from an infinite weight.
    let d2 = to_centre.length_squared() + 0.125 * light.c.length();
    let value = positive(strength * 0.5 * facing * height / (d2 * d2));
    // A corner at the receiver alone above the horizon: too little for f32 on average, and yet the corner adds something.
    if strength > 0.0 { value.max(f32::MIN_POSITIVE) } else { 0.0 }
}

/// 0 for NaN, which a receiver exactly on a light gives; a receiver so near that f32 overflows gets the greatest
/// weight.
#[inline]
fn positive(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.min(f32::MAX) }
}
