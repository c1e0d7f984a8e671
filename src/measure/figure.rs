//! A figure, and how far off it may be, at any confidence.
//!
//! A mean over runs has the interval of its [`Tail`]. Whatever is made of several independent figures (a time on a curve,
//! a variance times seconds, a ratio) is moved to either end of each in turn; the distances on the logarithmic scale add
//! as squares. That needs no slope, so that a figure next to a kink, or one whose part has no upper end, is as sure as it
//! should be.
//!
//! Source: MOVER, the method of variance estimates recovery; Zou and Donner, Stat. Med. 27(10), 2008.

use crate::base::interval::{self, Bounds, Tail};
use crate::base::statistics::Moments;
use crate::record::{Interval, Row};

/// Confidence of every printed interval.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// An estimate, and where it lies at any confidence.
pub(crate) struct Figure {
    /// The estimate.
    pub estimate: f64,
    bounds: Box<dyn Fn(f64) -> Bounds + Send + Sync>,
}

impl Figure {
    /// Known without doubt.
    pub(crate) fn certain(value: f64) -> Self {
        Self { estimate: value, bounds: Box::new(move |_| Bounds { low: value, high: value }) }
    }

    /// The mean of one positive value a run, such as seconds.
    pub(crate) fn mean(values: Vec<f64>) -> Self {
        Self::error(values, Tail::NONE)
    }

    /// The mean of one positive value a run, with what pixels may add to it that no run has shown.
    pub(crate) fn error(values: Vec<f64>, tail: Tail) -> Self {
        let estimate = Moments::of(values.iter().copied()).mean;
        Self { estimate, bounds: Box::new(move |confidence| interval::mean(&values, &tail, confidence)) }
    }

    /// The mean of one value of either sign a run.
    pub(crate) fn signed_mean(values: Vec<f64>) -> Self {
        let estimate = Moments::of(values.iter().copied()).mean;
        Self { estimate, bounds: Box::new(move |confidence| interval::signed_mean(&values, confidence)) }
    }

    /// A positive figure of `runs` runs that is no mean: `of(None)` from all of them, `of(Some(run))` without one.
    /// `tail` is that of the errors that it follows, in its own unit.
    pub(crate) fn jackknife(runs: usize, tail: Tail, of: impl Fn(Option<usize>) -> f64) -> Self {
        Self { estimate: of(None), ..Self::error(pseudo_values(runs, of), tail) }
    }

    /// The same for a figure of either sign.
    pub(crate) fn signed_jackknife(runs: usize, of: impl Fn(Option<usize>) -> f64) -> Self {
        Self { estimate: of(None), ..Self::signed_mean(pseudo_values(runs, of)) }
    }

