//! How does something grow? The power law that fits best on logarithmic axes.

use crate::base::statistics::student_quantile;
use crate::measure::figure::CONFIDENCE;
use crate::record::Interval;

/// `y = factor * x^exponent`, fitted to points by least squares of the logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PowerLaw {
    /// The slope on logarithmic axes, with Student's interval from how the points scatter.
    pub exponent: Interval,
    /// What stands before the power.
    pub factor: f64,
    /// Root mean square, over the points' degrees of freedom, of ln(y / fit): 0.1 means that points lie about 10 % off.
    pub residual: f64,
    /// How many points.
    pub points: usize,
}

impl PowerLaw {
    /// The law of some points; those that are not finite and above 0 are left out. `None` for fewer than three or for
    /// one x alone: two points lie on a line whatever they are.
    pub(crate) fn fit(points: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let positive = |v: f64| v.is_finite() && v > 0.0;
        let logs: Vec<(f64, f64)> =
            points.into_iter().filter(|&(x, y)| positive(x) && positive(y)).map(|(x, y)| (x.ln(), y.ln())).collect();
        let n = logs.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let spread: f64 = logs.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
        if logs.len() < 3 || spread <= 0.0 {
            return None;
        }
        let exponent = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
        let squares: f64 = logs.iter().map(|p| (p.1 - y - exponent * (p.0 - x)).powi(2)).sum();
        let residual = (squares / (n - 2.0)).sqrt();
        let half_width = student_quantile(0.5 + 0.5 * CONFIDENCE, logs.len() - 2) * residual / spread.sqrt();
        let factor = (y - exponent * x).exp();
        Some(Self { exponent: Interval::symmetric(exponent, half_width), factor, residual, points: logs.len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    #[test]
    fn a_known_law_is_recovered() {
        let law = PowerLaw::fit([10.0, 100.0, 1e3, 1e5].map(|x: f64| (x, 3.0 * x.powf(0.75)))).expect("four points");
        assert!((law.exponent.mean - 0.75).abs() < 1e-12 && (law.factor - 3.0).abs() < 1e-10, "{law:?}");
        assert!(law.residual < 1e-12 && law.points == 4, "{law:?}");
    }

    #[test]
    fn noise_shows_as_the_residual() {
        let mut stream = Stream::keyed(&[5]);
        let mut noise = || 0.2 * (stream.uniform64() - 0.5);
        let points: Vec<(f64, f64)> =
            (0..2_000).map(|i| 1.01f64.powi(i)).map(|x| (x, x.powf(-1.5) * noise().exp())).collect();
        let law = PowerLaw::fit(points).expect("many points");
        assert!((law.exponent.mean + 1.5).abs() < 1e-3 && law.exponent.holds(-1.5), "{law:?}");
        // Uniform noise of width 0.2 has a standard deviation of 0.2 / sqrt(12).
        assert!((law.residual * 12f64.sqrt() / 0.2 - 1.0).abs() < 0.05, "{law:?}");
    }

    #[test]
    fn too_few_points_have_no_law() {
        assert_eq!(PowerLaw::fit([(1.0, 1.0), (2.0, 2.0), (3.0, 0.0), (4.0, f64::NAN)]), None);
        assert_eq!(PowerLaw::fit([(2.0, 1.0), (2.0, 2.0), (2.0, 3.0)]), None);
    }
}
