//! What do all runs of a strategy say together?

use super::errors::Truth;
use super::experiment::Runs;
use super::figure::{self, CONFIDENCE, Figure, error, tail};
use super::plan::Pilot;
use super::spread::{Parts, Spread};
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::base::interval::{Bounds, Tail};
use crate::base::statistics::{Moments, normal_quantile};
use crate::record::{Interval, Point, Row, Summary};
use crate::strategy::Configured;

/// A summary without figures: of a strategy that was skipped or failed, or before its runs.
pub(crate) fn blank(strategy: &Configured) -> Summary {
    Summary::blank(strategy.name().to_owned(), strategy.info().claim)
}

/// The summary of a strategy from its pilot, or why there is none, and its runs; without a pilot, of one that is not run
/// against the clock.
pub(crate) fn of(
    strategy: &Configured,
    pilot: Option<&Result<Pilot>>,
    ladder: &[u32],
    runs: &Runs,
    truth: &Truth,
) -> (Summary, Jackknife) {
    let mut begun = blank(strategy);
    match pilot {
        Some(Err(error)) => begun.error = Some(error.to_string()),
        Some(Ok(pilot)) if ladder.is_empty() => {
            begun.skipped = Some(format!("skipped: one pass is {:.2} s of counted work", pilot.work_s(1)));
        }
        Some(Ok(pilot)) => begun.counts = pilot.counts,
        None => {}
    }
    let (mut summary, jackknife) = summarise(begun, truth, runs, ladder);
    if let Some(error) = runs.rows.iter().find_map(|row| row.error.clone()) {
        summary.error = Some(error);
    }
    (summary, jackknife)
}

/// Bias and variance of a strategy's runs at its largest budget: from all of them, and without each in turn.
pub(crate) struct Jackknife {
    all: Parts,
    without: Vec<Parts>,
}

impl Jackknife {
    /// Of the images of a strategy's runs.
    fn of(truth: &Truth, runs: &Runs) -> Self {
        let spread = Spread::of(truth, &runs.images);
        let without = (0..runs.images.len()).map(|run| spread.parts(Some(run))).collect();
        Self { all: spread.parts(None), without }
    }

    fn parts(&self, without: Option<usize>) -> Parts {
        without.map_or(self.all, |run| self.without[run])
    }

    /// Squared bias as far as a claim lets it count: 0 of what claims to have none, never negative; not a number where it
    /// is not known.
    pub(crate) fn counted_bias2(&self, claim: &Claim) -> Figure {
        if !claim.may_be_biased() {
            return Figure::certain(0.0);
        }
        // `max` would turn NaN, a bias not known, into 0.
        if self.all.bias2.is_nan() { Figure::certain(f64::NAN) } else { self.bias2().above_zero() }
    }

    fn bias2(&self) -> Figure {
        Figure::signed_jackknife(self.without.len(), |run| self.parts(run).bias2)
    }

    fn variance(&self, tail: Tail) -> Figure {
        Figure::jackknife(self.without.len(), tail, |run| self.parts(run).variance)
    }
}

