//! What did a study find? Its tables, page and plots, from its record and cells alone.

use super::chart::{Chart, Dot, Scale, Series};
use super::mark::Mark;
use super::markdown;
use super::number::{Estimate, NONE, bytes, grouped, percent, short};
use super::page::built;
use super::sheet::{Entry, Head, Line, Sheet, broken};
use crate::base::error::Result;
use crate::record::study::{
    AxisRecord, Cell, Cells, ColumnRecord, Format, PlotRecord, Study, StudyRecord, TableRecord,
};
use crate::record::{Interval, store};
use std::fmt::Write;

/// The tables of a study in plain text, at most so many columns wide, under what a reader must know of all of them.
pub(crate) fn study_text(study: &Study, width: usize) -> String {
    let record = &study.record;
    let mut text = format!("{}: {}\n", record.study, record.question);
    let warnings = warnings(record).into_iter().map(|warning| format!("warning: {warning}"));
    let lines = record.notes.iter().cloned().chain(warnings).flat_map(|line| broken(&line, width - 2));
    lines.for_each(|line| _ = writeln!(text, "  {line}"));
    sheets(study).for_each(|sheet| _ = write!(text, "\n{}", sheet.text(width)));
    text
}

/// The page of a study in GitHub's Markdown, with the command and the conditions that it came from.
pub(super) fn page(study: &Study) -> String {
    let record = &study.record;
    let mut text = body(study, 1, "");
    let machine = &record.machine;
    _ = write!(text, "\n## Made by\n\n{}\n\n", markdown::block(&record.command));
    let made = [
        format!("date: {}; {} wall seconds", record.date, short(record.wall_s)),
        format!("revision: {}", built(record.program.as_ref(), &record.version, &record.revision)),
        format!("machine: {}, {} cores, {}", machine.cpu, machine.cores, machine.os),
        format!("compiler: {}; {}", record.compiler, record.flags),
        format!("seed: {}", record.seed),
    ];
    made.iter().for_each(|line| _ = writeln!(text, "- {}", markdown::plain(line)));
    text
}

/// A study for a page that people write; `folder` is the address of its folder as seen from there, with a slash at its
/// end.
pub(super) fn section(study: &Study, folder: &str) -> String {
    let record = &study.record;
    let mut text = body(study, 2, folder);
    let place = format!("({}, revision {}, {})", record.date, record.revision, record.machine.cpu);
    _ = writeln!(text, "\nMade by {} {}.", markdown::code(&record.command), markdown::plain(&place));
    text
}

/// Question, notes, warnings, tables and plots, under a heading of `level`.
fn body(study: &Study, level: usize, folder: &str) -> String {
    let record = &study.record;
    let (name, question) = (markdown::plain(&record.study), markdown::plain(&record.question));
    let mut text = format!("{} study {name}\n\n{question}\n", "#".repeat(level));
    if !record.notes.is_empty() || !warnings(record).is_empty() {
        text.push('\n');
    }
    record.notes.iter().for_each(|note| _ = writeln!(text, "- {}", markdown::plain(note)));
    warnings(record).iter().for_each(|warning| _ = writeln!(text, "- **{}**", markdown::plain(warning)));
    for picture in &record.pictures {
        let (title, file) = (markdown::label(&picture.title), store::file_name(&picture.file));
        _ = write!(text, "\n![{title}]({folder}{file})\n");
    }
    for (table, sheet) in record.tables.iter().zip(sheets(study)) {
        _ = write!(text, "\n{}", sheet.markdown(level + 1));
        for plot in &table.plots {
            _ = write!(text, "\n![{}]({folder}{})\n", markdown::label(&plot.title), plot_name(record, plot));
        }
    }
    text
}

/// Every plot of a study: its file's name and its SVG.
pub(super) fn plots(study: &Study) -> Result<Vec<(String, String)>> {
    let mut files = Vec::new();
    for (table, rows) in study.record.tables.iter().zip(&study.rows) {
        for plot in &table.plots {
            files.push((plot_name(&study.record, plot), chart(&study.record, table, rows, plot).svg()?));
        }
    }
    Ok(files)
}

fn plot_name(record: &StudyRecord, plot: &PlotRecord) -> String {
    format!("{}.svg", store::file_name(&format!("{}-{}", record.study, plot.name)))
}

fn warnings(record: &StudyRecord) -> Vec<String> {
    let unfinished = (!record.finished).then(|| "not finished: some rows are missing".to_owned());
    record.warnings.iter().cloned().chain(unfinished).collect()
}

fn sheets(study: &Study) -> impl Iterator<Item = Sheet> {
    study.record.tables.iter().zip(&study.rows).map(|(table, rows)| sheet(table, rows))
}

/// Rows of the longest table that a page or a terminal shows; of a longer one stands there which file holds them.
const LONGEST: usize = 150;

