//! What do all runs of a strategy say together?

use super::errors::Truth;
use crate::base::statistics::Moments;
use crate::record::{Claim, Counts, Interval, Row, Summary};
use crate::render::counts as render;
use crate::strategy::registry::Configured;
use crate::strategy::{Claim as StrategyClaim, Role};
use glam::{DVec3, Vec3};

/// Confidence of every interval.
pub const CONFIDENCE: f64 = 0.95;

/// A summary without figures: of a strategy that was skipped or failed, or before its runs.
pub fn blank(strategy: &Configured) -> Summary {
    let info = strategy.info();
    let claim = match (info.role, info.claim) {
        (Role::Floor, _) => Claim::Floor,
        (Role::Ceiling, _) => Claim::Ceiling,
        (Role::Oracle, _) => Claim::Oracle,
        (Role::Choosing, StrategyClaim::Unbiased) => Claim::Unbiased,
        (Role::Choosing, StrategyClaim::Biased(why)) => Claim::Biased { why: why.to_owned() },
    };
    Summary::blank(strategy.name().to_owned(), claim, info.role == Role::Choosing)
}

/// A summary with the figures of the rows and images of its runs at the largest budget, in the same order.
pub fn summarise(mut summary: Summary, truth: &Truth, rows: &[&Row], images: &[&[Vec3]]) -> Summary {
    if rows.is_empty() {
        return summary;
    }
    let moments = |value: fn(&Row) -> f64| Moments::of(rows.iter().map(move |row| value(row)));
    let interval = |value: fn(&Row) -> f64| interval(moments(value));
    summary.runs = rows.len() as u32;
    summary.passes = rows[0].passes;
    summary.setup_cpu_s = moments(|r| r.setup_cpu_s).mean;
    summary.cpu_s = moments(|r| r.cpu_s).mean;
    summary.wall_s = moments(|r| r.wall_s).mean;
    summary.heap_bytes = rows.iter().map(|r| r.heap_bytes).max().unwrap_or(0);
    summary.rel_mse = interval(|r| r.rel_mse);
    summary.mse = interval(|r| r.mse);
    summary.rel_mse_trimmed = interval(|r| r.rel_mse_trimmed);
    let energy = moments(|r| r.energy_ratio);
    let own = truth.own_energy_error();
    // The reference's own error does not go away with more runs.
    summary.mean_bias =
        Interval { mean: energy.mean - 1.0, half_width: energy.half_width(CONFIDENCE).hypot(2.0 * own) };
    summary.detectable_bias = energy.detectable(1.0 - CONFIDENCE).hypot(2.8 * own);
    let spread = Spread::of(truth, images);
    summary.rel_bias2 = spread.rel_bias2();
    summary.variance_seconds = spread.rel_variance() * summary.cpu_s;
    summary.unstable = unstable(rows);
    summary
}

/// Counts as they are recorded.
pub(super) fn counts(found: render::Counts) -> Counts {
    Counts {
        samples: found.samples,
        picks: found.picks,
        shadow_rays: found.shadow_rays,
        blocked: found.blocked,
        zero_intensity: found.zero_intensity,
        behind_surface: found.behind_surface,
        behind_light: found.behind_light,
        nodes: found.work.nodes,
        weighed: found.work.weighed,
        candidates: found.work.candidates,
        choosing_rays: found.work.shadow_rays,
    }
}

pub(super) fn interval(moments: Moments) -> Interval {
    Interval { mean: moments.mean, half_width: moments.half_width(CONFIDENCE) }
}

/// Whether the two halves of the runs differ by more than their intervals.
fn unstable(rows: &[&Row]) -> bool {
    let (first, second) = rows.split_at(rows.len() / 2);
    let [a, b] = [first, second].map(|half| interval(Moments::of(half.iter().map(|row| row.rel_mse))));
    first.len() > 1 && (a.mean - b.mean).abs() > a.half_width + b.half_width
}

/// Runs taken apart into what they share (bias) and in what they differ (variance).
struct Spread<'a> {
    truth: &'a Truth,
    images: &'a [&'a [Vec3]],
    sums: Vec<DVec3>,
    squares: Vec<DVec3>,
}

impl<'a> Spread<'a> {
    fn of(truth: &'a Truth, images: &'a [&'a [Vec3]]) -> Self {
        let n = truth.mean().len();
        let add = |value: fn(DVec3) -> DVec3| {
            (0..n).map(|i| images.iter().fold(DVec3::ZERO, |sum, image| sum + value(image[i].as_dvec3()))).collect()
        };
        Self { truth, images, sums: add(|x| x), squares: add(|x| x * x) }
    }

    /// Variance of a pixel over `k` runs with these sums.
    fn variance(sum: DVec3, square: DVec3, k: f64) -> DVec3 {
        ((square - sum * sum / k) / (k - 1.0)).max(DVec3::ZERO)
    }

    /// Mean variance of one run, in units of relMSE; NaN of one run.
    fn rel_variance(&self) -> f64 {
        let k = self.images.len() as f64;
        if k < 2.0 {
            return f64::NAN;
        }
        self.truth.mean_over(|i| Self::variance(self.sums[i], self.squares[i], k) * self.truth.weight(i))
    }

    /// Squared bias in units of relMSE: mean over pixels of (mean of runs - truth)^2 less the variance of that mean,
    /// with a jackknife interval over runs.
    fn rel_bias2(&self) -> Interval {
        let k = self.images.len();
        if k < 3 {
            return Interval { mean: f64::NAN, half_width: f64::INFINITY };
        }
        let bias2 = |left_out: Option<&&[Vec3]>| {
            let k = if left_out.is_some() { k - 1 } else { k } as f64;
            self.truth.mean_over(|i| {
                let out = left_out.map_or(DVec3::ZERO, |image| image[i].as_dvec3());
                let (sum, square) = (self.sums[i] - out, self.squares[i] - out * out);
                (self.truth.product(i, sum / k) - Self::variance(sum, square, k) / k) * self.truth.weight(i)
            })
        };
        let all = bias2(None);
        let pseudo: Vec<f64> =
            self.images.iter().map(|image| k as f64 * all - (k - 1) as f64 * bias2(Some(image))).collect();
        Interval { mean: all, half_width: Moments::of(pseudo.iter().copied()).half_width(CONFIDENCE) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

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
        let images: Vec<&[Vec3]> = images.iter().map(Vec::as_slice).collect();
        let spread = Spread::of(&truth, &images);
        let bias2 = spread.rel_bias2();
        assert!((bias2.mean * 1.01 - 0.04).abs() < bias2.half_width * 1.5, "{bias2:?}");
        assert!(bias2.half_width < 0.004, "{bias2:?}");
        assert!((spread.rel_variance() * 1.01 * 12.0 - 1.0).abs() < 0.02, "{}", spread.rel_variance());
        assert!(Spread::of(&truth, &images[..1]).rel_variance().is_nan(), "one run knows nothing of variance");
    }
}
