//! How a study writes down its tables: short words for columns, axes and plots.

use crate::record::Interval;
use crate::record::Summary;
use crate::record::study::{AxisRecord, Cell, ColumnRecord, Format, PlotRecord};

/// A column `name` of the file under the head `head` of the page.
pub(super) fn column(name: &str, head: &str, format: Format) -> ColumnRecord {
    ColumnRecord { name: name.to_owned(), head: head.to_owned(), format }
}

/// A column of figures, and one for each end of their 95 % intervals.
pub(super) fn interval(name: &str, head: &str, format: Format) -> [ColumnRecord; 3] {
    let end = |end: &str, format| column(&format!("{name}_{end}"), "", format);
    [column(name, head, format), end("low", Format::Low), end("high", Format::High)]
}

/// A log-log plot of the column `y` over the column `x`, a curve for each value of `series`.
pub(super) fn plot(name: &str, title: &str, series: &str, x: (&str, &str), y: (&str, &str)) -> PlotRecord {
    let axis = |(column, label): (&str, &str)| AxisRecord {
        column: column.to_owned(),
        label: label.to_owned(),
        logarithmic: true,
    };
    PlotRecord {
        name: name.to_owned(),
        title: title.to_owned(),
        series: series.to_owned(),
        x: axis(x),
        y: axis(y),
        beside: Vec::new(),
        biased: Vec::new(),
    }
}

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
