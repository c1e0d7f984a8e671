//! What a finished study is: what was asked, by what, where, and tables of typed cells.
//!
//! A study's folder holds `study.json` (a [`StudyRecord`]: all but the cells) and `<table>.csv` for each of its tables.
//! Like the rows of a comparison these are in base units, with the unit in the column's name; the page and the plots
//! are made again from them alone.

use super::number;
use super::program::Program;
use super::run::Machine;
use serde::{Deserialize, Serialize};

/// Version of the files' layout; files of another version are refused.
pub(crate) const STUDY_SCHEMA: u32 = 2;

/// One run of one study: everything in `study.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudyRecord {
    /// [`STUDY_SCHEMA`] of the writer.
    pub schema: u32,
    /// The study's name.
    pub study: String,
    /// What it asks.
    pub question: String,
    /// The command line.
    pub command: String,
    /// All that decides the cells, in canonical form: content of the scenes, strategies, options. An interrupted study is
    /// resumed only by one that asks for the same. Empty in records that are older than this field.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub plan: String,
    /// Day of the run, `2026-11-22`.
    pub date: String,
    /// The program, where it is not this crate's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<Program>,
    /// The crate's version; empty in records that are older than this field.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub version: String,
    /// Revision of the source.
    pub revision: String,
    /// The user's seed.
    pub seed: u64,
    /// Where it ran.
    pub machine: Machine,
    /// The compiler and its version.
    pub compiler: String,
    /// Flags that change the code.
    pub flags: String,
    /// What makes the figures doubtful.
    pub warnings: Vec<String>,
    /// Whether it came to its end; otherwise some rows are missing.
    pub finished: bool,
    /// Wall seconds that it took, of one that was resumed its last part; 0 before its end.
    #[serde(with = "number")]
    pub wall_s: f64,
    /// What a reader must know of all tables: how it was measured, what was left out and why.
    pub notes: Vec<String>,
    /// The tables, in order; their cells lie in files of their own.
    pub tables: Vec<TableRecord>,
    /// The pictures, in order, each a file of its own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pictures: Vec<PictureRecord>,
}

/// A picture that a study made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PictureRecord {
    /// Its file in the study's folder.
    pub file: String,
    /// What it shows.
    pub title: String,
}

/// A table without its cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TableRecord {
    /// Its name, which names its file: `<name>.csv`.
    pub name: String,
    /// Its title, for readers.
    pub title: String,
    /// The columns, in order.
    pub columns: Vec<ColumnRecord>,
    /// What a reader must know of this table: formulas, abbreviations.
    pub notes: Vec<String>,
    /// What is drawn of it.
    pub plots: Vec<PlotRecord>,
}

/// A column: what its cells are and how they are shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ColumnRecord {
    /// Its name in the file, which ends in its base unit if it has one: `setup_cpu_s`.
    pub name: String,
    /// Its head on a page, with the unit shown there; lines separated by `\n`.
    pub head: String,
    /// What its cells hold and how they are written on a page.
    pub format: Format,
}

/// What cells hold and how they are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Format {
    /// Text: a name as it is typed.
    Name,
    /// Text: words.
    Words,
    /// A whole number, with commas between thousands.
    Whole,
    /// A whole number of bytes, in the unit that suits it.
    Bytes,
    /// A number, to three digits.
    Number,
    /// A share, in percent.
    Percent,
    /// Seconds, in milliseconds.
    Milliseconds,
    /// Seconds, in nanoseconds.
    Nanoseconds,
    /// The lower end of the 95 % interval of the number in the column before, in its unit, shown with it.
    Low,
    /// The upper end, in the column after the lower.
    High,
}

impl Format {
    /// Whether a cell may stand in a column of this format; a missing one may always.
    pub(crate) fn takes(self, cell: &Cell) -> bool {
        match cell {
            Cell::Missing => true,
            Cell::Text(_) => self.is_text(),
            Cell::Whole(_) => self.is_whole(),
            Cell::Number(_) => !self.is_text() && !self.is_whole(),
        }
    }

    /// Whether its cells are an end of an interval.
    pub(crate) fn is_end(self) -> bool {
        matches!(self, Self::Low | Self::High)
    }

    /// Whether its cells are texts.
    pub(crate) fn is_text(self) -> bool {
        matches!(self, Self::Name | Self::Words)
    }

    /// Whether its cells are whole numbers.
    pub(crate) fn is_whole(self) -> bool {
        matches!(self, Self::Whole | Self::Bytes)
    }
}

/// What is drawn of a table: a curve for each value of one column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlotRecord {
    /// Its name, which names its file: `<study>-<name>.svg`.
    pub name: String,
    /// Its title, for readers.
    pub title: String,
    /// The column whose values tell the curves apart.
    pub series: String,
    /// The column along the horizontal axis.
    pub x: AxisRecord,
    /// The vertical axis.
    pub y: AxisRecord,
    /// Further columns along the vertical axis, each with what it adds to a curve's name: drawn dashed, with hollow
    /// marks.
    pub beside: Vec<(String, String)>,
    /// Values of `series` that are biased: drawn dashed, with hollow marks.
    pub biased: Vec<String>,
}

/// One axis of a plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxisRecord {
    /// The column.
    pub column: String,
    /// What is written along it, with the unit.
    pub label: String,
    /// Whether it is logarithmic; linear otherwise.
    pub logarithmic: bool,
}

/// What stands in a row's place under a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cell {
    /// Nothing: not measured, or without meaning here.
    Missing,
    /// A text, never empty; line breaks in it become spaces.
    Text(String),
    /// A whole number.
    Whole(u64),
    /// A number, infinite or NaN included.
    Number(f64),
}

impl Cell {
    /// The number that it holds, if it does.
    pub(crate) fn number(&self) -> Option<f64> {
        match *self {
            Self::Number(number) => Some(number),
            Self::Whole(count) => Some(count as f64),
            Self::Missing | Self::Text(_) => None,
        }
    }
}

/// One row of a table, a cell a column.
pub(crate) type Cells = Vec<Cell>;

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        if text.is_empty() { Self::Missing } else { Self::Text(text.replace(['\r', '\n'], " ")) }
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::Whole(count)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(cell: Option<T>) -> Self {
        cell.map_or(Self::Missing, Into::into)
    }
}

/// A study with its cells.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Study {
    /// All but the cells.
    pub record: StudyRecord,
    /// The rows of each table, in the order of [`StudyRecord::tables`].
    pub rows: Vec<Vec<Cells>>,
}

impl TableRecord {
    /// The place of the column of that name.
    pub(crate) fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }
}
