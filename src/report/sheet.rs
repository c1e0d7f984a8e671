//! A table before it is known where it will be shown: on a terminal or in Markdown.

use super::figures;
use crate::record::Summary;
use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use std::fmt::Write;

/// One column: its head (lines separated by `\n`) and what it says of a strategy.
pub(super) struct Column<'a> {
    head: &'static str,
    cell: Box<dyn Fn(&Summary) -> String + 'a>,
}

impl<'a> Column<'a> {
    /// A column headed `head`.
    pub(super) fn new(head: &'static str, cell: impl Fn(&Summary) -> String + 'a) -> Self {
        Self { head, cell: Box::new(cell) }
    }
}

/// A row: the strategy, what is to be said about it in words, and its cells.
struct Line {
    strategy: String,
    remark: String,
    cells: Vec<String>,
    /// Rows of different groups stand apart.
    group: u8,
}

/// A titled table with one row per strategy.
pub(super) struct Sheet {
    title: &'static str,
    heads: Vec<&'static str>,
    lines: Vec<Line>,
    below: Vec<String>,
}

/// Longest line of a strategy's name on a terminal; with it the widest table stays within 140 columns.
const NAME_WIDTH: usize = 22;

impl Sheet {
    /// The table of `columns` over `summaries`, in their order; a strategy that was not measured is a row with its reason.
    pub(super) fn new(title: &'static str, summaries: &[&Summary], columns: &[Column], below: Vec<String>) -> Self {
        let lines = summaries.iter().map(|summary| {
            let cells =
                columns.iter().map(|c| if figures::measured(summary) { (c.cell)(summary) } else { String::new() });
            Line {
                strategy: summary.strategy.clone(),
                remark: remark(summary),
                cells: cells.collect(),
                // Floor and ceiling stand together.
                group: figures::group(summary).min(2),
            }
        });
        Self { title, heads: columns.iter().map(|c| c.head).collect(), lines: lines.collect(), below }
    }

    /// The table in plain text.
    pub(super) fn text(&self) -> String {
        let style = TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));
        let mut table = Table::new();
        table.load_style(style).set_content_arrangement(ContentArrangement::Disabled);
        table.set_header(std::iter::once("strategy").chain(self.heads.iter().copied()));
        for (at, line) in self.lines.iter().enumerate() {
            if at > 0 && self.lines[at - 1].group != line.group {
                table.add_row([" "]);
            }
            let name = [folded(&line.strategy), folded(&line.remark)].join("\n").trim_end().to_owned();
            let cells = line.cells.iter().map(|c| Cell::new(c).set_alignment(CellAlignment::Right));
            table.add_row(std::iter::once(Cell::new(name)).chain(cells));
        }
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        let mut text = format!("{}\n\n{}\n", self.title, table.trim_fmt());
        if !self.below.is_empty() {
            text.push('\n');
        }
        self.below.iter().for_each(|note| _ = writeln!(text, " {note}"));
        text
    }

    /// The table in GitHub's Markdown, under a heading of `level`, 1 to 6.
    pub(super) fn markdown(&self, level: usize) -> String {
        let mut text = format!("{} {}\n\n| strategy |", "#".repeat(level), self.title);
        self.heads.iter().for_each(|head| _ = write!(text, " {} |", head.replace('\n', "<br>")));
        text.push_str("\n|:--|");
        self.heads.iter().for_each(|_| text.push_str("--:|"));
        text.push('\n');
        for (at, line) in self.lines.iter().enumerate() {
            if at > 0 && self.lines[at - 1].group != line.group {
                _ = writeln!(text, "|{}", " |".repeat(self.heads.len() + 1));
            }
            _ = write!(text, "| `{}`", line.strategy.replace('|', "\\|"));
            if !line.remark.is_empty() {
                _ = write!(text, "<br>{}", line.remark.replace('|', "\\|"));
            }
            line.cells.iter().for_each(|cell| _ = write!(text, " | {cell}"));
            text.push_str(" |\n");
        }
        self.below.iter().for_each(|note| _ = write!(text, "\n- {note}"));
        if !self.below.is_empty() {
            text.push('\n');
        }
        text
    }
}

/// What is to be said of a strategy in words; empty for most.
fn remark(summary: &Summary) -> String {
    match (&summary.error, &summary.skipped) {
        (Some(error), _) => format!("failed: {error}"),
        (None, Some(skipped)) => skipped.clone(),
        (None, None) if summary.unstable => "unstable".to_owned(),
        (None, None) => String::new(),
    }
}

/// `text` in lines of at most [`NAME_WIDTH`] where it can be broken: after `:` and `,` and between words;
/// further lines are indented.
fn folded(text: &str) -> String {
    let mut lines = vec![String::new()];
    for part in text.split_inclusive([':', ',', ' ']) {
        let line = lines.last_mut().expect("there is always a line");
        if !line.trim().is_empty() && line.chars().count() + part.trim_end().chars().count() > NAME_WIDTH {
            lines.push(format!("  {part}"));
        } else {
            line.push_str(part);
        }
    }
    lines.join("\n")
}
