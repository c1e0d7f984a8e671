//! An estimate and how far off it may be.

use super::number;
use serde::{Deserialize, Serialize};

/// An estimate over runs and its 95 % interval, all in one unit.
///
/// An end that is infinite is one that the runs cannot tell: there are too few of them, or the tail is too heavy. All
/// three are NaN where nothing is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// The estimate.
    #[serde(with = "number")]
    pub mean: f64,
    /// The lower end.
    #[serde(with = "number")]
    pub low: f64,
    /// The upper end.
    #[serde(with = "number")]
    pub high: f64,
}

impl Interval {
    /// Nothing is known.
    pub const NONE: Self = Self { mean: f64::NAN, low: f64::NAN, high: f64::NAN };

    /// As far to either side.
    pub(crate) fn symmetric(mean: f64, half_width: f64) -> Self {
        Self { mean, low: mean - half_width, high: mean + half_width }
    }

    /// Known without doubt.
    pub fn certain(value: f64) -> Self {
        Self::symmetric(value, 0.0)
    }

    /// With its ends from elsewhere.
    pub(crate) fn of(mean: f64, (low, high): (f64, f64)) -> Self {
        Self { mean, low, high }
    }

    /// From the estimate to the farther end; NaN where nothing is known.
    pub fn half_width(&self) -> f64 {
        let (below, above) = (self.mean - self.low, self.high - self.mean);
        // `max` would hide a NaN.
        if below >= above { below } else { above }
    }

    /// Whether the value may be the right one; an interval that is not known holds nothing.
    pub(crate) fn holds(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Whether both ends are known.
    pub fn is_bounded(&self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// The interval in another unit, `factor` of which make one of this; a factor below 0 turns it round.
    pub(crate) fn times(&self, factor: f64) -> Self {
        let (a, b) = (self.low * factor, self.high * factor);
        Self { mean: self.mean * factor, low: a.min(b), high: a.max(b) }
    }
}
