//! What do runs share, and in what do they differ? Bias and variance of images.

use super::errors::Truth;
use glam::{DVec3, Vec3};

/// Squared bias and variance of one run, in units of relMSE.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parts {
    /// Mean over pixels of (mean of runs - truth)^2 less the variance of that mean: freed of noise, it may be negative.
    pub bias2: f64,
    /// Mean variance of one run.
    pub variance: f64,
}

/// Images of independent runs.
pub(super) struct Spread<'a> {
    truth: &'a Truth,
    images: &'a [Vec<Vec3>],
    sums: Vec<DVec3>,
    squares: Vec<DVec3>,
}

impl<'a> Spread<'a> {
    /// Of images at the truth's receivers.
    pub(super) fn of(truth: &'a Truth, images: &'a [Vec<Vec3>]) -> Self {
        let n = truth.mean().len();
        let add = |value: fn(DVec3) -> DVec3| {
            (0..n).map(|i| images.iter().fold(DVec3::ZERO, |sum, image| sum + value(image[i].as_dvec3()))).collect()
        };
        Self { truth, images, sums: add(|x| x), squares: add(|x| x * x) }
    }

    /// Bias and variance of all runs, or `without` one; NaN of fewer than two.
    pub(super) fn parts(&self, without: Option<usize>) -> Parts {
        let left_out = without.map(|run| &self.images[run]);
        let k = (self.images.len() - usize::from(left_out.is_some())) as f64;
        if k < 2.0 {
            return Parts { bias2: f64::NAN, variance: f64::NAN };
        }
        let n = self.truth.mean().len();
        let (mut bias2, mut variance) = (0.0, 0.0);
        for i in 0..n {
            let out = left_out.map_or(DVec3::ZERO, |image| image[i].as_dvec3());
            let (sum, square) = (self.sums[i] - out, self.squares[i] - out * out);
            let of_pixel = ((square - sum * sum / k) / (k - 1.0)).max(DVec3::ZERO);
            let weight = self.truth.weight(i);
            variance += (of_pixel * weight).element_sum();
            bias2 += ((self.truth.product(i, sum / k) - of_pixel / k) * weight).element_sum();
        }
        let scale = 1.0 / (3 * n.max(1)) as f64;
        Parts { bias2: bias2 * scale, variance: variance * scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::interval::Tail;
    use crate::base::random::Stream;
    use crate::measure::figure::Figure;

    #[test]
    fn bias_and_variance_of_known_runs_are_told_apart() {
        let (n, k) = (4_000, 16);
        let truth = Truth::new([vec![Vec3::ONE; n], vec![Vec3::ONE; n]]);
        let images: Vec<Vec<Vec3>> = (0..k)
            .map(|run| {
                let mut rng = Stream::keyed(&[run]);
                // Bias -0.2, uniform noise of width 1: variance 1/12.
                (0..n).map(|_| Vec3::splat(0.8 + rng.uniform() - 0.5)).collect()
            })
            .collect();
        let spread = Spread::of(&truth, &images);
        let bias2 = Figure::signed_jackknife(16, |run| spread.parts(run).bias2).interval();
        assert!((bias2.mean * 1.01 - 0.04).abs() < bias2.half_width() * 1.5, "{bias2:?}");
        assert!(bias2.half_width() < 0.004, "{bias2:?}");
        let variance = Figure::jackknife(16, Tail::NONE, |run| spread.parts(run).variance).interval();
        assert!((variance.mean * 1.01 * 12.0 - 1.0).abs() < 0.02, "{variance:?}");
        assert!(Spread::of(&truth, &images[..1]).parts(None).variance.is_nan(), "one run knows nothing of variance");
    }
}
