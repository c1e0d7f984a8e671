//! A table before it is known where it will be shown: on a terminal or in Markdown.

use super::markdown;
use super::number::{Estimate, HEAVY, UNKNOWN};
use super::order::{self, measured};
use crate::record::Summary;
use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use std::fmt::Write;

/// One column: its head (lines separated by `\n`) and what it says of a strategy.
pub(super) struct Column<'a> {
    head: String,
    cell: Box<dyn Fn(&Summary) -> Estimate + 'a>,
}

impl<'a> Column<'a> {
    /// A column headed `head`.
    pub(super) fn new<T: Into<Estimate>>(head: impl Into<String>, cell: impl Fn(&Summary) -> T + 'a) -> Self {
        Self { head: head.into(), cell: Box::new(move |summary| cell(summary).into()) }
    }
}

/// The head of a column, and on which side its cells stand.
pub(super) struct Head {
    text: String,
    left: bool,
}

/// A cell.
pub(super) enum Entry {
    /// A name as it is typed, and what is to be said about it in words.
    Name(String, String),
    /// Words, or a figure without doubt.
    Text(String),
    /// A figure with its interval.
    Figure(Estimate),
}

/// A row.
pub(super) struct Line {
    pub(super) cells: Vec<Entry>,
    /// Rows of different groups stand apart.
    pub(super) group: u32,
}

/// A titled table.
pub(super) struct Sheet {
    pub(super) title: String,
    pub(super) heads: Vec<Head>,
    pub(super) lines: Vec<Line>,
    pub(super) below: Vec<String>,
}

impl Head {
    /// Of texts, which stand on the left.
    pub(super) fn left(text: &str) -> Self {
        Self { text: text.to_owned(), left: true }
    }

    /// Of figures, which stand on the right.
    pub(super) fn right(text: &str) -> Self {
        Self { text: text.to_owned(), left: false }
    }
}

/// Columns that all is made to fit where nobody says how many there are.
pub(crate) const WIDTH: usize = 140;
/// Longest line of a strategy's name on a terminal; with it the widest table stays within [`WIDTH`].
const NAME_WIDTH: usize = 22;

impl Sheet {
    /// The table of `columns` over `summaries`, in their order; a strategy that was not measured is a row with its
    /// reason.
    pub(super) fn new(title: &str, summaries: &[&Summary], columns: &[Column], below: Vec<String>) -> Self {
        let lines = summaries.iter().map(|summary| {
            let cell = |column: &Column| match measured(summary) {
                true => Entry::Figure((column.cell)(summary)),
                false => Entry::Text(String::new()),
            };
            let name = Entry::Name(summary.strategy.clone(), remark(summary).to_owned());
            Line {
                cells: std::iter::once(name).chain(columns.iter().map(cell)).collect(),
                group: u32::from(order::group(summary).min(order::FLOOR)),
            }
        });
        let heads = std::iter::once(Head::left("strategy")).chain(columns.iter().map(|c| Head::right(&c.head)));
        Self { title: title.to_owned(), heads: heads.collect(), lines: lines.collect(), below }.explained()
    }

    /// With what the marks in its figures mean.
    pub(super) fn explained(mut self) -> Self {
        let marks = [
            (HEAVY, "too heavy a tail to say: a few pixels decide the mean, the runs cannot bound it from there on"),
            (UNKNOWN, "the runs give no interval"),
        ];
        for (mark, meaning) in marks {
            let is_marked = |entry: &Entry| matches!(entry, Entry::Figure(estimate) if estimate.interval == mark);
            if self.lines.iter().flat_map(|line| &line.cells).any(is_marked) {
                self.below.push(format!("{mark}: {meaning}."));
            }
        }
        self
    }

    /// The table in plain text, `width` columns wide at most. One that would be wider has its intervals below the figures
    /// and not beside them; where that is not enough, the last columns stand in a table below, beside the names again.
    pub(super) fn text(&self, width: usize) -> String {
        let all: Vec<usize> = (0..self.heads.len()).collect();
        let beside = self.drawn(&all, Estimate::line);
        let drawn = if fits(&beside, width) { beside.trim_fmt() } else { self.in_parts(width) };
        let mut text = format!("{}\n\n{drawn}\n", self.title);
        if !self.below.is_empty() {
            text.push('\n');
        }
        let lines = self.below.iter().flat_map(|note| broken(note, width - 1));
        lines.for_each(|line| _ = writeln!(text, " {line}"));
        text
    }

    /// Tables one below the other, each with the names and as many of the other columns as it can hold.
    fn in_parts(&self, width: usize) -> String {
        let below = |e: &Estimate| format!("{}\n{}", e.figure, e.interval).trim_end().to_owned();
        let mut parts = vec![vec![0]];
        for at in 1..self.heads.len() {
            let part = parts.last_mut().expect("there is one from the beginning");
            part.push(at);
            if part.len() > 2 && !fits(&self.drawn(part, below), width) {
                part.pop();
                parts.push(vec![0, at]);
            }
        }
        let drawn = parts.iter().map(|part| {
            let mut table = self.drawn(part, below);
            if !fits(&table, width) {
                // A single column: its words are broken wherever they must be.
                let width = u16::try_from(width).unwrap_or(u16::MAX);
                table.set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
            }
            table.trim_fmt()
        });
        drawn.collect::<Vec<_>>().join("\n\n")
    }

