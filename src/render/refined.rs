//! How many points does each triangle deserve at each receiver, if the image is to be exact to a given relMSE?
//!
//! A receiver first takes a look at every triangle: a few points, whose differences say how fast the light changes from
//! one part of the triangle to the next. A penumbra needs many points, a triangle in full view or hidden few. One price
//! for all receivers and lights, the weighted squared error that a shadow ray must at least take away, then decides
//! every number of points: at the optimum all rays are worth the same.
//!
//! The looks have random numbers of their own and are thrown away, so that what they say of the number of points
//! biases nothing.

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

/// What a look at all lights from one receiver shows.
pub struct Look<'a> {
    /// Point, spot and directional lights: the sum is exact already.
    sum: DVec3,
    triangles: Vec<Seen<'a>>,
    /// Shadow rays cast.
    pub rays: u64,
}

/// A triangle that can add something.
struct Seen<'a> {
    light: &'a Light,
    mean: DVec3,
    /// Variance of the mean of a grid of `n` points, times `n^FALL`.
    roughness: DVec3,
}

/// Points a receiver and half of a look, on top of one a light.
const POINTS: u32 = 64;

/// The variance of the mean of a jittered grid of `n` points falls as `n^-1.5` in a penumbra, where only the cells on the
/// shadow's edge matter, and as `n^-2` in full light.
pub const FALL: f64 = 1.5;

/// Most points along a side of a grid: 2^24 in all.
const MOST: f64 = 4096.0;

impl<'a> Look<'a> {
    /// Looks from a receiver; `seed` names the random numbers.
    pub fn new(stage: &'a Stage, at: &Receiver, seed: u64) -> Self {
        let lights = stage.scene().lights();
        let mut rays = 0;
        let sum = deltas(stage, at, &mut rays);
        let mut triangles: Vec<(&Light, f64)> = lights
            .iter()
            .filter(|light| light.kind() == Kind::Triangle)
            .map(|light| (light, f64::from(importance(light, at))))
            .collect();
        triangles.retain(|(_, importance)| *importance > 0.0);
        let total: f64 = triangles.iter().map(|(_, importance)| importance).sum();
        let mut rng = Stream::keyed(&[seed, LOOKS, u64::from(at.pixel)]);
        let seen = |(light, importance): (&'a Light, f64)| {
            let side = grid_side(POINTS, importance / total);
            let [(a, first), (b, second)] = [(); 2].map(|()| scan(stage, at, light, side, &mut rng, &mut rays));
            // Two independent grids differ by twice the variance of each.
            let variance = ((a - b) * (a - b) * 0.5).max((first + second) * 0.5);
            Seen { light, mean: (a + b) * 0.5, roughness: variance * f64::from(side * side).powf(FALL) }
        };
        let triangles = triangles.into_iter().map(seen).collect();
        Self { sum, triangles, rays }
    }

    /// Radiance of the receiver in cd/m^2, roughly.
    pub fn mean(&self) -> DVec3 {
        self.sum + self.triangles.iter().map(|seen| seen.mean).sum::<DVec3>()
    }

    /// What is to be expected of this receiver at a price: its relMSE and shadow rays.
    pub fn expected(&self, price: Price) -> (f64, f64) {
        let weight = price.relative.weight(self.mean().as_vec3());
        let mut total = (0.0, self.rays as f64);
        for seen in &self.triangles {
            let rough = (seen.roughness * weight).element_sum() / 3.0;
            let points = f64::from(side(rough, price.a_ray)).powi(2);
            total.0 += 0.5 * rough / points.powf(FALL);
            total.1 += 2.0 * points;
        }
        total
    }

    /// Estimates the triangles twice, with as many points as the price makes worth their while.
    fn halves(&self, stage: &Stage, at: &Receiver, price: Price, seed: u64, rays: &mut u64) -> [DVec3; 2] {
        let weight = price.relative.weight(self.mean().as_vec3());
        [0, 1].map(|half| {
            let mut rng = Stream::keyed(&[seed, half, u64::from(at.pixel), price.a_ray.to_bits()]);
            let of = |seen: &Seen<'_>| {
                let rough = (seen.roughness * weight).element_sum() / 3.0;
                stratified(stage, at, seen.light, side(rough, price.a_ray), &mut rng, rays)
            };
            self.triangles.iter().map(of).sum()
        })
    }
}

/// The exact radiance of a receiver, with as many points on each triangle as are worth the price.
pub fn refined(stage: &Stage, at: &Receiver, price: Price, seed: u64) -> Exact {
    let look = Look::new(stage, at, seed);
    let mut rays = look.rays;
    let halves = look.halves(stage, at, price, seed, &mut rays);
    Exact { sum: look.sum, halves, rays }
}

/// Names the random numbers of looks: never a half's.
const LOOKS: u64 = u64::from_le_bytes(*b"thelooks");

/// Side of the grid from which on another ray takes away less than the price: the mean of two halves of `n` points each
/// has a variance of `rough / (2 n^FALL)` and takes `2 n` rays.
fn side(rough: f64, price: f64) -> u32 {
    let points = (FALL * rough / (4.0 * price)).powf(1.0 / (FALL + 1.0));
    points.sqrt().ceil().clamp(1.0, MOST) as u32
}

/// The mean contribution over a jittered grid, and its variance as far as neighbours in the grid tell.
fn scan(stage: &Stage, at: &Receiver, light: &Light, side: u32, rng: &mut Stream, rays: &mut u64) -> (DVec3, DVec3) {
    let (mut sum, mut squares, mut before) = (DVec3::ZERO, DVec3::ZERO, None);
    grid(stage, at, light, side, rng, rays, |value| {
        sum += value;
        // Half the square of a difference is a variance.
        squares += before.replace(value).map_or(DVec3::ZERO, |before| (value - before) * (value - before) * 0.5);
    });
    let n = f64::from(side * side);
    (sum / n, squares / (n * (n - 1.0).max(1.0)))
}
