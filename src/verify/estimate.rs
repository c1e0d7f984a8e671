//! Is the mean estimate the exact sum?

use super::observe::{Site, freedom};
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
    skewness: f64,
}

/// From this skewness of a mean on, a measured variance may be luck: the model's is the least.
const LOPSIDED: f64 = 0.03;

impl Difference {
    /// Welch 1947: the estimate's own variance and the reference's. `model` holds the variance and the third central
    /// moment that the mean of the draws should have.
    fn of(found: Moments, wanted: Moments, model: (f64, f64)) -> Self {
        let mut own = found.variance / found.n as f64;
        let (model_variance, third) = model;
        let lopsided = third.abs() > LOPSIDED * model_variance.powf(1.5);
        if lopsided {
            own = own.max(model_variance);
        }
        let reference = wanted.variance / wanted.n as f64;
        // The truth of lights without extent is a sum of f32 contributions: right to their rounding.
        let variance = own + reference + (ROUNDING * wanted.mean).powi(2);
        let shares = own * own / (found.n as f64 - 1.0) + reference * reference / (wanted.n as f64 - 1.0);
        let freedom = if shares > 0.0 { (own + reference).powi(2) / shares } else { found.n as f64 - 1.0 };
        let skewness = if lopsided { third / variance.powf(1.5) } else { 0.0 };
        Self { value: found.mean - wanted.mean, variance, freedom: freedom.max(1.0), skewness }
    }

    /// The t statistic without its skewness, to first order (Johnson, JASA 73, 1978).
    fn t(&self) -> f64 {
        if self.value == 0.0 {
            return 0.0;
        }
        let t = self.value / self.variance.sqrt();
        t - self.skewness / 6.0 * (t * t - 1.0)
    }

    fn p(&self) -> f64 {
        student_p(self.t(), self.freedom as usize)
    }
}

/// Two checks: each receiver on its own, and the mean over all of them, where a small common bias shows first.
///
/// The statistic is the natural logarithm of 1 / p, so that one limit serves all degrees of freedom.
pub(super) fn estimate(sites: &[Site], options: &Options) -> [Check; 2] {
    let mut worst = (0.0f64, String::new());
    for site in sites {
        let difference = Difference::of(site.frequent, site.wanted, model(site));
        let surprise = surprise(difference.p());
        if surprise > worst.0 {
            worst = (
                surprise,
                format!(
                    "; worst at pixel {}: {:+.3} % of {:.4e}, standard error {:.3} %",
                    site.at.pixel,
                    100.0 * difference.value / site.wanted.mean.max(1e-30),
                    site.wanted.mean,
                    100.0 * difference.variance.sqrt() / site.wanted.mean.max(1e-30)
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

    // Receivers draw from streams of their own: their moments add.
    let found = mean_of(sites, |site| &site.batch_frequent);
    let repeats = sites.first().map_or(2, |site| site.wanted.n);
    let reference: f64 = sites.iter().map(|site| site.wanted.variance).sum();
    let third = sites.iter().map(model).fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    let difference = Difference::of(found, Moments { n: repeats, mean: covered, variance: reference }, third);
    let (t, error) = (difference.t(), difference.variance.sqrt());
    let limit = student_quantile(1.0 - 0.5 * options.level, freedom(sites));
    let detail = format!(
        "|t| of the mean over receivers: {:+.4} % off; detectable {:.3} %, seed {}",
        100.0 * (found.mean - covered) / covered.max(1e-30),
        100.0 * (limit + 0.85) * error / covered.max(1e-30),
        options.seed
    );
    [receivers, Check::new(IMAGE, t.abs(), limit, detail)]
}

/// Moments of the mean of a site's draws.
fn model(site: &Site) -> (f64, f64) {
    (site.model.0 / site.draws(), site.model.1 / (site.draws() * site.draws()))
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
