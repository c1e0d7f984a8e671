//! Is the mean estimate the exact sum?

use super::check::Check;
use super::observe::{Batch, Seen, Site, freedom};
use super::options::VerifyOptions;
use super::unseen::Missing;
use super::weights::ROUNDING;
use crate::base::statistics::{Moments, sidak, skewness, student_p, student_quantile, unskewed};

/// The checks' names.
pub(super) const ESTIMATE: &str = "estimate";
pub(super) const IMAGE: &str = "image-mean";
pub(super) const BIAS: &str = "bias";

/// A difference with its variance and the degrees of freedom that this is known with.
struct Difference {
    value: f64,
    variance: f64,
    freedom: f64,
    /// Of the mean, by the model; and of a batch, as measured where there is no model, with the number of batches.
    skewness: f64,
    measured: (f64, usize),
    missing: Missing,
}

/// From this skewness of a mean on, a measured variance may be luck: the model's is the least.
const LOPSIDED: f64 = 0.03;

impl Difference {
    /// Welch 1947: the estimate's own variance and the reference's. `model` holds the variance, the least variance and
    /// the third central moment that the mean of the draws should have.
    ///
    /// The variance of the model is that of independent picks. Numbers spread evenly over passes leave less, but
    /// nothing is gained for lights so rare that they make a mean lopsided; where it is, the test is as strong as with
    /// independent picks.
    fn of(batches: &[f64], wanted: Moments, model: [f64; 3], told: bool, missing: Missing) -> Self {
        let found = Moments::of(batches.iter().copied());
        let [model_variance, least, third] = model;
        let mut own = (found.variance / found.n as f64).max(least);
        let lopsided = third.abs() > LOPSIDED * model_variance.powf(1.5);
        if lopsided {
            own = own.max(model_variance);
        }
        let reference = wanted.variance / wanted.n as f64;
        // The truth of lights without extent is a sum of f32 contributions: right to their rounding.
        let variance = own + reference + (ROUNDING * wanted.mean).powi(2);
        let shares = own * own / (found.n as f64 - 1.0) + reference * reference / (wanted.n as f64 - 1.0);
        let freedom = if shares > 0.0 { (own + reference).powi(2) / shares } else { found.n as f64 - 1.0 };
        let measured = (if told { 0.0 } else { skewness(batches.iter().copied()) }, found.n);
        let skewness = if lopsided { third / variance.powf(1.5) } else { 0.0 };
        Self { value: found.mean - wanted.mean, variance, freedom: freedom.max(1.0), skewness, measured, missing }
    }

    /// The t statistic without its skewness, to first order (Johnson, JASA 73, 1978).
    fn t(&self) -> f64 {
        let sure = self.missing.left_of(self.value);
        if sure == 0.0 {
            return 0.0;
        }
        let t = sure / self.variance.sqrt();
        unskewed(t - self.skewness / 6.0 * (t * t - 1.0), self.measured.0, self.measured.1)
    }

    /// What may not have been seen, as a text.
    fn not_shown(&self, percent: f64) -> String {
        let Missing { too_high, too_low } = self.missing;
        if too_high + too_low == 0.0 {
            return String::new();
        }
        format!(", rare events {:+.3} to {:+.3} %", -percent * too_high, percent * too_low)
    }

    fn p(&self) -> f64 {
        student_p(self.t(), self.freedom as usize)
    }
}

/// How far the estimate is from the truth: at each receiver, and in the mean over all, where a small common bias shows
/// first.
pub(super) struct Distance<'a> {
    sites: &'a [Site<'a>],
    each: Vec<Difference>,
    mean: Difference,
    /// What the receivers' means should sum to.
    covered: f64,
}

impl<'a> Distance<'a> {
    pub(super) fn new(seen: &'a Seen<'a>, options: &VerifyOptions) -> Self {
        let sites = &seen.sites;
        let level = sidak(options.level, sites.len() + 1);
        let wanted: Vec<Moments> = sites.iter().map(Site::wanted).collect();
        let told = |site: &Site<'_>| site.expected().is_some();
        let missing: Vec<Missing> = sites.iter().map(|site| site.unseen().missing(level)).collect();
        let each = sites.iter().zip(wanted.iter().zip(&missing)).map(|(site, (wanted, missing))| {
            Difference::of(&site.frequent(), *wanted, site.model(), told(site), *missing)
        });
        // Receivers draw from streams of their own: their moments add.
        let sum = |of: fn(&Moments) -> f64| wanted.iter().map(of).sum::<f64>();
        let n = wanted.first().map_or(2, |wanted| wanted.n);
        let (covered, variance) = (sum(|wanted| wanted.mean), sum(|wanted| wanted.variance));
        let of_all = Moments { n, mean: covered, variance };
        let model = sites.iter().map(Site::model).fold([0.0; 3], |[a, b, c], [x, y, z]| [a + x, b + y, c + z]);
        // Receivers may share what a pass decides: what each may have missed adds up.
        let too_high = missing.iter().map(|missing| missing.too_high).sum();
        let of_image = Missing { too_high, ..seen.image.missing(level) };
        let batches = sums(sites, |batch| batch.frequent);
        let mean = Difference::of(&batches, of_all, model, sites.iter().all(told), of_image);
        Self { sites, each: each.collect(), mean, covered }
    }

