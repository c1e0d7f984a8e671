//! Do the weights of each light sum to 1 on average?

use super::check::Check;
use super::observe::{PLENTY, Site, freedom};
use super::options::VerifyOptions;
use super::truth::REPEATS;
use crate::base::statistics::{sidak, student_quantile};

/// The checks' names.
pub(super) const WEIGHTS: &str = "weights";
pub(super) const TOTAL: &str = "weights-total";

/// f32 rounding of weights and expected counts, as a share of a sum.
pub(super) const ROUNDING: f64 = 1e-5;

/// Two checks: bins of lights, each at each receiver; and all picks together.
pub(super) fn weights(sites: &[Site<'_>], options: &VerifyOptions) -> [Check; 2] {
    [bins(sites, options), total(sites, options)]
}

fn bins(sites: &[Site<'_>], options: &VerifyOptions) -> Check {
    let hypotheses: usize = sites.iter().map(|site| site.bins().len()).sum();
    let (level, freedom) = (sidak(options.level, hypotheses), freedom(sites));
    let limit = student_quantile(1.0 - 0.5 * level, freedom);
    // The truth's own variance is known from few repetitions: it counts for more, as far out as the limit.
    let repetitions = student_quantile(1.0 - 0.5 * level, REPEATS - 1);
    let doubt = (repetitions / limit).powi(2);
    let mut worst = (0.0f64, None, String::new());
    for site in sites {
        for bin in site.bins() {
            let found = site.found(bin);
            let variance = site.variance(found, bin.expected, bin.chance) + bin.uncertain * doubt;
            // Few picks do not show their lopsidedness: it is Poisson's at most.
            let picks = bin.expected * site.draws();
            let skewness = if site.expected().is_some() && picks < PLENTY { bin.chance / picks.sqrt() } else { 0.0 };
            let sure = bin.unseen.missing(level).left_of(found.mean - bin.expected);
            let z = sure / (variance + (ROUNDING * bin.expected).powi(2)).sqrt();
            // Johnson, JASA 73, 1978: a mean's statistic without its skewness, to first order.
            let z = site.unskewed(z - skewness / 6.0 * (z * z - 1.0), bin.batches());
            if z.is_nan() || z.abs() > worst.0 {
                worst = (
                    if z.is_nan() { f64::INFINITY } else { z.abs() },
                    Some((site.at.pixel, bin.first)),
                    format!("; of this light and its like {:.4} of {:.4} a call", found.mean, bin.expected),
                );
            }
        }
    }
    let detail = format!("greatest |t| of {hypotheses} bins, seed {}{}", options.seed, worst.2);
    Check::new(WEIGHTS, worst.0, limit, detail).at(worst.1.map(|at| at.0), worst.1.map(|at| at.1))
}

/// The mean of weight times expected count over the picks of lights that add something: 1.
///
/// Paired with the number of those picks, whose own mean `picks` checks: what the luck of the draw adds to both
/// cancels, and for independent picks nothing but rounding is left.
fn total(sites: &[Site<'_>], options: &VerifyOptions) -> Check {
    let known = sites.iter().filter(|site| site.expected().is_some());
    let (mut excess, mut variance, mut count) = (0.0, 0.0, 0.0);
    for site in known {
        let found = site.excess();
        excess += found.mean;
        variance += found.variance / found.n as f64;
        count += site.contributing().mean;
    }
    let limit = student_quantile(1.0 - 0.5 * options.level, freedom(sites));
    if count == 0.0 {
        return Check::new(TOTAL, 0.0, limit, "no pick of a light that adds anything".into());
    }
    let error = (variance + (ROUNDING * count).powi(2)).sqrt();
    let detail = format!(
        "|t| of the mean of weight x expected count: {:.6}; detectable {:.2e}, seed {}",
        1.0 + excess / count,
        (limit + 0.85) * error / count,
        options.seed
    );
    Check::new(TOTAL, (excess / error).abs(), limit, detail)
}
