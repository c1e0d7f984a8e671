//! Can every light that adds something be chosen?

use super::check::Check;
use super::observe::Site;
use super::truth::facing;
use crate::base::colour::luminance;
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::shading::importance::importance;

/// The check's name.
pub(super) const COVERAGE: &str = "coverage";

/// Where expected counts cannot be told, a light with this share of the radiance must have been seen.
const NOTICEABLE: f64 = 0.01;

/// Counts the lights that add something at a receiver and have no chance there.
///
/// Where expected counts cannot be told, a light that was never seen is suspicious only if weaker ones were, seen
/// often, however weakness is measured: by flux, by what arrives with nothing in between, by what does arrive, by what
/// would arrive if the surface faced the light. A right strategy may wait long for a light in the shadow of another, or for one
/// that is out of its usual range.
pub(super) fn coverage(scene: &Scene, sites: &[Site<'_>]) -> Check {
    let (lights, radius) = (scene.lights(), scene.radius());
    let mut missing = 0u64;
    let mut hypotheses = 0u64;
    let mut first = None;
    for site in sites {
        let total = site.truth.total();
        let value = |light: usize| site.truth.lights()[light];
        let strength = |light: usize| {
            let own = &lights[light];
            let open = f64::from(importance(own, &site.at));
            [f64::from(luminance(own.flux(radius))), open, value(light), facing(own, &site.at)]
        };
        let weaker_seen = |light: usize| {
            let own = strength(light);
            (0..lights.len()).any(|i| site.often(i) && strength(i).iter().zip(own).all(|(its, own)| *its <= own))
        };
        for light in (0..lights.len()).filter(|&light| site.truth.adds(light)) {
            hypotheses += 1;
            let covered = match site.expected() {
                Some(counts) => counts[light] > 0.0,
                None => site.seen[light] || value(light) < NOTICEABLE * total || !weaker_seen(light),
            };
            if !covered {
                missing += 1;
                first.get_or_insert((light as LightId, site.at.pixel, value(light) / total));
            }
        }
    }
    let share =
        first.map_or_else(String::new, |(.., share)| format!("; this one is {:.3} % of the radiance", share * 100.0));
    let detail = format!("lights that add something and cannot be chosen, of {hypotheses}{share}");
    Check::new(COVERAGE, missing as f64, 0.0, detail).at(first.map(|first| first.1), first.map(|first| first.0))
}
