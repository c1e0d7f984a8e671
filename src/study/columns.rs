//! What is a study's table made of: short words for its columns and plots.

use crate::record::study::{AxisRecord, ColumnRecord, Format, PlotRecord};

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
