//! The exact image, without any choice of lights.
//!
//! Point, spot and directional lights: the sum over all of them, one shadow ray each, accumulated in f64: no noise.
//! Triangles: `points` stratified points a receiver on top of one a light, shared out by what each light could add, in
//! two independent halves. Their mean is the reference; their difference says how noisy it still is.
//!
//! What a scene lets others leave out is never left out here.

use crate::base::random::Stream;
use crate::scene::light::{Kind, Light};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::shading::importance::importance;
use crate::visibility::stage::Stage;
use glam::DVec3;

/// Exact radiance of a receiver in cd/m^2: the noise-free sum and two independent estimates of the rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exact {
    /// Point, spot and directional lights.
    pub sum: DVec3,
    /// Triangles, twice.
    pub halves: [DVec3; 2],
    /// The next random number of each half: the same where they drew the same.
    pub marks: [u64; 2],
    /// Shadow rays cast.
    pub rays: u64,
}

impl Exact {
    /// The best estimate.
    pub fn mean(&self) -> DVec3 {
        self.sum + (self.halves[0] + self.halves[1]) * 0.5
    }
}

/// The exact radiance of a receiver; `points` extra points a half for triangles, `seed` names their random numbers.
pub fn exact(stage: &Stage, at: &Receiver, points: u32, seed: u64) -> Exact {
    let mut result = Exact::default();
    let lights = stage.scene().lights();
    result.sum = deltas(stage, at, &mut result.rays);
    let total: f64 = triangles(lights).map(|light| f64::from(importance(light, at))).sum();
    if total <= 0.0 {
        return result;
    }
    for (half, (sum, mark)) in result.halves.iter_mut().zip(&mut result.marks).enumerate() {
        let mut rng = Stream::keyed(&[seed, half as u64, u64::from(at.pixel), u64::from(points)]);
        for light in triangles(lights) {
            let share = f64::from(importance(light, at)) / total;
            if share > 0.0 {
                *sum += stratified(stage, at, light, grid_side(points, share), &mut rng, &mut result.rays);
            }
        }
        *mark = rng.bits();
    }
    result
}

/// What all lights but triangles add: a sum without noise.
pub(super) fn deltas(stage: &Stage, at: &Receiver, rays: &mut u64) -> DVec3 {
    let deltas = stage.scene().lights().iter().filter(|light| light.kind() != Kind::Triangle);
    deltas.fold(DVec3::ZERO, |sum, light| sum + shadowed(stage, LightSampling::Area, at, light, [0.0; 2], rays))
}

fn triangles(lights: &[Light]) -> impl Iterator<Item = &Light> {
    lights.iter().filter(|light| light.kind() == Kind::Triangle)
}

/// Side of the grid of points that a triangle gets which could add `share` of the light; at least one point.
pub(crate) fn grid_side(points: u32, share: f64) -> u32 {
    (f64::from(points) * share).sqrt() as u32 + 1
}

/// Mean contribution, in cd/m^2, over a jittered grid of `side * side` points on a triangle, shadow rays included.
///
/// By area where the light looks small, however the stage draws its points: what judges those must not share their
/// arithmetic. Where it looks large or has a near end, points by area hit the few places that matter too seldom, and are
/// drawn in proportion to the irradiance: by the map that no strategy takes unless it is told to.
pub(crate) fn stratified(
    stage: &Stage,
    at: &Receiver,
    light: &Light,
    side: u32,
    rng: &mut Stream,
    rays: &mut u64,
) -> DVec3 {
    let mut sum = DVec3::ZERO;
    grid(stage, at, light, side, rng, rays, |value| sum += value);
    sum / f64::from(side * side)
}

/// Each contribution of such a grid, row by row.
pub(super) fn grid(
    stage: &Stage,
    at: &Receiver,
    light: &Light,
    side: u32,
    rng: &mut Stream,
    rays: &mut u64,
    mut each: impl FnMut(DVec3),
) {
    let step = 1.0 / side as f32;
    let by = match LightSampling::Auto.settled(light, at) {
        LightSampling::Area => LightSampling::Area,
        _ => LightSampling::Projected,
    };
    for cell in 0..side * side {
        let [u, v] = rng.uniform2();
        let uv = [((cell % side) as f32 + u) * step, ((cell / side) as f32 + v) * step];
        each(shadowed(stage, by, at, light, uv.map(|x| x.min(1.0 - f32::EPSILON)), rays));
    }
}

/// The contribution of a point of a light that is drawn `by` a way, shadow ray included.
pub(crate) fn shadowed(
    stage: &Stage,
    by: LightSampling,
    at: &Receiver,
    light: &Light,
    uv: [f32; 2],
    rays: &mut u64,
) -> DVec3 {
    let Ok(arrival) = contribution::<0b1111>(by, light, uv, at) else { return DVec3::ZERO };
    *rays += 1;
    let segment = stage.ray_ends().segment(at, light, arrival.direction, arrival.distance);
    if stage.occluders().visible(&segment) { arrival.radiance.as_dvec3() } else { DVec3::ZERO }
}
