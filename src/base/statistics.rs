//! Means, intervals and the tests that the checks rest on.

/// Sample size, mean and variance of a list of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moments {
    /// How many numbers.
    pub n: usize,
    /// Their mean; 0 of none.
    pub mean: f64,
    /// Their unbiased variance; 0 of fewer than two.
    pub variance: f64,
}

impl Moments {
    /// The moments of `values`, in two passes.
    pub(crate) fn of(values: impl IntoIterator<Item = f64> + Clone) -> Self {
        let (mut n, mut sum) = (0usize, 0.0);
        for v in values.clone() {
            n += 1;
            sum += v;
        }
        let mean = if n == 0 { 0.0 } else { sum / n as f64 };
        let squares: f64 = values.into_iter().map(|v| (v - mean) * (v - mean)).sum();
        Self { n, mean, variance: if n < 2 { 0.0 } else { squares / (n - 1) as f64 } }
    }

    /// Standard error of the mean; infinite for fewer than two numbers.
    pub(crate) fn standard_error(&self) -> f64 {
        if self.n < 2 { f64::INFINITY } else { (self.variance / self.n as f64).sqrt() }
    }

    /// Half the width of Student's interval for the mean at a confidence within (0, 1), `0.95`.
    #[cfg(feature = "measure")]
    pub(crate) fn half_width(&self, confidence: f64) -> f64 {
        if self.n < 2 {
            f64::INFINITY
        } else {
            student_quantile(0.5 + 0.5 * confidence, self.n - 1) * self.standard_error()
        }
    }

    /// The bias that a two-sided test of the mean at `level` would find with 80 % power, in the values' unit.
    #[cfg(feature = "measure")]
    pub(crate) fn detectable(&self, level: f64) -> f64 {
        if self.n < 2 {
            return f64::INFINITY;
        }
        (student_quantile(1.0 - 0.5 * level, self.n - 1) + student_quantile(0.8, self.n - 1)) * self.standard_error()
    }
}

/// The skewness of a list of numbers; 0 of fewer than three or of equal ones.
pub(crate) fn skewness(values: impl IntoIterator<Item = f64> + Clone) -> f64 {
    let Moments { n, mean, variance } = Moments::of(values.clone());
    let cubes: f64 = values.into_iter().map(|v| (v - mean).powi(3)).sum();
    if n < 3 || variance <= 0.0 { 0.0 } else { cubes / n as f64 / variance.powf(1.5) }
}

/// A t statistic of `n` numbers freed of their skewness, to first order: increasing in t.
///
/// Source: Hall, J. R. Stat. Soc. B 54(1), 1992, for a mean divided by its measured error.
pub(crate) fn unskewed(t: f64, skewness: f64, n: usize) -> f64 {
    let a = skewness / (n.max(1) as f64).sqrt();
    t + a / 3.0 * t * t + a * a / 27.0 * t * t * t + a / 6.0
}

/// The t statistic that [`unskewed`] turns into `t`.
pub(crate) fn skewed(t: f64, skewness: f64, n: usize) -> f64 {
    let a = skewness / (n.max(1) as f64).sqrt();
    // Below that the cube root loses more digits than the correction has.
    if a.abs() < 1e-6 { t } else { ((1.0 + a * (t - a / 6.0)).cbrt() - 1.0) * 3.0 / a }
}

/// The value below which Student's t with `freedom` degrees of freedom lies with probability `p`.
#[cfg(feature = "measure")]
pub(crate) fn student_quantile(p: f64, freedom: usize) -> f64 {
    use statrs::distribution::{ContinuousCDF, StudentsT};
    // There the search below takes ever longer, in the end for ever; two terms about the normal law (Abramowitz and
    // Stegun, 26.7.5) are right to 1e-8.
    if freedom >= 1_000 {
        let (z, n) = (normal_quantile(p), freedom as f64);
        let (z3, z5) = (z.powi(3), z.powi(5));
        return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n);
    }
    StudentsT::new(0.0, 1.0, freedom.max(1) as f64).map_or(f64::INFINITY, |t| t.inverse_cdf(p))
}