    /// A positive figure made of independent ones; it rises or falls with each of them.
    pub(crate) fn of(parts: Vec<Self>, function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Self {
        let centre: Vec<f64> = parts.iter().map(|part| part.estimate).collect();
        let estimate = function(&centre);
        let bounds = move |confidence: f64| {
            let (mut below, mut above) = (0.0f64, 0.0f64);
            for (i, part) in parts.iter().enumerate() {
                let Bounds { low, high } = part.bounds(confidence);
                let moved = [low, high].map(|end| {
                    let mut at = centre.clone();
                    // Far enough to be without end, and near enough to reckon with.
                    at[i] = end.clamp(-FAR, FAR);
                    (function(&at) / estimate).ln()
                });
                // A figure that is no number there is not known to that side.
                let [down, up] = [-moved[0].min(moved[1]), moved[0].max(moved[1])].map(|by| by.max(0.0));
                let unknown = moved.iter().any(|by| by.is_nan());
                below = below.hypot(if unknown { f64::INFINITY } else { down });
                above = above.hypot(if unknown { f64::INFINITY } else { up });
            }
            let end = |by: f64| if by > UNKNOWN.ln() { f64::INFINITY } else { by };
            Bounds { low: estimate * (-end(below)).exp(), high: estimate * end(above).exp() }
        };
        Self { estimate, bounds: Box::new(bounds) }
    }

    /// The same figure where it cannot be below 0.
    pub(crate) fn above_zero(self) -> Self {
        let bounds = move |confidence: f64| {
            let Bounds { low, high } = (self.bounds)(confidence);
            Bounds { low: low.max(0.0), high: high.max(0.0) }
        };
        Self { estimate: self.estimate.max(0.0), bounds: Box::new(bounds) }
    }

    /// This figure over another, both positive; none where that has no meaning.
    pub(crate) fn over(self, other: Self) -> Option<Self> {
        let ratio = Self::of(vec![self, other], |parts| parts[0] / parts[1]);
        (ratio.estimate.is_finite() && ratio.estimate > 0.0).then_some(ratio)
    }

    /// Where it lies at a confidence within (0, 1).
    pub(crate) fn bounds(&self, confidence: f64) -> Bounds {
        (self.bounds)(confidence)
    }

    /// With its interval.
    pub(crate) fn interval(&self) -> Interval {
        let Bounds { low, high } = self.bounds(CONFIDENCE);
        Interval { mean: self.estimate, low, high }
    }
}

/// What stands for a part without end.
const FAR: f64 = 1e200;

/// An end more than so many times from the estimate stands for none: only a part without end takes a figure so far.
const UNKNOWN: f64 = 1e6;

/// What each run adds to a figure, about the figure: their mean is the figure (Quenouille 1956, without its correction).
fn pseudo_values(runs: usize, of: impl Fn(Option<usize>) -> f64) -> Vec<f64> {
    let estimate = of(None);
    let left: Vec<f64> = (0..runs).map(|run| of(Some(run))).collect();
    let centre = left.iter().sum::<f64>() / runs as f64;
    left.iter().map(|value| estimate + (runs as f64 - 1.0) * (centre - value)).collect()
}

/// The mean relMSE of these runs.
pub(crate) fn error(rows: &[&Row]) -> Figure {
    Figure::error(rows.iter().map(|row| row.rel_mse).collect(), tail(rows))
}

/// The mean of a positive value of these runs.
pub(crate) fn mean(rows: &[&Row], value: fn(&Row) -> f64) -> Figure {
    Figure::mean(rows.iter().map(|row| value(row)).collect())
}

/// The tail of the mean relMSE of these runs.
pub(crate) fn tail(rows: &[&Row]) -> Tail {
    let values: Vec<f64> = rows.iter().map(|row| row.rel_mse).collect();
    let largest: Vec<_> = rows.iter().map(|row| row.largest).collect();
    Tail::of(&values, &largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(low: f64, estimate: f64, high: f64) -> Figure {
        Figure { estimate, bounds: Box::new(move |_| Bounds { low, high }) }
    }

    #[test]
    fn distances_of_independent_parts_add_as_squares() {
        let product = Figure::of(vec![of(0.5, 1.0, 2.0), of(2.0, 4.0, 8.0)], |p| p[0] * p[1]).interval();
        let far = (2f64.ln() * 2f64.sqrt()).exp();
        assert!((product.low - 4.0 / far).abs() < 1e-12 && (product.high - 4.0 * far).abs() < 1e-12, "{product:?}");
        // What the divisor may be less is what the ratio may be more.
        let ratio = of(1.0, 1.0, 1.0).over(of(2.0, 4.0, 5.0)).expect("a ratio").interval();
        assert!((ratio.low - 0.2).abs() < 1e-12 && (ratio.high - 0.5).abs() < 1e-12, "{ratio:?}");
    }

    #[test]
    fn a_part_without_an_end_leaves_the_figure_without_one_only_where_it_follows() {
        let open = || of(0.9, 1.0, f64::INFINITY);
        assert_eq!(Figure::of(vec![open()], |p| 3.0 * p[0]).interval().high, f64::INFINITY);
        assert_eq!(Figure::of(vec![open()], |p| p[0].powf(0.1)).interval().high, f64::INFINITY);
        let capped = Figure::of(vec![open()], |p| p[0].min(1.5)).interval();
        assert!((capped.high - 1.5).abs() < 1e-12 && capped.low == 0.9, "{capped:?}");
    }

    #[test]
    fn a_jackknifed_mean_is_the_mean() {
        let values = [1.0, 2.0, 4.0, 9.0];
        let mean = |without: Option<usize>| {
            let kept: Vec<f64> =
                values.iter().enumerate().filter(|(i, _)| Some(*i) != without).map(|(_, v)| *v).collect();
            kept.iter().sum::<f64>() / kept.len() as f64
        };
        let (plain, jackknifed) = (Figure::mean(values.to_vec()), Figure::jackknife(4, Tail::NONE, mean));
        let (a, b) = (plain.interval(), jackknifed.interval());
        assert!((a.low - b.low).abs() < 1e-12 && (a.high - b.high).abs() < 1e-12, "{a:?} {b:?}");
    }
}