    /// Some columns of heads and lines, with figures as `figure` writes them.
    fn drawn(&self, columns: &[usize], figure: impl Fn(&Estimate) -> String) -> Table {
        let heads = || columns.iter().map(|&at| &self.heads[at]);
        let style = TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));
        let mut table = Table::new();
        table.load_style(style).set_content_arrangement(ContentArrangement::Disabled);
        table.set_header(heads().map(|head| &head.text));
        for (at, line) in self.lines.iter().enumerate() {
            if self.is_new_group(at) {
                table.add_row([" "]);
            }
            // The row of a strategy that was not measured may end early.
            let cells = columns.iter().zip(heads()).filter_map(|(&at, head)| Some((line.cells.get(at)?, head)));
            table.add_row(cells.map(|(entry, head)| match entry {
                Entry::Name(name, remark) => Cell::new([folded(name), folded(remark)].join("\n").trim_end()),
                Entry::Text(text) if head.left => Cell::new(folded(text)),
                Entry::Text(text) => Cell::new(text).set_alignment(CellAlignment::Right),
                Entry::Figure(estimate) => Cell::new(figure(estimate)).set_alignment(CellAlignment::Right),
            }));
        }
        for (column, head) in table.column_iter_mut().zip(heads()) {
            column.set_padding((1, 0));
            if !head.left {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        table
    }

    /// The table in GitHub's Markdown, under a heading of `level`, 1 to 6.
    pub(super) fn markdown(&self, level: usize) -> String {
        let mut text = format!("{} {}\n\n|", "#".repeat(level), markdown::plain(&self.title));
        let head = |head: &Head| head.text.split('\n').map(markdown::cell).collect::<Vec<_>>().join("<br>");
        self.heads.iter().for_each(|one| _ = write!(text, " {} |", head(one)));
        text.push_str("\n|");
        self.heads.iter().for_each(|head| text.push_str(if head.left { ":--|" } else { "--:|" }));
        text.push('\n');
        for (at, line) in self.lines.iter().enumerate() {
            if self.is_new_group(at) {
                _ = writeln!(text, "|{}", " |".repeat(self.heads.len()));
            }
            text.push('|');
            for entry in &line.cells {
                _ = match entry {
                    Entry::Name(name, remark) if remark.is_empty() => write!(text, " {} |", name_cell(name)),
                    Entry::Name(name, remark) => write!(text, " {}<br>{} |", name_cell(name), markdown::cell(remark)),
                    Entry::Text(cell) => write!(text, " {} |", markdown::cell(cell)),
                    Entry::Figure(estimate) => write!(text, " {} |", markdown::cell(&estimate.line())),
                };
            }
            text.push('\n');
        }
        self.below.iter().for_each(|note| _ = write!(text, "\n- {}", markdown::plain(note)));
        if !self.below.is_empty() {
            text.push('\n');
        }
        text
    }

    fn is_new_group(&self, at: usize) -> bool {
        at > 0 && self.lines[at - 1].group != self.lines[at].group
    }
}

/// `text` in lines of at most `width` where words allow it; further lines are indented.
pub(crate) fn broken(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            Some(_) => lines.push(format!("  {word}")),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A name in a cell of Markdown: the end of a cell is one in code, too.
fn name_cell(name: &str) -> String {
    markdown::code(name).replace('|', "\\|")
}

/// Whether no line of a table is wider.
fn fits(table: &Table, width: usize) -> bool {
    table.trim_fmt().lines().all(|line| line.chars().count() <= width)
}

/// What is to be said of a strategy in a word; empty for most.
fn remark(summary: &Summary) -> &'static str {
    match (&summary.error, &summary.skipped) {
        (Some(_), _) => "failed, see below",
        (None, Some(_)) => "not run, see below",
        (None, None) if summary.unstable => "unstable",
        (None, None) => "",
    }
}

/// `text` in lines of at most [`NAME_WIDTH`] where it can be broken: after `:` and `,` and between words, and in a word
/// that is much longer; further lines are indented.
fn folded(text: &str) -> String {
    let mut lines = vec![String::new()];
    for part in text.split_inclusive([':', ',', ' ']).flat_map(pieces) {
        let line = lines.last_mut().expect("there is always a line");
        if !line.trim().is_empty() && line.chars().count() + part.trim_end().chars().count() > NAME_WIDTH {
            lines.push(format!("  {part}"));
        } else {
            line.push_str(&part);
        }
    }
    lines.join("\n")
}

/// A word, in pieces if it is longer than half a line more than a line.
fn pieces(word: &str) -> Vec<String> {
    let letters: Vec<char> = word.chars().collect();
    let most = if letters.len() > NAME_WIDTH + NAME_WIDTH / 2 { NAME_WIDTH - 2 } else { letters.len().max(1) };
    letters.chunks(most).map(|piece| piece.iter().collect()).collect()
}