/// A summary with the figures of a strategy's runs, but for what depends on the other rows; and its bias for what does.
pub(crate) fn summarise(mut summary: Summary, truth: &Truth, runs: &Runs, ladder: &[u32]) -> (Summary, Jackknife) {
    let truth = ladder.last().map_or(truth, |&passes| truth.after(passes));
    let jackknife = Jackknife::of(truth, runs);
    let Some(last) = ladder.last().map(|&passes| runs.at(passes)).filter(|rows| !rows.is_empty()) else {
        return (summary, jackknife);
    };
    let values = |value: fn(&Row) -> f64| last.iter().map(|row| value(row)).collect::<Vec<f64>>();
    let mean = |value: fn(&Row) -> f64| Figure::mean(values(value)).interval();
    summary.runs = last.len() as u32;
    summary.passes = last[0].passes;
    summary.curve = ladder.iter().filter_map(|&passes| point(passes, &runs.at(passes))).collect();
    summary.setup_cpu_s =
        Figure::mean(runs.rows.iter().filter(|r| r.error.is_none()).map(|r| r.setup_cpu_s).collect()).interval();
    [summary.arrival_cpu_s, summary.pass_cpu_s] = cost(runs, ladder);
    summary.cpu_s = mean(|r| r.cpu_s);
    summary.wall_s = Moments::of(values(|r| r.wall_s)).mean;
    summary.heap_bytes = last.iter().map(|r| r.heap_bytes).max().unwrap_or(0);
    let tail = tail(&last);
    summary.rel_mse = error(&last).interval();
    // Its tail is taken to be as heavy as that of relMSE.
    let unit = Moments::of(values(|r| r.mse)).mean / summary.rel_mse.mean;
    summary.mse = Figure::error(values(|r| r.mse), tail.times(unit)).interval();
    summary.rel_mse_trimmed = mean(|r| r.rel_mse_trimmed);
    summary.mean_bias = bias(truth, &last, CONFIDENCE);
    summary.detectable_bias =
        Moments::of(values(|r| r.energy_ratio)).detectable(1.0 - CONFIDENCE).hypot(2.8 * truth.own_energy_error());
    let k = runs.images.len();
    if k == last.len() && k > 2 {
        let cpu_s = || figure::mean(&last, |r| r.cpu_s);
        let v = || Figure::of(vec![jackknife.variance(tail), cpu_s()], |parts| parts[0] * parts[1]);
        summary.rel_bias2 = jackknife.bias2().interval();
        let varies = jackknife.all.variance > 0.0;
        summary.variance_seconds = if varies { v().interval() } else { Interval::certain(0.0) };
        if summary.claim.may_be_biased() {
            // A b^2 that may be 0 gives a t* that may be anything.
            let balance = (varies && summary.rel_bias2.low > 0.0).then(|| v().over(jackknife.bias2())).flatten();
            summary.balance_s =
                Some(balance.map_or(
                    Interval { mean: f64::INFINITY, low: summary.cpu_s.mean, high: f64::INFINITY },
                    |balance| balance.interval(),
                ));
        }
    }
    summary.unstable = unstable(&last);
    (summary, jackknife)
}

/// The bias of the image's mean, as a share of it, with an interval at a confidence within (0, 1).
pub(crate) fn bias(truth: &Truth, rows: &[&Row], confidence: f64) -> Interval {
    let figure = Figure::signed_mean(rows.iter().map(|row| row.energy_ratio - 1.0).collect());
    let Bounds { low, high } = figure.bounds(confidence);
    // The reference's own error does not go away with more runs.
    let own = normal_quantile(0.5 + 0.5 * confidence) * truth.own_energy_error();
    let mean = figure.estimate;
    Interval { mean, low: mean - (mean - low).hypot(own), high: mean + (high - mean).hypot(own) }
}

fn point(passes: u32, rows: &[&Row]) -> Option<Point> {
    let mean = |value: fn(&Row) -> f64| Figure::mean(rows.iter().map(|row| value(row)).collect()).interval();
    (!rows.is_empty()).then(|| Point {
        passes,
        cpu_s: mean(|r| r.setup_cpu_s + r.cpu_s),
        rel_mse: error(rows).interval(),
    })
}

/// CPU seconds of arrival and of a pass: of the smallest and the largest budget, run by run; unknown from one budget.
fn cost(runs: &Runs, ladder: &[u32]) -> [Interval; 2] {
    let [Some(&first), Some(&last)] = [ladder.first(), ladder.last()] else { return [Interval::NONE; 2] };
    if first == last {
        return [Interval::NONE; 2];
    }
    let (few, many) = (runs.at(first), runs.at(last));
    let pass = |few: &Row, many: &Row| (many.cpu_s - few.cpu_s) / f64::from(last - first);
    let pairs = || few.iter().zip(&many);
    let passes = pairs().map(|(few, many)| pass(few, many)).collect();
    let arrivals = pairs().map(|(few, many)| few.cpu_s - f64::from(first) * pass(few, many)).collect();
    [Figure::signed_mean(arrivals).interval(), Figure::signed_mean(passes).interval()]
}

/// Whether the two halves of the runs differ by more than their intervals.
fn unstable(rows: &[&Row]) -> bool {
    let (first, second) = rows.split_at(rows.len() / 2);
    let [a, b] =
        [first, second].map(|half| Figure::error(half.iter().map(|row| row.rel_mse).collect(), tail(half)).interval());
    first.len() > 1 && (a.low > b.high || b.low > a.high)
}
