//! Where the record and the rows of a comparison lie: files in its folder that survive an interruption.

use super::check::Checked;
use super::files::input;
use super::origin;
use super::row::{COLUMNS, Row};
use super::run::RunRecord;
use super::schema::SCHEMA;
use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

pub(crate) use super::files::{ROWS_FILE, RUN_FILE, file_name};

/// Writes `run.json` into `folder`, whole or not at all; it is written again as scenes finish.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn write_run(folder: &Path, run: &RunRecord) -> Result<()> {
    write_record(&folder.join(RUN_FILE), run)
}

/// Reads `run.json` from `folder`.
///
/// # Errors
/// A file that cannot be read; a record of another schema, or with a mistake, with its line.
pub(crate) fn read_run(folder: &Path) -> Result<RunRecord> {
    read_record(&folder.join(RUN_FILE), SCHEMA)
}

/// What is in `folder` of the comparison that `own` begins: its record where it was begun there before, finished or not.
///
/// # Errors
/// Another comparison, by what it differs in; a record that cannot be read, or rows whose record is gone.
pub(crate) fn begun(folder: &Path, own: &RunRecord) -> Result<Option<RunRecord>> {
    if folder.join(RUN_FILE).exists() {
        let earlier = read_run(folder)?;
        origin::check(folder, "comparison", &earlier.command, &earlier.origin(), &own.origin())?;
        return Ok(Some(earlier));
    }
    if folder.join(ROWS_FILE).exists() {
        // The record is written first.
        let text = format!("holds rows whose {RUN_FILE} is gone: name another folder");
        return Err(Error::Invalid(format!("{} {text}", folder.display())));
    }
    Ok(None)
}

/// Writes a record as JSON, whole or not at all.
pub(super) fn write_record(path: &Path, record: &impl Serialize) -> Result<()> {
    let mut text = serde_json::to_string_pretty(record).map_err(|e| input(path, None, "", e.to_string()))?;
    text.push('\n');
    write_whole(path, text.as_bytes())
}

/// Reads a record from JSON; one of another schema, or that cannot be what it says, is refused.
pub(super) fn read_record<T: DeserializeOwned + Checked>(path: &Path, known: u32) -> Result<T> {
    #[derive(Deserialize)]
    struct Version {
        schema: u32,
    }
    let text = fs::read_to_string(path).map_err(Error::io("read", path))?;
    let unusable = |e: serde_json::Error| input(path, Some(e.line()), "", e.to_string());
    let Version { schema } = serde_json::from_str(&text).map_err(unusable)?;
    if schema != known {
        let message = format!("is {schema}, this program reads {known}: use the version that wrote it");
        return Err(input(path, None, "schema", message));
    }
    let record: T = serde_json::from_str(&text).map_err(unusable)?;
    record.check().map_err(|(field, why)| input(path, None, &field, why))?;
    Ok(record)
}

/// The rows of a `runs.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Rows {
    /// The finished ones, in the order written.
    pub rows: Vec<Row>,
    /// Whether a last line without an end was left out: the run was interrupted while writing it.
    pub cut_short: bool,
}

/// Reads `runs.csv` from `folder`.
///
/// A last line without its line break is an interrupted write: it is left out and reported in [`Rows::cut_short`].
///
/// # Errors
/// A file that cannot be read; anything else that is not a row, with file, line and column.
pub(crate) fn read_rows(folder: &Path) -> Result<Rows> {
    let path = folder.join(ROWS_FILE);
    let text = fs::read_to_string(&path).map_err(Error::io("read", &path))?;
    parse_rows(&path, &text)
}

fn parse_rows(path: &Path, text: &str) -> Result<Rows> {
    let whole = &text[..finished_bytes(text)];
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(whole.as_bytes());
    let mut rows = Vec::new();
    for (at, record) in reader.records().enumerate() {
        // One row is one line (`Row::fields` sees to it), so that the record's number is the line's.
        let line = Some(at + 1);
        let record = record.map_err(|e| input(path, line, "", e.to_string()))?;
        if at == 0 {
            check_header(path, &record)?;
        } else {
            rows.push(Row::parse(&record).map_err(|(column, why)| input(path, line, column, why))?);
        }
    }
    Ok(Rows { rows, cut_short: whole.len() < text.len() })
}

/// How many bytes of `text` are finished lines.
pub(super) fn finished_bytes(text: &str) -> usize {
    text.rfind('\n').map_or(0, |at| at + 1)
}

