//! What does a strategy's curve of error against time say: when does it reach an error, how far is it after a time?
//!
//! A point is a budget: means over runs of its CPU seconds, set-up included, and of its relMSE. Between points the curve is
//! a straight line in the log-log plot; beyond the last, noise is taken to fall as 1 / time, down to the squared bias.

use super::experiment::Runs;
use super::figure::{self, Figure};
use crate::base::interval::Tail;
use crate::record::{Read, Row};

/// The runs of each budget, smallest first: the same runs at each.
pub struct Curve<'a> {
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

/// How far an error is raised, as a share of it, to see what follows from it.
const STEP: f64 = 1e-4;

impl<'a> Curve<'a> {
    /// The curve of a strategy with these budgets.
    pub fn of(runs: &'a Runs, ladder: &[u32]) -> Self {
        Self { budgets: ladder.iter().map(|&passes| runs.at(passes)).filter(|rows| !rows.is_empty()).collect() }
    }

    /// How many runs each budget has.
    pub fn runs(&self) -> usize {
        self.budgets.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// CPU seconds, set-up included, to a relMSE of `error`. `bias2` gives the squared bias that counts, without a run.
    pub fn seconds_to(&self, error: f64, bias2: impl Fn(Option<usize>) -> f64) -> (Read, Figure) {
        self.read(bias2, |points, bias2| {
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

    /// relMSE after so many CPU seconds, set-up included. `bias2` is as above.
    pub fn error_at(&self, seconds: f64, bias2: impl Fn(Option<usize>) -> f64) -> (Read, Figure) {
        self.read(bias2, |points, bias2| {
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

    /// What `of` reads off the curve, with what each run says of it.
    fn read(&self, bias2: impl Fn(Option<usize>) -> f64, of: impl Fn(&[Point], f64) -> (Read, f64)) -> (Read, Figure) {
        let all = self.points(None);
        let (how, estimate) = of(&all, bias2(None));
        // The tail of each budget's error counts as far as the figure follows that error.
        let tail = self.budgets.iter().enumerate().fold(Tail::NONE, |tail, (i, rows)| {
            let mut raised = all.clone();
            let step = STEP * raised[i].error;
            raised[i].error += step;
            let slope = (of(&raised, bias2(None)).1 - estimate) / step;
            if slope.is_finite() && slope != 0.0 { tail.plus(figure::tail(rows).times(slope)) } else { tail }
        });
        let figure = Figure::jackknife(self.runs(), tail, |without| of(&self.points(without), bias2(without)).1);
        (how, figure)
    }

    fn points(&self, without: Option<usize>) -> Vec<Point> {
        let mean = |rows: &[&Row], value: fn(&Row) -> f64| {
            let kept = rows.iter().enumerate().filter(|(run, _)| Some(*run) != without);
            let (sum, n) = kept.fold((0.0, 0usize), |(sum, n), (_, row)| (sum + value(row), n + 1));
            sum / n as f64
        };
        let point = |rows: &Vec<&Row>| Point {
            setup_s: mean(rows, |row| row.setup_cpu_s),
            seconds: mean(rows, |row| row.setup_cpu_s + row.cpu_s),
            error: mean(rows, |row| row.rel_mse),
        };
        self.budgets.iter().map(point).collect()
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
