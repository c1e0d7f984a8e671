//! How many points does each triangle deserve at each receiver, if the image is to be exact to a given relMSE?
//!
//! A receiver first takes a look at every triangle: a few points, whose differences say how fast the light changes from
//! one part of the triangle to the next. A penumbra needs many points, a triangle in full view or hidden few. One price
//! for all receivers and lights, the weighted squared error that a shadow ray must at least take away, then decides
//! every number of points: at the optimum all rays are worth the same.
//!
//! Looks have random numbers of their own and are thrown away, so that what they say of the number of points biases
//! nothing.

use super::exact::{Exact, deltas, grid, grid_side, stratified};
use crate::base::random::Stream;
use crate::base::rel_mse::RelMse;
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::visibility::stage::Stage;
use glam::DVec3;

/// What a shadow ray must be worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// How squared errors are weighed.
    pub relative: RelMse,
    /// relMSE of the receiver that a ray takes away, at least.
    pub a_ray: f64,
}

/// The variance of the mean of a jittered grid of `n` points falls as `n^-FALL` in a penumbra, where only the cells on the
/// shadow's edge matter, and faster in full light.
pub const FALL: f64 = 1.5;

/// Points of a receiver's first looks, on top of one a light.
const POINTS: u32 = 64;

/// A grid is believed of grids with up to so many times as many points along a side; then a closer look is taken.
const BELIEVED: u32 = 3;

/// Most points along a side.
const MOST: f64 = 2048.0;

/// The exact radiance of a receiver, with as many points on each triangle as are worth the price; `seed` names the
/// random numbers.
pub fn refined(stage: &Stage, at: &Receiver, price: Price, seed: u64) -> Exact {
    let mut rays = 0;
    let sum = deltas(stage, at, &mut rays);
    let triangles = stage.scene().lights().iter().filter(|light| light.kind() == Kind::Triangle);
    let triangles: Vec<(&Light, f64)> =
        triangles.map(|light| (light, f64::from(importance(light, at)))).filter(|(_, most)| *most > 0.0).collect();
    let total: f64 = triangles.iter().map(|(_, most)| most).sum();
    let mut rng = Stream::keyed(&[seed, LOOKS, u64::from(at.pixel)]);
    let mut look = |light, side| Look::new(stage, at, light, side, &mut rng, &mut rays);
    let mut looks: Vec<(&Light, Look)> =
        triangles.iter().map(|&(light, most)| (light, look(light, grid_side(POINTS, most / total)))).collect();
    let mean = sum + looks.iter().map(|(_, look)| look.mean).sum::<DVec3>();
    let weight = price.relative.weight(mean.as_vec3());
    for (light, seen) in &mut looks {
        while seen.worth(weight, price.a_ray) > BELIEVED * seen.side {
            *seen = look(light, seen.worth(weight, price.a_ray).div_ceil(BELIEVED));
        }
    }
    let halves = [0, 1].map(|half| {
        let mut rng = Stream::keyed(&[seed, half, u64::from(at.pixel), price.a_ray.to_bits()]);
        let one = |(light, seen): &(&Light, Look)| {
            stratified(stage, at, light, seen.worth(weight, price.a_ray), &mut rng, &mut rays)
        };
        looks.iter().map(one).sum()
    });
    Exact { sum, halves, rays }
}

/// Names the random numbers of looks: never a half's.
const LOOKS: u64 = u64::from_le_bytes(*b"thelooks");

/// What a look at a light shows.
struct Look {
    /// Points along a side of its two grids.
    side: u32,
    mean: DVec3,
    /// Variance of the mean of one grid.
    variance: DVec3,
}

impl Look {
    fn new(stage: &Stage, at: &Receiver, light: &Light, side: u32, rng: &mut Stream, rays: &mut u64) -> Self {
        let n = f64::from(side * side);
        let mut scan = || {
            let (mut sum, mut squares, mut before) = (DVec3::ZERO, DVec3::ZERO, None);
            grid(stage, at, light, side, rng, rays, |value| {
                sum += value;
                // Half the square of a difference is a variance.
                squares +=
                    before.replace(value).map_or(DVec3::ZERO, |before| (value - before) * (value - before) * 0.5);
            });
            (sum / n, squares / (n * (n - 1.0).max(1.0)))
        };
        let ((a, first), (b, second)) = (scan(), scan());
        // Neighbours tell of an edge on the light; two grids that lie on either side of it tell of it too.
        let variance = ((a - b) * (a - b) * 0.5).max((first + second) * 0.5);
        Self { side, mean: (a + b) * 0.5, variance }
    }

    /// Side of the grid from which on another ray takes away less than the price: the mean of two halves of `n` points
    /// each has half the variance of one and takes `2 n` rays.
    fn worth(&self, weight: DVec3, price: f64) -> u32 {
        let rough = (self.variance * weight).element_sum() / 3.0 * f64::from(self.side * self.side).powf(FALL);
        let points = (FALL * rough / (4.0 * price)).powf(1.0 / (FALL + 1.0));
        points.sqrt().ceil().clamp(1.0, MOST) as u32
    }
}