    /// The greatest surprise of all, the pixel where it is, and how far off that is.
    pub(super) fn worst(&self) -> (f64, Option<u32>, String) {
        let mut worst = (0.0f64, None, String::new());
        for (site, difference) in self.sites.iter().zip(&self.each) {
            let surprise = surprise(difference.p());
            if surprise > worst.0 {
                let wanted = site.wanted().mean;
                let percent = 100.0 / wanted.max(1e-30);
                worst = (
                    surprise,
                    Some(site.at.pixel),
                    format!(
                        "; {:+.3} % of {wanted:.4e}, standard error {:.3} %{}",
                        percent * difference.value,
                        percent * difference.variance.sqrt(),
                        difference.not_shown(percent)
                    ),
                );
            }
        }
        worst
    }

    /// The surprise of the mean over all.
    pub(super) fn of_mean(&self) -> f64 {
        surprise(self.mean.p())
    }

    /// Share of the radiance that is tested, in percent.
    pub(super) fn tested(&self) -> f64 {
        let total: f64 = self.sites.iter().map(|site| site.truth.total()).sum();
        if total > 0.0 { 100.0 * self.covered / total } else { 100.0 }
    }
}

/// Two checks: each receiver on its own, and the mean over all of them.
///
/// The statistic of the first is the natural logarithm of 1 / p, so that one limit serves all degrees of freedom.
pub(super) fn estimate(seen: &Seen<'_>, options: &VerifyOptions) -> [Check; 2] {
    let (sites, distance) = (&seen.sites, Distance::new(seen, options));
    let (worst, pixel, off) = distance.worst();
    let detail = format!(
        "greatest ln 1/p of {} receivers, {:.2} % of the radiance tested, seed {}{off}",
        sites.len(),
        distance.tested(),
        options.seed,
    );
    let receivers = Check::new(ESTIMATE, worst, surprise(sidak(options.level, sites.len())), detail).at(pixel, None);

    let (mean, percent) = (&distance.mean, 100.0 / distance.covered.max(1e-30));
    let limit = student_quantile(1.0 - 0.5 * options.level, freedom(sites));
    let detail = format!(
        "|t| of the mean over receivers: {:+.4} % off; detectable {:.3} %{}, seed {}",
        percent * mean.value,
        percent * ((limit + 0.85) * mean.variance.sqrt() + mean.missing.too_high.max(mean.missing.too_low)),
        mean.not_shown(percent),
        options.seed
    );
    [receivers, Check::new(IMAGE, mean.t().abs(), limit, detail)]
}

/// The bias of a strategy that declares one, as a share of the mean radiance, with its 95 % interval; always passes.
pub(super) fn bias(sites: &[Site<'_>], why: &str) -> Check {
    let found = Moments::of(sums(sites, |batch| batch.whole));
    let wanted: f64 = sites.iter().map(|site| site.truth.total()).sum();
    let scale = 1.0 / wanted.max(f64::MIN_POSITIVE);
    let value = (found.mean - wanted) * scale;
    let width = found.half_width(0.95) * scale;
    let detail = format!("declared: {why}; mean radiance off by {:+.4} % +- {:.4} %", 100.0 * value, 100.0 * width);
    Check::new(BIAS, value, f64::INFINITY, detail)
}

/// The sum over receivers of each batch.
fn sums(sites: &[Site<'_>], of: fn(&Batch) -> f64) -> Vec<f64> {
    let batches = sites.first().map_or(0, |site| site.batches as usize);
    (0..batches).map(|batch| sites.iter().map(|site| of(site.batch(batch))).sum()).collect()
}

pub(super) fn surprise(p: f64) -> f64 {
    -p.max(f64::MIN_POSITIVE).ln()
}
