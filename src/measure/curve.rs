//! What does a strategy's curve of error against time say: when does it reach an error, how far is it after a time?
//!
//! A point is a budget: means over runs of its CPU seconds, set-up included, and of its relMSE. Between points the curve is
//! a straight line in the log-log plot; beyond the last, noise is taken to fall as 1 / time, down to the squared bias.

use super::experiment::Runs;
use super::figure::{self, Figure};
use crate::record::{Read, Row};

/// The runs of each budget, smallest first: the same runs at each.
pub(crate) struct Curve<'a> {
    budgets: Vec<Vec<&'a Row>>,
}

/// Means over runs.
#[derive(Clone, Copy)]
struct Point {
    setup_s: f64,
    /// Set-up included.
    seconds: f64,
    error: f64,
}

impl<'a> Curve<'a> {
    /// The curve of a strategy with these budgets.
    pub(crate) fn of(runs: &'a Runs, ladder: &[u32]) -> Self {
        Self { budgets: ladder.iter().map(|&passes| runs.at(passes)).filter(|rows| !rows.is_empty()).collect() }
    }

    /// Whether anything was measured.
    pub(crate) fn is_empty(&self) -> bool {
        self.budgets.is_empty()
    }

    /// CPU seconds, set-up included, to a relMSE of `error`, down to the squared bias that counts.
    pub(crate) fn seconds_to(&self, error: f64, bias2: Figure) -> (Read, Figure) {
        self.read(bias2, move |points, bias2| {
            let Some(last) = points.last() else { return (Read::Unknown, f64::NAN) };
            match points.iter().position(|point| point.error <= error) {
                Some(0) => (Read::Measured, points[0].seconds),
                Some(at) => (Read::Measured, seconds_between(points[at - 1], points[at], error)),
                None if bias2.is_nan() => (Read::Unknown, f64::NAN),
                None if error <= bias2 => (Read::Never, f64::INFINITY),
                None => {
                    let sampling = last.seconds - last.setup_s;
                    (Read::Extrapolated, last.setup_s + sampling * (last.error - bias2) / (error - bias2))
                }
            }
        })
    }

    /// relMSE after so many CPU seconds, set-up included, down to the squared bias that counts.
    pub(crate) fn error_at(&self, seconds: f64, bias2: Figure) -> (Read, Figure) {
        self.read(bias2, move |points, bias2| {
            let Some(last) = points.last() else { return (Read::Unknown, f64::NAN) };
            match points.iter().position(|point| point.seconds >= seconds) {
                Some(0) => (if points[0].seconds > seconds { Read::TooSoon } else { Read::Measured }, points[0].error),
                Some(at) => (Read::Measured, error_between(points[at - 1], points[at], seconds)),
                None if bias2.is_nan() => (Read::Unknown, f64::NAN),
                None => {
                    let share = (last.seconds - last.setup_s) / (seconds - last.setup_s);
                    (Read::Extrapolated, bias2 + (last.error - bias2) * share)
                }
            }
        })
    }

    /// What `of` reads off the curve. Budgets are independent of one another, and times of errors.
    fn read(&self, bias2: Figure, of: impl Fn(&[Point], f64) -> (Read, f64) + Send + Sync + 'static) -> (Read, Figure) {
        let n = self.budgets.len();
        let setups: Vec<f64> = self.budgets.iter().map(|rows| figure::mean(rows, |r| r.setup_cpu_s).estimate).collect();
        let mut parts: Vec<Figure> = self.budgets.iter().map(|rows| figure::mean(rows, Row::total_cpu_s)).collect();
        parts.extend(self.budgets.iter().map(|rows| figure::error(rows)));
        parts.push(bias2);
        let read = move |parts: &[f64]| {
            let point = |i: usize| Point { setup_s: setups[i], seconds: parts[i], error: parts[n + i] };
            of(&(0..n).map(point).collect::<Vec<Point>>(), parts[2 * n])
        };
        let estimates: Vec<f64> = parts.iter().map(|part| part.estimate).collect();
        let how = read(&estimates).0;
        (how, Figure::of(parts, move |parts| read(parts).1))
    }
}

/// Whether a line between two points of the log-log plot falls.
fn is_line(above: Point, below: Point) -> bool {
    [above, below].iter().all(|point| point.seconds > 0.0 && point.error > 0.0)
        && above.error > below.error
        && below.seconds > above.seconds
}

/// The time of `error` on the straight line; that of `below` where there is none.
fn seconds_between(above: Point, below: Point, error: f64) -> f64 {
    if !is_line(above, below) {
        return below.seconds;
    }
    let share = (above.error / error).ln() / (above.error / below.error).ln();
    above.seconds * (below.seconds / above.seconds).powf(share)
}

/// The error at `seconds` on the straight line; that of `above`, which was there before, where there is none.
fn error_between(above: Point, below: Point, seconds: f64) -> f64 {
    if !is_line(above, below) {
        return above.error;
    }
    let share = (seconds / above.seconds).ln() / (below.seconds / above.seconds).ln();
    above.error * (below.error / above.error).powf(share)
}
