//! The points of a strategy's curve: error and time at each budget, over the runs.

use crate::base::statistics::Moments;
use crate::record::Row;
use std::collections::BTreeMap;

/// One budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// CPU seconds of building, mean over runs.
    pub(super) setup: f64,
    /// CPU seconds, set-up included, mean over runs.
    pub(super) seconds: f64,
    /// relMSE, mean over runs.
    pub(super) error: f64,
    /// Half of its 95 % interval; infinite for a single run.
    pub(super) half_width: f64,
}

impl Point {
    /// Whether logarithmic axes can show it.
    pub(super) fn is_drawable(&self) -> bool {
        self.seconds > 0.0 && self.error > 0.0
    }
}

/// The rows of `scene` with numbers, by strategy, budget and run.
///
/// Of several rows of the same strategy, budget and run only the last counts: an interrupted run that goes on measures
/// its last unit again.
pub(super) fn rows_of<'a>(rows: &'a [Row], scene: &str) -> Vec<&'a Row> {
    let of_scene = rows.iter().filter(|row| row.scene == scene);
    let last: BTreeMap<_, &Row> = of_scene.map(|row| ((&row.strategy, row.passes, row.run), row)).collect();
    last.into_values().filter(|row| row.error.is_none()).collect()
}

/// What the rows of one strategy on one scene say.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Curve {
    /// By budget, the smallest first; only finite ones.
    pub(super) points: Vec<Point>,
}

impl Curve {
    /// The curve of `strategy` from the rows of a scene ([`rows_of`]).
    pub(super) fn of(rows: &[&Row], strategy: &str) -> Self {
        let mut budgets: BTreeMap<u32, Vec<&Row>> = BTreeMap::new();
        for row in rows.iter().filter(|row| row.strategy == strategy) {
            budgets.entry(row.passes).or_default().push(row);
        }
        let points = budgets.values().map(|runs| {
            let error = Moments::of(runs.iter().map(|r| r.rel_mse));
            let setup = Moments::of(runs.iter().map(|r| r.setup_cpu_s)).mean;
            let seconds = Moments::of(runs.iter().map(|r| r.setup_cpu_s + r.cpu_s)).mean;
            Point { setup, seconds, error: error.mean, half_width: error.half_width(0.95) }
        });
        Self { points: points.filter(|p| p.seconds.is_finite() && p.error.is_finite()).collect() }
    }

    /// Whether there are points with an error of exactly 0.
    pub(super) fn is_exact(&self) -> bool {
        self.points.iter().any(|point| point.error == 0.0)
    }
}
