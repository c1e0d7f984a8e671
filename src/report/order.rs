//! In which order do strategies stand?

use crate::base::claim::Claim;
use crate::record::{SceneRecord, Summary};
use std::cmp::Ordering;

/// Whether the strategy ran to its end, so that its numbers mean something.
pub(super) fn measured(summary: &Summary) -> bool {
    summary.error.is_none() && summary.skipped.is_none()
}

/// The group of what no strategy is to be chosen among: from here on they stand together.
pub(super) const FLOOR: u8 = 3;

/// Unbiased rows, then biased ones, then other renderers, then the floor, then the ceiling, then the oracle.
pub(super) fn group(summary: &Summary) -> u8 {
    match summary.claim {
        Claim::Unbiased => 0,
        Claim::Biased { .. } => 1,
        Claim::External { .. } => 2,
        Claim::Floor => FLOOR,
        Claim::Ceiling => FLOOR + 1,
        Claim::Oracle => FLOOR + 2,
    }
}

/// The order of tables and legends: by group, then by the time to the error that ranks; those without such a time by
/// their error after them, those without numbers last, equal ones by name.
pub(super) fn ordered(scene: &SceneRecord) -> Vec<&Summary> {
    let mut summaries: Vec<&Summary> = scene.summaries.iter().collect();
    let seconds = |s: &Summary| {
        let reading = s.seconds_to.get(scene.ranked_by as usize);
        reading.map(|reading| reading.value.mean).filter(|seconds| seconds.is_finite()).unwrap_or(f64::INFINITY)
    };
    let compare = |a: &&Summary, b: &&Summary| -> Ordering {
        let key = |s: &Summary| (group(s), !measured(s));
        key(a)
            .cmp(&key(b))
            .then(seconds(a).total_cmp(&seconds(b)))
            .then(a.rel_mse.mean.total_cmp(&b.rel_mse.mean))
            .then_with(|| a.strategy.cmp(&b.strategy))
    };
    summaries.sort_by(compare);
    summaries
}
