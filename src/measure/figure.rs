//! A figure of several runs, and how far off it may be.
//!
//! Whatever is read off several means over the same runs (a variance, a time on a curve) is made again without each run
//! in turn: the jackknife says what each run adds to it, and the figure is a mean of that.

use crate::base::interval::{self, Bounds, Tail};
use crate::base::statistics::Moments;
use crate::record::{Interval, Row};

/// Confidence of every printed interval.
pub const CONFIDENCE: f64 = 0.95;

/// An estimate, and what each run says of it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The estimate.
    pub estimate: f64,
    /// A value for each run, whose mean is the estimate.
    values: Vec<f64>,
    law: Law,
}

/// What is known of a figure beforehand.
#[derive(Clone, Copy, Debug)]
enum Law {
    /// Positive, with what pixels may add that no run has shown.
    Positive(Tail),
    /// Of either sign.
    Signed,
}

impl Figure {
    /// The mean of one positive value a run, such as seconds.
    pub fn mean(values: Vec<f64>) -> Self {
        Self::of(values, Law::Positive(Tail::NONE))
    }

    /// The mean of one value of either sign a run.
    pub fn signed_mean(values: Vec<f64>) -> Self {
        Self::of(values, Law::Signed)
    }

    /// The mean relMSE of runs at one budget, or at some receivers of it where `values` are not those of the rows.
    pub fn error(values: Vec<f64>, tail: Tail) -> Self {
        Self::of(values, Law::Positive(tail))
    }

    fn of(values: Vec<f64>, law: Law) -> Self {
        Self { estimate: Moments::of(values.iter().copied()).mean, values, law }
    }

    /// A positive figure of `runs` runs: `of(None)` from all of them, `of(Some(run))` without one. `tail` is that of the
    /// errors that it follows, in its own unit.
    pub fn jackknife(runs: usize, tail: Tail, of: impl Fn(Option<usize>) -> f64) -> Self {
        Self::without_each(runs, Law::Positive(tail), of)
    }

    /// The same for a figure of either sign.
    pub fn signed_jackknife(runs: usize, of: impl Fn(Option<usize>) -> f64) -> Self {
        Self::without_each(runs, Law::Signed, of)
    }

    fn without_each(runs: usize, law: Law, of: impl Fn(Option<usize>) -> f64) -> Self {
        let estimate = of(None);
        let left: Vec<f64> = (0..runs).map(|run| of(Some(run))).collect();
        let centre = left.iter().sum::<f64>() / runs as f64;
        let values = left.iter().map(|value| estimate + (runs as f64 - 1.0) * (centre - value)).collect();
        Self { estimate, values, law }
    }

    /// The figure in another unit, `factor` of which, above 0, make one of this.
    pub fn times(self, factor: f64) -> Self {
        let law = match self.law {
            Law::Positive(tail) => Law::Positive(tail.times(factor)),
            Law::Signed => Law::Signed,
        };
        let values = self.values.into_iter().map(|value| value * factor).collect();
        Self { estimate: self.estimate * factor, values, law }
    }

    /// Where it lies at a confidence within (0, 1).
    pub fn bounds(&self, confidence: f64) -> Bounds {
        match &self.law {
            Law::Positive(tail) => interval::mean(&self.values, tail, confidence),
            Law::Signed => interval::signed_mean(&self.values, confidence),
        }
    }

    /// With its interval.
    pub fn interval(&self) -> Interval {
        let Bounds { low, high } = self.bounds(CONFIDENCE);
        Interval { mean: self.estimate, low, high }
    }

    /// This figure over another of independent runs, both positive; none where that has no meaning.
    ///
    /// The interval of the ratio follows from both intervals, on the logarithmic scale (MOVER: Zou and Donner, Stat. Med.
    /// 27, 2008, eq. 4).
    pub fn over(&self, other: &Self) -> Option<Interval> {
        let mean = self.estimate / other.estimate;
        let [own, its] = [self, other].map(|figure| {
            let Bounds { low, high } = figure.bounds(CONFIDENCE);
            [figure.estimate / low.max(0.0), high / figure.estimate].map(f64::ln)
        });
        (mean.is_finite() && mean > 0.0).then(|| {
            let (below, above) = (own[0].hypot(its[1]), own[1].hypot(its[0]));
            Interval { mean, low: mean * (-below).exp(), high: mean * above.exp() }
        })
    }
}

/// The mean relMSE of these runs.
pub fn error(rows: &[&Row]) -> Figure {
    Figure::error(rows.iter().map(|row| row.rel_mse).collect(), tail(rows))
}

/// The tail of the mean relMSE of these runs.
pub fn tail(rows: &[&Row]) -> Tail {
    let values: Vec<f64> = rows.iter().map(|row| row.rel_mse).collect();
    let largest: Vec<_> = rows.iter().map(|row| row.largest).collect();
    Tail::of(&values, &largest)
}
