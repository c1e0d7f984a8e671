//! What stands in a row of a study's table: figures, and what a strategy says of itself or lacks.

use crate::record::study::Cell;
use crate::record::{Interval, Summary};

/// The three cells of an interval; missing what is not known.
pub(super) fn cells(interval: impl Into<Option<Interval>>) -> [Cell; 3] {
    match interval.into() {
        Some(Interval { mean, low, high }) => [mean, low, high].map(|value| (!value.is_nan()).then_some(value).into()),
        None => [Cell::Missing, Cell::Missing, Cell::Missing],
    }
}

/// What a strategy says of itself.
pub(super) fn claim(summary: &Summary) -> Cell {
    summary.claim.word().into()
}

/// Why a strategy has no figures; missing where it has.
pub(super) fn remark(summary: &Summary) -> Cell {
    let failed = summary.error.as_ref().map(|error| format!("failed: {error}"));
    failed.or_else(|| summary.skipped.clone()).as_deref().into()
}

/// Whether a strategy was measured.
pub(super) fn measured(summary: &Summary) -> bool {
    summary.error.is_none() && summary.skipped.is_none() && summary.runs > 0
}

/// Whether a strategy is right on average by its own claim.
pub(super) fn unbiased(summary: &Summary) -> bool {
    !summary.claim.may_be_biased()
}
