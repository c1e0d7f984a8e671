//! What do points on a triangle add up to, and is any triangle given up?

use super::geometry::Geometry;
use super::light::{irradiance, is_above, looks_small, surely_adds};
use super::path::Path;
use crate::base::random::Stream;
use crate::scene::light::LightId;
use crate::scene::light_sampling::LightSampling;
use crate::verify::check::Check;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// The checks' names.
pub(super) const MEAN: &str = "triangle-mean";
pub(super) const IMPORTANCE: &str = "importance";

/// Triangles whose mean is taken, how many are tried to find them, and the side of the grid of points on each.
const MEANS: usize = 64;
const TRIES: usize = 20_000;
const SIDE: usize = 16;

/// How far a mean over the grid may be off.
const COARSE: f64 = 0.02;

/// Most pairs whose importance is asked for, and receivers that they are shared out to.
const ASKED: usize = 200_000;
const RECEIVERS: usize = 64;

/// Two checks of triangles; none of them can fail where there are no triangles.
pub(super) fn means(geometry: &Geometry<'_>, path: &dyn Path, by: LightSampling, seed: u64) -> [Check; 2] {
    [mean(geometry, path, by, seed), importance(geometry, path, seed)]
}

/// Half of the triangles are those that the stage's way does not draw by area, where such are found.
fn mean(geometry: &Geometry<'_>, path: &dyn Path, by: LightSampling, seed: u64) -> Check {
    let (ids, receivers, lights) = (geometry.emitters(), path.receivers(), geometry.scene.lights());
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"the mean")]);
    let (mut worst, mut looked) = (Check::new(MEAN, 0.0, COARSE, String::new()), [0; 2]);
    let tries = if ids.is_empty() || receivers.is_empty() { 0 } else { TRIES };
    for _ in 0..tries {
        let (id, at) = (ids[rng.below(ids.len())], receivers[rng.below(receivers.len())]);
        let light = &lights[id as usize];
        let by_angle = usize::from(by.settled(light, &at) != LightSampling::Area);
        let Some(place) = geometry.place(&at).filter(|_| looked[by_angle] < MEANS / 2) else { continue };
        // Next to a triangle a grid by area is too coarse.
        let coarse = by_angle == 0 && !looks_small(light, &place);
        if coarse || !(surely_adds(light, &place) && is_above(light, &place)) {
            continue;
        }
        looked[by_angle] += 1;
        let middle = |i: usize| (i as f32 + 0.5) / SIDE as f32;
        let grid = (0..SIDE * SIDE).map(|i| [middle(i % SIDE), middle(i / SIDE)]);
        let found: DVec3 = grid.map(|uv| path.unshadowed(by, id, uv, &at)).sum::<DVec3>() / (SIDE * SIDE) as f64;
        let wanted = light.colour.as_dvec3() * place.albedo * (FRAC_1_PI * irradiance(light, &place));
        let off = (found - wanted).element_sum().abs() / wanted.element_sum().max(f64::MIN_POSITIVE);
        if off > worst.statistic || off.is_nan() {
            worst = Check::new(MEAN, off, COARSE, String::new()).at(Some(at.pixel), Some(id));
        }
    }
    let [area, angle] = looked;
    let detail = format!(
        "greatest difference of a mean over points from the closed form, of {area} triangles drawn by area and {angle} by angle; seed {seed}"
    );
    Check { detail, ..worst }
}

/// Counts the triangles that can add something and have no importance.
fn importance(geometry: &Geometry<'_>, path: &dyn Path, seed: u64) -> Check {
    let (ids, receivers) = (geometry.emitters(), path.receivers());
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"given up")]);
    let (mut asked, mut given_up) = (0, Vec::new());
    let rounds = if receivers.is_empty() { 0 } else { RECEIVERS };
    let step = (ids.len() * RECEIVERS).div_ceil(ASKED).max(1);
    for round in 0..rounds {
        let at = receivers[rng.below(receivers.len())];
        let Some(place) = geometry.place(&at) else { continue };
        let adding = |id: &&LightId| surely_adds(&geometry.scene.lights()[**id as usize], &place);
        for &id in ids.iter().skip(round % step).step_by(step).filter(adding) {
            asked += 1;
            if path.importance(id, &at) <= 0.0 {
                given_up.push((at.pixel, id));
            }
        }
    }
    let first = given_up.first();
    let detail = format!("triangles that can add something and have no importance, of {asked}; seed {seed}");
    Check::new(IMPORTANCE, given_up.len() as f64, 0.0, detail).at(first.map(|at| at.0), first.map(|at| at.1))
}
