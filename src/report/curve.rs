//! The points of a strategy's curve: error and time at each budget, over the runs.

use crate::base::statistics::Moments;
use crate::record::Row;
use std::collections::BTreeMap;

/// One budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// CPU seconds, set-up included, mean over runs.
    pub(super) seconds: f64,
    /// relMSE, mean over runs.
    pub(super) error: f64,
    /// Half of its 95 % interval; infinite for a single run.
    pub(super) half_width: f64,
}

/// What the rows of one strategy on one scene say.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Curve {
    /// By budget, the smallest first; only points that a logarithmic plot can show.
    pub(super) points: Vec<Point>,
    /// Whether there were points with an error of exactly 0.
    pub(super) exact: bool,
}

impl Curve {
    /// The curve of `strategy` on `scene`; failed rows are left out.
    pub(super) fn of(rows: &[Row], scene: &str, strategy: &str) -> Self {
        let mut budgets: BTreeMap<u32, Vec<&Row>> = BTreeMap::new();
        for row in rows.iter().filter(|r| r.scene == scene && r.strategy == strategy && r.error.is_none()) {
            budgets.entry(row.passes).or_default().push(row);
        }
        let mut curve = Self::default();
        for runs in budgets.values() {
            let error = Moments::of(runs.iter().map(|r| r.rel_mse));
            let seconds = Moments::of(runs.iter().map(|r| r.setup_cpu_s + r.cpu_s)).mean;
            let drawable = |v: f64| v.is_finite() && v > 0.0;
            if drawable(error.mean) && drawable(seconds) {
                curve.points.push(Point { seconds, error: error.mean, half_width: error.half_width(0.95) });
            }
            curve.exact |= error.mean == 0.0;
        }
        curve
    }
}
