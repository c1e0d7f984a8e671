//! Relative mean squared error: the one definition that every figure of this project uses.
//!
//! relMSE = mean over pixels and channels of `(x - r)^2 / (r^2 + epsilon)`, with epsilon = 0.01 times the square of the
//! truth's mean, per channel, over the same pixels.

use glam::{DVec3, Vec3};

/// What squared errors are divided by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RelMse {
    epsilon: Vec3,
}

impl RelMse {
    /// For this truth; its values are those that the error is taken over.
    pub(crate) fn about(truth: &[Vec3]) -> Self {
        let average = truth.iter().fold(DVec3::ZERO, |sum, x| sum + x.as_dvec3()) / truth.len().max(1) as f64;
        Self { epsilon: (average * average * 0.01).as_vec3() }
    }

    /// Epsilon per channel, in the square of the truth's unit.
    pub(crate) fn epsilon(&self) -> Vec3 {
        self.epsilon
    }

    /// `1 / (r^2 + epsilon)` per channel; 0 where that would be a division of nothing by nothing.
    pub(crate) fn weight(&self, r: Vec3) -> DVec3 {
        let r = r.as_dvec3();
        let denominator = r * r + self.epsilon.as_dvec3();
        DVec3::select(denominator.cmpgt(DVec3::ZERO), denominator.recip(), DVec3::ZERO)
    }
}

/// Means of the errors of single pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Means {
    /// Over all pixels.
    pub all: f64,
    /// Without the worst 0.1 % of them, one at least.
    pub trimmed: f64,
    /// Share of the sum that those hold, 0 to 1.
    pub trimmed_share: f64,
}

impl Means {
    /// Of these errors; of none, all are 0.
    pub(crate) fn of(errors: &[f64]) -> Self {
        let n = errors.len();
        if n == 0 {
            return Self::default();
        }
        let total: f64 = errors.iter().sum();
        let mut sorted = errors.to_vec();
        sorted.sort_by(f64::total_cmp);
        let worst = n.div_ceil(1000);
        let kept: f64 = sorted[..n - worst].iter().sum();
        Self {
            all: total / n as f64,
            trimmed: if n > worst { kept / (n - worst) as f64 } else { 0.0 },
            trimmed_share: if total > 0.0 { ((total - kept) / total).clamp(0.0, 1.0) } else { 0.0 },
        }
    }
}
