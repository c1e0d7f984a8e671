//! How many points does each triangle deserve at each receiver, if the image is to be exact to a given relMSE?
//!
//! One price for all receivers and lights, the weighted squared error that a shadow ray must at least take away, decides
//! every number of points: at the optimum all rays are worth the same. A triangle that could add less than a ray is worth
//! is sampled now and then, weighted for the times it is not. Of any other the receiver first takes a look: a few points,
//! whose differences say how fast the light changes from one part of the triangle to the next. A penumbra needs many
//! points, a triangle in full view or hidden few.
//!
//! Looks have random numbers of their own and are thrown away, so that what they say of the number of points biases
//! nothing.

use super::exact::{Exact, deltas, grid, grid_side, stratified};
use crate::base::colour::luminance;
use crate::base::random::Stream;
use crate::base::rel_mse::RelMse;
use crate::scene::light::{Kind, Light};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::by_angle::seen;
use crate::shading::importance::importance;
use crate::visibility::stage::Stage;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// What a shadow ray must be worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Price {
    /// How squared errors are weighed.
    pub relative: RelMse,
    /// relMSE of the receiver that a ray takes away, at least.
    pub a_ray: f64,
}

/// The variance of the mean of a jittered grid of `n` points falls as `n^-FALL` in a penumbra, where only the cells on the
/// shadow's edge matter, and faster in full light.
pub(crate) const FALL: f64 = 1.5;

/// Points of a receiver's first looks, on top of one a light.
const POINTS: u32 = 64;

/// A look is believed of grids with up to so many times as many points along a side; then a closer one is taken.
const BELIEVED: u32 = 3;

/// Most points along a side.
const MOST: f64 = 2048.0;

/// Chance that there is, in a point's share of a light, a shadow or a gap that the points of a look do not show.
///
/// Without it the lights that looks find hidden would keep one point at any price, and decide the error: first-night
/// took 29,000 rays a receiver to 2.2e-7, and takes 2,600 to 8.5e-8. A chance of 0.05 to 1 changes that by a third.
const UNSEEN: f64 = 0.3;

/// The exact radiance of a receiver, at a price; `seed` names the random numbers.
pub(crate) fn refined(stage: &Stage, at: &Receiver, price: Price, seed: u64) -> Exact {
    let mut rays = 0;
    let sum = deltas(stage, at, &mut rays);
    let lights = stage.scene().lights().iter().filter(|light| light.kind() == Kind::Triangle);
    let lights: Vec<Open<'_>> = lights.filter_map(|light| Open::of(light, at)).collect();
    let total: f64 = lights.iter().map(|open| open.most).sum();
    let mut rng = Stream::keyed(&[seed, LOOKS, u64::from(at.pixel)]);
    let mut look = |open: &Open<'_>, side| Look::new(stage, at, open, side, &mut rng, &mut rays);
    // The few that add most tell how bright the receiver is, and so what an error at it weighs.
    let bright = |open: &&Open<'_>| open.most * f64::from(POINTS) >= total;
    let seen: DVec3 = lights.iter().filter(bright).map(|open| look(open, 1).mean).sum();
    let worth = Worth { weight: price.relative.weight((sum + seen).as_vec3()), a_ray: price.a_ray };
    let shares: Vec<(&Light, Share)> = lights
        .iter()
        .map(|open| {
            let chance = worth.chance(open.radiance);
            if chance < 1.0 {
                return (open.light, Share::Sometimes(chance));
            }
            let mut seen = look(open, grid_side(POINTS, open.most / total));
            while worth.side(&seen) > BELIEVED * seen.side {
                seen = look(open, worth.side(&seen).div_ceil(BELIEVED));
            }
            (open.light, Share::Grid(worth.side(&seen)))
        })
        .collect();
    let [(first, mark), (second, another)] = [0, 1].map(|half| {
        let mut rng = Stream::keyed(&[seed, half, u64::from(at.pixel), price.a_ray.to_bits()]);
        // Where the chances of the lights up to one pass a whole number more, that one is sampled.
        let mut chances = rng.uniform64();
        let mut sum = DVec3::ZERO;
        for &(light, share) in &shares {
            match share {
                Share::Grid(side) => sum += stratified(stage, at, light, side, &mut rng, &mut rays),
                Share::Sometimes(chance) => {
                    chances += chance;
                    if chances >= 1.0 {
                        chances -= 1.0;
                        sum += stratified(stage, at, light, 1, &mut rng, &mut rays) / chance;
                    }
                }
            }
        }
        (sum, rng.bits())
    });
    Exact { sum, halves: [first, second], marks: [mark, another], rays }
}

