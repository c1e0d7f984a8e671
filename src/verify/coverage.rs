//! Can every light that adds something be chosen?

use super::Check;
use super::observe::Site;
use crate::scene::light::Light;
use crate::shading::importance::importance;

/// The check's name.
pub(super) const COVERAGE: &str = "coverage";

/// Where expected counts cannot be told, a light must have been seen that has this share of the radiance, shadows or no
/// shadows, in enough draws to see it a hundred times were lights picked by what they add. One that stands in the light of
/// another may be right to wait.
const NOTICEABLE: f64 = 0.01;
const OFTEN: f64 = 100.0;

/// Counts the lights that add something at a receiver and have no chance there.
pub(super) fn coverage(lights: &[Light], sites: &[Site<'_>]) -> Check {
    let mut missing = 0u64;
    let mut hypotheses = 0u64;
    let mut first = None;
    for site in sites {
        let total = site.truth.total();
        let noticeable = NOTICEABLE.max(OFTEN / site.draws());
        // What each light could add with nothing in between, scaled to the same sum.
        let open: Vec<f64> = lights.iter().map(|light| f64::from(importance(light, &site.at))).collect();
        let scale = total / open.iter().sum::<f64>();
        for (light, value) in site.truth.lights().iter().enumerate().filter(|(i, _)| site.truth.adds(*i)) {
            hypotheses += 1;
            let covered = match site.expected() {
                Some(counts) => counts[light] > 0.0,
                None => site.seen[light] || value.min(open[light] * scale) < noticeable * total,
            };
            if !covered {
                missing += 1;
                first.get_or_insert((light, site.at.pixel, value / total));
            }
        }
    }
    let place = first.map_or_else(String::new, |(light, pixel, share)| {
        format!("; light {light} is {:.3} % of the radiance at pixel {pixel} and has no chance there", share * 100.0)
    });
    let detail = format!("lights that add something and cannot be chosen, of {hypotheses}{place}");
    Check::new(COVERAGE, missing as f64, 0.0, detail)
}
