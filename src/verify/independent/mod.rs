//! Does arithmetic that shares nothing with the program's come to the same?
//!
//! The truth that strategies are held to is made by the code that shades their picks: a fault there is in both and cannot
//! be seen. So everything is evaluated once more, from the formulas alone, in f64: pixel rays, normals on the viewer's
//! side, points on triangles, intensities, falloff, reflection, shadow rays with offsets of their own through a plain
//! list of all triangles. It shares no function with `visibility`, `shading` or `render`, and reads nothing but the
//! scene's numbers.
//!
//! | check | question | where |
//! |---|---|---|
//! | `receivers` | does each pixel see that point, with that normal and albedo? | `receivers` |
//! | `contribution` | does a point of a light add as much, with nothing in between? | `pairs` |
//! | `visibility` | does it arrive? | `pairs` |
//! | `triangle-mean` | do points drawn by angle add up to the triangle's closed form? | `means` |
//! | `importance` | is no triangle left out that can add anything? | `means` |
//! | `exact-sum` | is the exact image the sum over all lights? | `sums` |
//!
//! Shadow rays are traced through every triangle, so their number is bounded (`TESTS`).

mod geometry;
mod light;
mod means;
mod pairs;
mod receivers;
mod sums;

use super::check::Check;
use crate::render::exact;
use crate::scene::light::LightId;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::shading::importance::importance;
use crate::visibility::stage::Stage;
use geometry::Geometry;
use glam::DVec3;

/// The checks' names.
pub(super) const NAMES: [&str; 6] =
    [receivers::RECEIVERS, pairs::CONTRIBUTION, pairs::VISIBILITY, means::MEAN, means::IMPORTANCE, sums::SUM];

/// Pairs of a receiver and a light that are looked at.
const PAIRS: usize = 2_000;

/// Most tests of a ray against a triangle for `visibility`, and as many for `exact-sum`: a quarter of a CPU second each.
/// Scenes of more than 20,000 triangles get fewer shadow rays, and say how many.
const TESTS: usize = 40_000_000;

/// How the program comes to what a light adds at a receiver. Tests put a wrong one in its place.
pub trait Path: Sync {
    /// What the camera sees.
    fn receivers(&self) -> &[Receiver];
    /// What the point `uv` of a light, drawn `by` a way, adds at a receiver with nothing in between, in cd/m^2.
    fn unshadowed(&self, by: LightSampling, light: LightId, uv: [f32; 2], at: &Receiver) -> DVec3;
    /// Whether light from the point `uv`, by area, arrives; asked only where something could.
    fn visible(&self, light: LightId, uv: [f32; 2], at: &Receiver) -> bool;
    /// What lights are left out of sums by, where it is 0.
    fn importance(&self, light: LightId, at: &Receiver) -> f32;
    /// Two independent estimates of the radiance of a receiver, with `points` more points on triangles than one each.
    fn exact(&self, at: &Receiver, points: u32, seed: u64) -> [DVec3; 2];
}

/// The program's own path.
pub struct Own<'a>(pub &'a Stage);

impl Path for Own<'_> {
    fn receivers(&self) -> &[Receiver] {
        self.0.receivers()
    }

    fn unshadowed(&self, by: LightSampling, light: LightId, uv: [f32; 2], at: &Receiver) -> DVec3 {
        let light = &self.0.scene().lights()[light as usize];
        contribution::<0b1111>(by, light, uv, at).map_or(DVec3::ZERO, |arrival| arrival.radiance.as_dvec3())
    }

    fn visible(&self, light: LightId, uv: [f32; 2], at: &Receiver) -> bool {
        let light = &self.0.scene().lights()[light as usize];
        exact::shadowed(self.0, LightSampling::Area, at, light, uv, &mut 0) != DVec3::ZERO
    }

    fn importance(&self, light: LightId, at: &Receiver) -> f32 {
        importance(&self.0.scene().lights()[light as usize], at)
    }

    fn exact(&self, at: &Receiver, points: u32, seed: u64) -> [DVec3; 2] {
        let found = exact::exact(self.0, at, points, seed);
        found.halves.map(|half| found.sum + half)
    }
}

/// Checks a path of the scene of a stage. `level` is the chance that the one check of them that goes by chance,
/// `exact-sum`, fails although all is right.
pub fn independent(stage: &Stage, path: &dyn Path, seed: u64, level: f64) -> Vec<Check> {
    let geometry = Geometry::new(stage.scene());
    let mut checks = vec![receivers::receivers(&geometry, path.receivers(), seed)];
    checks.extend(pairs::pairs(&geometry, path, seed));
    checks.extend(means::means(&geometry, path, stage.light_sampling(), seed));
    checks.push(sums::sum(&geometry, path, seed, level));
    checks
}
