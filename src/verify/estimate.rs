//! Is the mean estimate the exact sum?

use super::observe::Site;
use super::weights::ROUNDING;
use super::{Check, Options};
use crate::base::statistics::{Moments, sidak, student_p, student_quantile};

/// The checks' names.
const ESTIMATE: &str = "estimate";
const IMAGE: &str = "image-mean";
const BIAS: &str = "bias";

/// A difference with its variance and the degrees of freedom that this is known with.
struct Difference {
    value: f64,
    variance: f64,
    freedom: f64,
}

impl Difference {
    /// Welch 1947: the estimate's own variance and the reference's.
    fn of(found: Moments, wanted: Moments, at_least: f64) -> Self {
        let own = (found.variance / found.n as f64).max(at_least);
        let reference = wanted.variance / wanted.n as f64;
        // The truth of lights without extent is a sum of f32 contributions: right to their rounding.
        let rounding = (ROUNDING * wanted.mean).powi(2);
        let variance = own + reference;
        let shares = own * own / (found.n as f64 - 1.0) + reference * reference / (wanted.n as f64 - 1.0);
        let freedom = if shares > 0.0 { variance * variance / shares } else { found.n as f64 - 1.0 };
        Self { value: found.mean - wanted.mean, variance: variance + rounding, freedom: freedom.max(1.0) }
    }

    fn p(&self) -> f64 {
        if self.value == 0.0 { 1.0 } else { student_p(self.value / self.variance.sqrt(), self.freedom as usize) }
    }
}

/// Two checks: each receiver on its own, and the mean over all of them, where a small common bias shows first.
///
/// The statistic is the natural logarithm of 1 / p, so that one limit serves all degrees of freedom.
pub(super) fn estimate(sites: &[Site], options: &Options) -> [Check; 2] {
    let mut worst = (0.0f64, String::new());
    for site in sites {
        let difference = Difference::of(site.frequent, site.wanted, site.rare_variance / site.draws());
        let surprise = surprise(difference.p());
        if surprise > worst.0 {
            worst = (
                surprise,
                format!(
                    "; worst at pixel {}: {:+.3} % of {:.4e}, standard error {:.3} %",
                    site.at.pixel,
                    100.0 * difference.value / site.wanted.mean,
                    site.wanted.mean,
                    100.0 * difference.variance.sqrt() / site.wanted.mean
                ),
            );
        }
    }
    let each = sidak(options.level, sites.len());
    let covered: f64 = sites.iter().map(|site| site.wanted.mean).sum();
    let total: f64 = sites.iter().map(|site| site.truth.total()).sum();
    let share = if total > 0.0 { 100.0 * covered / total } else { 100.0 };
    let detail = format!(
        "greatest ln 1/p of {} receivers, {share:.2} % of the radiance tested, seed {}{}",
        sites.len(),
        options.seed,
        worst.1
    );
    let receivers = Check::new(ESTIMATE, worst.0, surprise(each), detail);

    // Receivers draw from streams of their own, so that variances add.
    let found = mean_of(sites, |site| &site.batch_frequent);
    let mut variance = found.variance / found.n.max(1) as f64;
    let model: f64 = sites.iter().map(|site| site.rare_variance / site.draws()).sum();
    variance = variance.max(model);
    let reference: f64 = sites.iter().map(|site| site.wanted.variance / site.wanted.n as f64).sum();
    let error = (variance + reference + (ROUNDING * covered).powi(2)).sqrt();
    let t = if covered == found.mean { 0.0 } else { (found.mean - covered) / error };
    let limit = student_quantile(1.0 - 0.5 * options.level, options.batches.max(2) as usize - 1);
    let detail = format!(
        "|t| of the mean over receivers: {:+.4} % off; detectable {:.3} %, seed {}",
        100.0 * (found.mean - covered) / covered.max(f64::MIN_POSITIVE),
        100.0 * (limit + 0.85) * error / covered.max(f64::MIN_POSITIVE),
        options.seed
    );
    [receivers, Check::new(IMAGE, t.abs(), limit, detail)]
}

/// The bias of a strategy that declares one, as a share of the mean radiance, with its 95 % interval; always passes.
pub(super) fn bias(sites: &[Site], why: &str) -> Check {
    let found = mean_of(sites, |site| &site.batch_whole);
    let wanted: f64 = sites.iter().map(|site| site.truth.total()).sum();
    let scale = 1.0 / wanted.max(f64::MIN_POSITIVE);
    let value = (found.mean - wanted) * scale;
    let width = found.half_width(0.95) * scale;
    let detail = format!("declared: {why}; mean radiance off by {:+.4} % +- {:.4} %", 100.0 * value, 100.0 * width);
    Check { name: BIAS, statistic: value, limit: f64::INFINITY, passed: true, detail }
}

/// Moments over batches of the sum over receivers.
fn mean_of<'a>(sites: &'a [Site], of: impl Fn(&'a Site) -> &'a Vec<f64>) -> Moments {
    let batches = sites.first().map_or(0, |site| site.batches as usize);
    let sums: Vec<f64> = (0..batches).map(|batch| sites.iter().map(|site| of(site)[batch]).sum()).collect();
    Moments::of(sums.iter().copied())
}

fn surprise(p: f64) -> f64 {
    -p.max(f64::MIN_POSITIVE).ln()
}
