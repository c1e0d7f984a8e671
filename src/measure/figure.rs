//! A figure of several runs, and how far off it may be.
//!
//! Whatever is read off several means over the same runs (a variance, a time on a curve) is made again without each run
//! in turn: the jackknife's pseudo-values stand for the runs, and the figure is a mean of them.

use crate::base::statistics::Moments;
use crate::record::Interval;

/// Confidence of every printed interval.
pub const CONFIDENCE: f64 = 0.95;

/// An estimate, and what each run says of it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The estimate.
    pub estimate: f64,
    /// A value for each run, whose mean is the estimate or its logarithm.
    values: Vec<f64>,
    logarithmic: bool,
}

impl Figure {
    /// The mean of one value a run.
    pub fn mean(values: Vec<f64>) -> Self {
        Self { estimate: Moments::of(values.iter().copied()).mean, values, logarithmic: false }
    }

    /// A figure of `runs` runs: `of(None)` from all of them, `of(Some(run))` without one.
    ///
    /// A `positive` one is taken by its logarithm, in which ratios are as far to either side.
    pub fn jackknife(runs: usize, positive: bool, of: impl Fn(Option<usize>) -> f64) -> Self {
        let estimate = of(None);
        let scaled = |value: f64| if positive { value.ln() } else { value };
        let k = runs as f64;
        let values = (0..runs).map(|run| k * scaled(estimate) - (k - 1.0) * scaled(of(Some(run)))).collect();
        Self { estimate, values, logarithmic: positive }
    }

    /// The ends of its interval at a confidence within (0, 1).
    pub fn bounds(&self, confidence: f64) -> (f64, f64) {
        let half = Moments::of(self.values.iter().copied()).half_width(confidence);
        if self.logarithmic {
            (self.estimate * (-half).exp(), self.estimate * half.exp())
        } else {
            (self.estimate - half, self.estimate + half)
        }
    }

    /// With its interval.
    pub fn interval(&self) -> Interval {
        Interval::of(self.estimate, self.bounds(CONFIDENCE))
    }

    /// This figure over another of independent runs, both positive; none where that has no meaning.
    ///
    /// The interval of the ratio follows from both intervals, on the logarithmic scale (MOVER: Zou and Donner, Stat. Med.
    /// 27, 2008, eq. 4).
    pub fn over(&self, other: &Self, confidence: f64) -> Option<Interval> {
        let mean = self.estimate / other.estimate;
        let [own, its] = [self, other].map(|figure| {
            let (low, high) = figure.bounds(confidence);
            [figure.estimate / low.max(0.0), high / figure.estimate].map(f64::ln)
        });
        (mean.is_finite() && mean > 0.0).then(|| {
            let (below, above) = (own[0].hypot(its[1]), own[1].hypot(its[0]));
            Interval { mean, low: mean * (-below).exp(), high: mean * above.exp() }
        })
    }
}