/// Names the random numbers of looks: never a half's.
const LOOKS: u64 = u64::from_le_bytes(*b"thelooks");

/// How a half samples a light.
#[derive(Clone, Copy)]
enum Share {
    /// By a grid with so many points along a side.
    Grid(u32),
    /// By one point, with this chance, below 1.
    Sometimes(f64),
}

/// A light that can add something.
struct Open<'a> {
    light: &'a Light,
    /// See [`importance`].
    most: f64,
    /// Radiance in cd/m^2 that it would add with nothing in between, about.
    radiance: DVec3,
}

impl<'a> Open<'a> {
    fn of(light: &'a Light, at: &Receiver) -> Option<Self> {
        let most = most(light, at);
        let grey = f64::from(luminance(light.colour));
        let radiance = (light.colour * at.albedo).as_dvec3() * (most / grey * FRAC_1_PI);
        (most > 0.0).then_some(Self { light, most, radiance })
    }
}

/// What it could add with nothing in between: by its centroid, and where it looks large or has a near end in closed form,
/// since the centroid of a light of kilometres says nothing of it.
fn most(light: &Light, at: &Receiver) -> f64 {
    let by_centroid = f64::from(importance(light, at));
    if by_centroid > 0.0 && LightSampling::Auto.settled(light, at) != LightSampling::Area {
        let irradiance = seen(light, at).irradiance(at.normal.as_dvec3());
        return by_centroid.max(irradiance * f64::from(luminance(light.colour)));
    }
    by_centroid
}

/// What a look at a light shows.
struct Look {
    /// Points along a side of its two grids.
    side: u32,
    mean: DVec3,
    /// Variance of the mean of one grid.
    variance: DVec3,
}

impl Look {
    fn new(stage: &Stage, at: &Receiver, open: &Open<'_>, side: u32, rng: &mut Stream, rays: &mut u64) -> Self {
        let n = f64::from(side * side);
        let mut scan = || {
            let (mut sum, mut squares, mut before) = (DVec3::ZERO, DVec3::ZERO, None);
            grid(stage, at, open.light, side, rng, rays, |value| {
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
        let unseen = open.radiance * open.radiance * (UNSEEN / (2.0 * n * n));
        Self { side, mean: (a + b) * 0.5, variance: variance.max(unseen) }
    }
}

/// What points are worth at a receiver.
struct Worth {
    weight: DVec3,
    a_ray: f64,
}

impl Worth {
    /// Side of the grid from which on another ray takes away less than the price: the mean of two halves of `n` points
    /// each has half the variance of one and takes `2 n` rays.
    fn side(&self, look: &Look) -> u32 {
        let rough = self.error(look.variance) * f64::from(look.side * look.side).powf(FALL);
        let points = (FALL * rough / (4.0 * self.a_ray)).powf(1.0 / (FALL + 1.0));
        points.sqrt().ceil().clamp(1.0, MOST) as u32
    }

    /// The chance, as often as 1 and more, of a light's being sampled from which on another ray takes away less than the
    /// price: a light of radiance `r` that is sampled with a chance `q` in each half has a variance of `r^2 / (2 q)` at
    /// most, and takes `2 q` rays.
    fn chance(&self, radiance: DVec3) -> f64 {
        // Never so seldom that one sample outshines all else.
        (self.error(radiance * radiance) / (4.0 * self.a_ray)).sqrt().max(RAREST)
    }

    /// A variance as relMSE.
    fn error(&self, variance: DVec3) -> f64 {
        (variance * self.weight).element_sum() / 3.0
    }
}

/// Least chance that a light which can add anything is sampled in a half.
const RAREST: f64 = 1.0 / 256.0;
