//! What do the raw rows say that no summary holds?

use crate::record::{Row, Summary};
use std::collections::BTreeMap;

/// The rows of a scene with numbers.
pub(super) struct Rows<'a>(Vec<&'a Row>);

impl<'a> Rows<'a> {
    /// Those of `scene` among all.
    ///
    /// Of several rows of the same strategy, budget and run only the last counts: an interrupted run that goes on
    /// measures its last unit again.
    pub(super) fn of(rows: &'a [Row], scene: &str) -> Self {
        let of_scene = rows.iter().filter(|row| row.scene == scene);
        let last: BTreeMap<_, &Row> = of_scene.map(|row| ((&row.strategy, row.passes, row.run), row)).collect();
        Self(last.into_values().filter(|row| row.error.is_none()).collect())
    }

    /// Mean over the runs of a strategy at its largest budget; NaN of none.
    pub(super) fn mean_at_end(&self, summary: &Summary, value: impl Fn(&Row) -> f64) -> f64 {
        let at_end = self.0.iter().filter(|r| r.strategy == summary.strategy && r.passes == summary.passes);
        let (n, sum) = at_end.fold((0u32, 0.0), |(n, sum), row| (n + 1, sum + value(row)));
        sum / f64::from(n)
    }
}
