//! Lights drawn by what arrives from each.

use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::strategy::{Picks, Tally};

/// `picks` independent draws of `lights` by the weights in `sums`.
#[inline]
pub(in crate::strategies) fn draw<T: Tally>(
    sums: &Cumulative,
    lights: &[LightId],
    picks: u32,
    draws: &mut Draws,
    out: &mut Picks<'_, T>,
) {
    for j in 0..picks {
        if let Some((index, pmf)) = sums.pick(draws.choice(j, picks)) {
            out.push(lights[index], (1.0 / (f64::from(picks) * pmf)) as f32);
        }
    }
}

/// Adds the expected counts of [`draw`] for lights weighed by importance.
pub(in crate::strategies) fn expect(scene: &Scene, lights: &[LightId], picks: u32, at: &Receiver, counts: &mut [f32]) {
    let weight = |&id: &LightId| f64::from(importance(&scene.lights()[id as usize], at));
    let total: f64 = lights.iter().map(weight).sum();
    if total > 0.0 {
        lights.iter().for_each(|id| counts[*id as usize] += (f64::from(picks) * weight(id) / total) as f32);
    }
}