fn sheet(table: &TableRecord, rows: &[Cells]) -> Sheet {
    if rows.len() > LONGEST {
        let file = format!("{}.csv", store::file_name(&table.name));
        let cells = vec![Entry::Text(file), Entry::Text(grouped(rows.len() as u64))];
        let (heads, lines) = (vec![Head::left("file"), Head::right("rows")], vec![Line { cells, group: 0 }]);
        return Sheet { title: table.title.clone(), heads, lines, below: table.notes.clone() };
    }
    // A column that says nothing in any row is left out.
    let is_empty = |at: usize| !rows.is_empty() && rows.iter().all(|cells| cells[at] == Cell::Missing);
    let is_shown = |(at, column): &(usize, &ColumnRecord)| !column.format.is_end() && !is_empty(*at);
    let shown = || table.columns.iter().enumerate().filter(is_shown);
    let heads = shown().map(|(_, column)| match column.format.is_text() {
        true => Head::left(&column.head),
        false => Head::right(&column.head),
    });
    // Rows that share their first cell stand together, where any do.
    let same = |at: usize| at > 0 && rows[at - 1].first() == rows[at].first();
    let grouped = (0..rows.len()).any(same);
    let mut group = 0;
    let lines = rows.iter().enumerate().map(|(at, cells)| {
        group += u32::from(grouped && !same(at));
        Line { cells: shown().map(|(i, column)| entry(column, &cells[i], ends(table, cells, i))).collect(), group }
    });
    Sheet { title: table.title.clone(), heads: heads.collect(), lines: lines.collect(), below: table.notes.clone() }
        .explained()
}

/// The ends of the interval of the number in the column at `at`, if it has one.
fn ends(table: &TableRecord, cells: &[Cell], at: usize) -> Option<(f64, f64)> {
    let has_ends = table.columns.get(at + 1).is_some_and(|column| column.format == Format::Low);
    let end = |at: usize| cells.get(at).and_then(Cell::number);
    has_ends.then(|| end(at + 1).zip(end(at + 2)))?
}

fn entry(column: &ColumnRecord, cell: &Cell, ends: Option<(f64, f64)>) -> Entry {
    let text = match (cell, column.format) {
        (Cell::Missing, format) if format.is_text() => String::new(),
        (Cell::Missing, _) => NONE.to_owned(),
        (Cell::Text(text), Format::Name) => return Entry::Name(text.clone(), String::new()),
        (Cell::Text(text), _) => text.clone(),
        (Cell::Whole(count), Format::Bytes) => bytes(*count),
        (Cell::Whole(count), _) => grouped(*count),
        (Cell::Number(mean), format) => match (format, ends.map(|ends| Interval::of(*mean, ends))) {
            (Format::Percent, Some(share)) => return Entry::Figure(Estimate::signed_percent(share)),
            (Format::Percent, None) => percent(*mean, 1.0),
            (Format::Milliseconds, Some(seconds)) => return Entry::Figure(Estimate::of(seconds.times(1e3))),
            (Format::Milliseconds, None) => short(1e3 * mean),
            (Format::Nanoseconds, Some(seconds)) => return Entry::Figure(Estimate::of(seconds.times(1e9))),
            (Format::Nanoseconds, None) => short(1e9 * mean),
            (_, Some(interval)) => return Entry::Figure(Estimate::of(interval)),
            (_, None) => short(*mean),
        },
    };
    Entry::Text(text)
}

fn chart(record: &StudyRecord, table: &TableRecord, rows: &[Cells], plot: &PlotRecord) -> Chart {
    let scale = |axis: &AxisRecord| Scale { label: axis.label.clone(), logarithmic: axis.logarithmic };
    let (x, y) = (scale(&plot.x), scale(&plot.y));
    let mut series: Vec<Series> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    let cell = |cells: &Cells, column: &str| table.column(column).map(|at| cells[at].clone());
    for name in rows.iter().filter_map(|cells| cell(cells, &plot.series)).map(|cell| label(&cell)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let own = (plot.y.column.as_str(), "");
    let beside = plot.beside.iter().map(|(column, adds)| (column.as_str(), adds.as_str()));
    for (column, adds) in std::iter::once(own).chain(beside) {
        let at = table.column(column);
        for (nth, name) in names.iter().enumerate() {
            let of_series = |cells: &&Cells| cell(cells, &plot.series).is_some_and(|cell| label(&cell) == *name);
            let dot = |cells: &Cells| {
                let value = |column: &str| cell(cells, column).and_then(|cell| cell.number());
                let (low, high) = at.and_then(|at| ends(table, cells, at)).unwrap_or((f64::NAN, f64::NAN));
                Some(Dot { x: value(&plot.x.column)?, y: value(column)?, low, high })
            };
            let points = rows.iter().filter(of_series).filter_map(dot);
            let points = points.filter(|dot| x.shows(dot.x) && y.shows(dot.y)).collect();
            let mark = Mark::nth(nth, column != own.0 || plot.biased.contains(name));
            series.push(Series { name: format!("{name}{adds}"), mark, points });
        }
    }
    let subtitle = format!("study {}, seed {}; {}", record.study, record.seed, table.title);
    let is_drawn = |name: &String| series.iter().any(|s| s.name == *name && !s.points.is_empty());
    let remarks = match plot.biased.iter().any(is_drawn) {
        true => vec![(34, "dashed and hollow: biased".to_owned())],
        false => Vec::new(),
    };
    Chart { title: plot.title.clone(), subtitle, x, y, series, remarks }
}

/// The name of the curve of a cell's value.
fn label(cell: &Cell) -> String {
    match cell {
        Cell::Missing => NONE.to_owned(),
        Cell::Text(text) => text.clone(),
        Cell::Whole(count) => grouped(*count),
        Cell::Number(number) => short(*number),
    }
}