/// The value below which a standard normal number lies with probability `p`.
#[cfg(feature = "measure")]
pub(crate) fn normal_quantile(p: f64) -> f64 {
    use statrs::distribution::{ContinuousCDF, Normal};
    Normal::standard().inverse_cdf(p)
}

/// The value below which a gamma law of this shape and scale 1 lies with probability `p`.
#[cfg(feature = "measure")]
pub(crate) fn gamma_quantile(p: f64, shape: f64) -> f64 {
    use statrs::distribution::{ContinuousCDF, Gamma};
    Gamma::new(shape, 1.0).map_or(f64::INFINITY, |g| g.inverse_cdf(p))
}

/// Two-sided probability of a t statistic at least this far from 0.
#[cfg(feature = "measure")]
pub(crate) fn student_p(t: f64, freedom: usize) -> f64 {
    use statrs::distribution::{ContinuousCDF, StudentsT};
    StudentsT::new(0.0, 1.0, freedom.max(1) as f64).map_or(1.0, |d| 2.0 * d.sf(t.abs()))
}

/// The level for each of `hypotheses` tests so that all together keep `level` (Sidak 1967).
pub(crate) fn sidak(level: f64, hypotheses: usize) -> f64 {
    1.0 - (1.0 - level).powf(1.0 / hypotheses.max(1) as f64)
}

/// The value under which the share `q` of the sorted `values` lies, by linear interpolation; NaN of none.
pub(crate) fn quantile(sorted: &[f64], q: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = q.clamp(0.0, 1.0) * last as f64;
    let low = at.floor() as usize;
    sorted[low] + (sorted[(low + 1).min(last)] - sorted[low]) * (at - low as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_a_known_list() {
        let m = Moments::of([1.0, 2.0, 3.0, 4.0]);
        assert!((m.mean - 2.5).abs() < 1e-15 && (m.variance - 5.0 / 3.0).abs() < 1e-15);
        assert!((quantile(&[1.0, 2.0, 3.0, 4.0], 0.5) - 2.5).abs() < 1e-15);
    }

    #[test]
    fn skewness_is_measured_and_taken_out_of_t() {
        // Exponential numbers have skewness 2; the t of 40 of them is below -2.02 oftener than 2.5 % of the time.
        let mut stream = crate::base::random::Stream::keyed(&[8]);
        let mut draw = |n: usize| (0..n).map(|_| -(1.0 - stream.uniform64()).ln()).collect::<Vec<f64>>();
        assert!((skewness(draw(200_000)) - 2.0).abs() < 0.15);
        let mut low = [0u32; 2];
        for _ in 0..20_000 {
            let values = draw(40);
            let m = Moments::of(values.iter().copied());
            let t = (m.mean - 1.0) / m.standard_error();
            low[0] += u32::from(t < -2.023);
            low[1] += u32::from(unskewed(t, skewness(values.iter().copied()), 40) < -2.023);
        }
        assert!(low[0] > 1_000 && low[1] < 900, "{low:?} of 20000 below the 2.5 % quantile, seed 8");
    }

    #[cfg(feature = "measure")]
    #[test]
    fn student_matches_the_printed_table() {
        assert!((student_quantile(0.975, 15) - 2.131_450).abs() < 1e-5);
        assert!((student_p(2.131_450, 15) - 0.05).abs() < 1e-6);
        assert!((normal_quantile(0.975) - 1.959_964).abs() < 1e-5);
        assert!((student_quantile(0.975, 1_000) - 1.962_339).abs() < 1e-6);
    }

    #[cfg(feature = "measure")]
    #[test]
    fn student_has_an_answer_for_any_number_of_runs() {
        for p in [0.9, 0.975, 0.999_9, 1e-6] {
            let two_sided = student_p(student_quantile(p, 1_000), 1_000);
            let expected = 2.0 * p.min(1.0 - p);
            assert!((two_sided / expected - 1.0).abs() < 1e-5, "{p}: {two_sided}");
            assert!((student_quantile(p, u32::MAX as usize) - normal_quantile(p)).abs() < 1e-6);
        }
    }
}
