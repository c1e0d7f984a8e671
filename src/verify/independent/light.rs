//! What does a point of a light add, and how much of that may f32 get wrong?
//!
//! `albedo / pi` times the irradiance: directional `E (n.w)`, point `I (n.w) / d^2`, spot the same times the squared
//! linear ramp of `KHR_lights_punctual`, triangle `L A (n.w)(n_l.-w) / d^2` for a point that stands for all its area.

use super::geometry::{Place, Towards};
use crate::scene::light::{Light, Shape};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// A few units of f32.
const UNIT: f64 = f32::EPSILON as f64;

/// What arrives with nothing in between.
pub(super) struct Arriving {
    /// In cd/m^2.
    pub(super) radiance: DVec3,
    /// How far f32 may be off it.
    pub(super) rounding: DVec3,
    /// Where it comes from.
    pub(super) from: Towards,
}

/// A cosine-like factor that is 0 below 0, and how far off it may be.
struct Factor {
    value: f64,
    off: f64,
}

impl Factor {
    fn nominal(&self) -> f64 {
        self.value.max(0.0)
    }

    fn most(&self) -> f64 {
        (self.value + self.off).max(0.0)
    }
}

/// The point of a triangle that `uv` stands for, by area: the first corner's weight is `1 - sqrt(u)`, the third's
/// `sqrt(u) v`.
pub(super) fn point(light: &Light, [u, v]: [f64; 2]) -> DVec3 {
    let (first, third) = (1.0 - u.sqrt(), u.sqrt() * v);
    let [p, q, r] = corners(light);
    p * first + q * (1.0 - first - third) + r * third
}

/// Of a triangle, as the table has it.
pub(super) fn corners(light: &Light) -> [DVec3; 3] {
    let p = light.position.as_dvec3();
    [p, p + light.a.as_dvec3(), p + light.b.as_dvec3()]
}

/// What the point `uv` of a light adds at a place.
pub(super) fn unshadowed(light: &Light, uv: [f64; 2], at: &Place) -> Arriving {
    let full = Factor { value: 1.0, off: 0.0 };
    // Where it comes from, from which numbers of which size, by which colour, and what else weakens it.
    let (from, reach, colour, factor) = match light.shape() {
        Shape::Directional { towards, irradiance } => (Towards::Direction(towards.as_dvec3()), 1.0, irradiance, full),
        Shape::Point { position, intensity } => {
            let position = position.as_dvec3();
            (Towards::Point(position), sum(position - at.position), intensity, full)
        }
        Shape::Spot { position, axis, intensity, cos_inner, cos_outer } => {
            let position = position.as_dvec3();
            let (inner, outer) = (f64::from(cos_inner), f64::from(cos_outer));
            let cosine = (at.position - position).normalize_or_zero().dot(axis.as_dvec3());
            let ramp = ((cosine - outer) / (inner - outer)).clamp(0.0, 1.0);
            // Cosines of rounded vectors, and products with a scale that cancel.
            let most = ramp + 16.0 * UNIT / (inner - outer);
            let profile = Factor { value: ramp * ramp, off: most * most - ramp * ramp };
            (Towards::Point(position), sum(position - at.position), intensity, profile)
        }
        Shape::Triangle { radiance, .. } => {
            let (point, [p, q, r]) = (point(light, uv), corners(light));
            let (a, b, to_corner) = (q - p, r - p, p - at.position);
            let to = point - at.position;
            let facing = -0.5 * a.cross(b).dot(to) / to.length();
            // The normal is a product of rounded edges.
            let off = 8.0 * UNIT * a.length() * b.length() * to_corner.length() / to.length();
            (Towards::Point(point), sum(to_corner) + sum(a) + sum(b), radiance, Factor { value: facing, off })
        }
    };
    let (towards, distance) = match from {
        Towards::Point(point) => ((point - at.position).normalize_or_zero(), (point - at.position).length()),
        Towards::Direction(direction) => (direction, 1.0),
    };
    let cosine = Factor { value: at.normal.dot(towards), off: 8.0 * UNIT * reach / distance };
    let reflected = colour.as_dvec3() * at.albedo * FRAC_1_PI / (distance * distance);
    let nominal = cosine.nominal() * factor.nominal();
    // The upper side of the doubt is the larger one.
    let most = cosine.most() * factor.most() * (1.0 + 16.0 * UNIT * (1.0 + reach / distance));
    Arriving { radiance: reflected * nominal, rounding: reflected * (most - nominal), from }
}

fn sum(v: DVec3) -> f64 {
    v.abs().element_sum()
}

/// Whether a triangle can add anything at a place, beyond all doubt of rounding: its front is seen, a part of it is above
/// the horizon, and it shines.
pub(super) fn surely_adds(light: &Light, at: &Place) -> bool {
    let [p, q, r] = corners(light);
    let reach = sum(p - at.position) + sum(q - p) + sum(r - p);
    let facing = (q - p).cross(r - p).dot(at.position - p);
    let top = [p, q, r].map(|corner| at.normal.dot(corner - at.position)).into_iter().fold(f64::MIN, f64::max);
    let slack = 8.0 * UNIT * (q - p).length() * (r - p).length() * (p - at.position).length();
    facing > slack && top > 1e-5 * reach && light.colour.max_element() > 1e-20
}

/// Whether all of a triangle is above the horizon of a place.
pub(super) fn is_above(light: &Light, at: &Place) -> bool {
    corners(light).into_iter().all(|corner| at.normal.dot(corner - at.position) > 0.0)
}

/// Whether a triangle is no wider than half its distance.
pub(super) fn looks_small(light: &Light, at: &Place) -> bool {
    let [p, q, r] = corners(light);
    let near = [p, q, r].map(|corner| (corner - at.position).length()).into_iter().fold(f64::MAX, f64::min);
    2.0 * (q - p).length().max((r - p).length()) < near
}

/// Irradiance from a triangle that is all above the horizon and shows its front, in lx for 1 cd/m^2.
///
/// Source: Lambert, Photometria, 1760: half the sum over edges of the angle that they fill times the cosine of the
/// normal of the plane through them and the receiver.
pub(super) fn irradiance(light: &Light, at: &Place) -> f64 {
    let around = corners(light).map(|corner| (corner - at.position).normalize());
    let of_edge = |i: usize| {
        let (a, b) = (around[i], around[(i + 1) % 3]);
        let across = a.cross(b);
        let sine = across.length();
        if sine > 0.0 { sine.atan2(a.dot(b)) / sine * at.normal.dot(across) } else { 0.0 }
    };
    // Fronts run counter-clockwise to who sees them, so the sum is negative there.
    (-0.5 * (0..3).map(of_edge).sum::<f64>()).max(0.0)
}
