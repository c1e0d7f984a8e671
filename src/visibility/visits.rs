//! Which points do passes visit?
//!
//! A picture of one moment visits the point at each pixel's centre in every pass. A path tracer does not: each of its
//! samples lies somewhere else in the pixel, and most of its shadow rays start where a path has bounced to. Here both are
//! conditions under which strategies are compared: what is arrived at once and visited once must pay for its arrival.
//!
//! The points of a pixel's passes are one low-discrepancy sequence. They depend on the scene and the pixel alone, not on a
//! run or a seed, so that the truth at each of them has to be found only once.

use super::occluders::Occluders;
use super::offset::RayEnds;
use super::view::{Found, look};
use crate::base::draws::{Draws, Points, Sequence};
use crate::base::random::RunKey;
use crate::scene::Scene;
use crate::scene::receiver::Receiver;
use glam::DVec3;
use std::f64::consts::TAU;

/// Which points the passes of a pixel visit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Receivers {
    /// What the pixel sees through its centre: the same in every pass.
    #[default]
    Centre,
    /// In each pass what the pixel sees through another point of it.
    Spread,
    /// In each pass what a ray meets that leaves such a point, distributed as the cosine to its normal.
    Bounce,
}

impl Receivers {
    /// All of them by name, default first.
    pub(crate) const NAMED: [(&'static str, Self); 3] =
        [("centre", Self::Centre), ("spread", Self::Spread), ("bounce", Self::Bounce)];

    /// The one of that name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::NAMED.into_iter().find(|(known, _)| *known == name).map(|(_, receivers)| receivers)
    }

    /// What it is called.
    pub(crate) fn name(self) -> &'static str {
        Self::NAMED[self as usize].0
    }

    /// Whether each pass visits points of its own.
    pub(crate) fn moves(self) -> bool {
        self != Self::Centre
    }
}

/// The point that a pixel visits in a pass, of those that move; none where its ray meets no surface, or the bounce none.
pub(super) fn visited(
    receivers: Receivers,
    scene: &Scene,
    occluders: &Occluders,
    ends: RayEnds,
    pixel: u32,
    pass: u32,
) -> Option<Receiver> {
    let mut draws = Sequence::new(PLACES, pixel, Points::Sobol).pass(pass);
    let camera = scene.camera();
    let width = camera.resolution().0;
    let [x, y] = draws.point(FILM).map(f64::from);
    let direction = camera.direction_through(f64::from(pixel % width) + x, f64::from(pixel / width) + y);
    let seen = surface(&look(scene, occluders, camera.position(), direction, pixel))?;
    if receivers != Receivers::Bounce {
        return Some(seen);
    }
    let direction = bounced(seen.normal.as_dvec3(), &mut draws);
    surface(&look(scene, occluders, ends.start(&seen), direction, pixel))
}

fn surface(found: &Found) -> Option<Receiver> {
    if let Found::Surface(receiver) = found { Some(*receiver) } else { None }
}

/// Names the numbers that decide the points: no run of anybody's.
const PLACES: RunKey = RunKey { seed: u64::from_le_bytes(*b"places.."), run: u32::MAX };
/// The pairs of numbers that a pixel's pass takes: the place on the film, the direction of the bounce.
const FILM: u32 = 0;
const BOUNCE: u32 = 1;

/// A direction above the surface with probability density cosine / pi.
///
/// Source: Malley's method; Pharr, Jakob and Humphreys, Physically Based Rendering, 4th ed., section A.5.3.
fn bounced(normal: DVec3, draws: &mut Draws) -> DVec3 {
    let [u, v] = draws.point(BOUNCE).map(f64::from);
    let (a, b) = normal.any_orthonormal_pair();
    let (sin, cos) = (TAU * v).sin_cos();
    let radius = u.sqrt();
    (a * (radius * cos) + b * (radius * sin) + normal * (1.0 - u).sqrt()).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_for_themselves() {
        for (name, receivers) in Receivers::NAMED {
            assert_eq!((Receivers::named(name), receivers.name()), (Some(receivers), name));
        }
        assert_eq!(Receivers::named("center"), None);
        assert!(!Receivers::default().moves());
    }

    #[test]
    fn bounces_are_distributed_as_the_cosine() {
        let normal = DVec3::new(0.6, 0.0, 0.8);
        let n = 4096;
        let cosines: Vec<f64> = (0..n)
            .map(|pass| bounced(normal, &mut Sequence::new(PLACES, 5, Points::Sobol).pass(pass)).dot(normal))
            .collect();
        assert!(cosines.iter().all(|&cosine| cosine > 0.0));
        // The mean of the cosine is 2/3, of its square 1/2.
        let mean = |power: i32| cosines.iter().map(|cosine| cosine.powi(power)).sum::<f64>() / f64::from(n);
        assert!((mean(1) - 2.0 / 3.0).abs() < 2e-3 && (mean(2) - 0.5).abs() < 2e-3, "{} {}", mean(1), mean(2));
    }
}