fn check_header(path: &Path, header: &csv::StringRecord) -> Result<()> {
    if *header == COLUMNS[..] {
        return Ok(());
    }
    let at = header.iter().zip(COLUMNS).position(|(given, expected)| given != expected);
    let message = match at {
        Some(at) => format!("column {} is `{}` where schema {SCHEMA} has `{}`", at + 1, &header[at], COLUMNS[at]),
        None => format!("{} columns where schema {SCHEMA} has {}", header.len(), COLUMNS.len()),
    };
    Err(input(path, Some(1), "", message))
}

/// Appends rows to `runs.csv`, each at once: an interrupted run keeps all finished rows.
#[derive(Debug)]
pub(crate) struct RowWriter {
    file: File,
    path: PathBuf,
}

impl RowWriter {
    /// Begins `runs.csv` in `folder`.
    ///
    /// # Errors
    /// A file that is already there, or that cannot be written.
    pub(crate) fn create(folder: &Path) -> Result<Self> {
        let path = folder.join(ROWS_FILE);
        let file = OpenOptions::new().append(true).create_new(true).open(&path).map_err(Error::io("create", &path))?;
        let mut writer = Self { file, path };
        writer.append(&COLUMNS)?;
        Ok(writer)
    }

    /// Goes on with the `runs.csv` of an interrupted run, or begins it, and gives its rows.
    ///
    /// A line cut short, and all but the last of rows for the same scene, strategy, run and budget are removed.
    ///
    /// # Errors
    /// A file that cannot be read or written; a finished line that is no row, with file, line and column.
    pub(crate) fn resume(folder: &Path) -> Result<(Self, Vec<Row>)> {
        let path = folder.join(ROWS_FILE);
        let text = match fs::read_to_string(&path) {
            Err(e) if e.kind() == ErrorKind::NotFound => String::new(),
            read => read.map_err(Error::io("read", &path))?,
        };
        let mut rows = parse_rows(&path, &text)?.rows;
        let mut seen = HashSet::new();
        let mut is_last: Vec<bool> = rows.iter().rev().map(|row| seen.insert(row.key())).collect();
        rows.retain(|_| is_last.pop() == Some(true));
        Ok((Self { file: rewritten(&path, &rows)?, path }, rows))
    }

    /// Removes rows, which will be made again.
    ///
    /// # Errors
    /// A file that cannot be read or written; a finished line that is no row, with file, line and column.
    pub(crate) fn forget(&mut self, unwanted: impl Fn(&Row) -> bool) -> Result<()> {
        let text = fs::read_to_string(&self.path).map_err(Error::io("read", &self.path))?;
        let mut rows = parse_rows(&self.path, &text)?.rows;
        rows.retain(|row| !unwanted(row));
        self.file = rewritten(&self.path, &rows)?;
        Ok(())
    }

    /// Appends one row; it is in the file when this returns.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(crate) fn write(&mut self, row: &Row) -> Result<()> {
        self.append(&row.fields())
    }

    /// Sees to it that all rows outlive a loss of power: to be called before a record says that they are there.
    ///
    /// # Errors
    /// A file that cannot be brought to disk.
    pub(crate) fn sync(&self) -> Result<()> {
        self.file.sync_all().map_err(Error::io("write", &self.path))
    }

    fn append<T: AsRef<[u8]>>(&mut self, fields: &[T]) -> Result<()> {
        // One call for the whole line: a `File` has no buffer of its own that could be lost.
        line(fields).and_then(|line| self.file.write_all(&line)).map_err(Error::io("write", &self.path))
    }
}

/// The file with these rows and no others, open to append more.
fn rewritten(path: &Path, rows: &[Row]) -> Result<File> {
    let mut text = line(&COLUMNS).map_err(Error::io("write", path))?;
    for row in rows {
        text.extend(line(&row.fields()).map_err(Error::io("write", path))?);
    }
    write_whole(path, &text)?;
    OpenOptions::new().append(true).open(path).map_err(Error::io("write", path))
}

/// The fields as a line of CSV.
pub(super) fn line<T: AsRef<[u8]>>(fields: &[T]) -> std::io::Result<Vec<u8>> {
    let mut line = csv::Writer::from_writer(Vec::new());
    line.write_record(fields)?;
    line.into_inner().map_err(csv::IntoInnerError::into_error)
}
