//! Where studies lie: a folder with `study.json` and a CSV file a table, whose rows are there as soon as they are
//! known.

use super::files::{file_name, input};
use super::folder::ResultFolder;
use super::origin;
use super::store::{self, line};
use super::study::{Cell, Cells, Format, PictureRecord, STUDY_SCHEMA, Study, StudyRecord, TableRecord};
use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

pub(crate) use super::files::STUDY_FILE;

/// A study being made, in a folder that is its own: what is known is on disk at once, so that an interruption loses
/// none of it, and a study that is begun again asks what it [`has`](Self::has).
pub(crate) struct StudyWriter {
    folder: ResultFolder,
    study: Study,
}

impl StudyWriter {
    /// Begins the study that `record` describes in `folder`, or goes on with it where it was begun there.
    ///
    /// # Errors
    /// Another study, by what it differs in; files of this one that cannot be read, or say what is no study; a folder
    /// that cannot be written.
    pub(crate) fn open(folder: ResultFolder, record: StudyRecord) -> Result<Self> {
        let path = folder.path();
        let study = if is_study(path) {
            let study = read_study(path)?;
            let earlier = &study.record;
            if earlier.study != record.study {
                let text = format!("{} holds the study {}: name another folder", path.display(), earlier.study);
                return Err(Error::Invalid(text));
            }
            origin::check(path, "study", &earlier.command, &earlier.origin(), &record.origin())?;
            if earlier.tables != record.tables {
                let text = format!("{} holds the same study with other tables: name another folder", path.display());
                return Err(Error::Invalid(text));
            }
            study
        } else {
            let rows = vec![Vec::new(); record.tables.len()];
            write(path, &record)?;
            Study { record, rows }
        };
        if !study.record.finished {
            let tables = study.record.tables.iter().zip(&study.rows);
            tables.into_iter().try_for_each(|(table, rows)| write_table(path, table, rows))?;
        }
        Ok(Self { folder, study })
    }

    /// Whether exactly `count` rows of a table have the cells of `key`: all that was measured together is there.
    ///
    /// # Panics
    ///
    /// If there is no such table or column: a mistake in a study's own code, here as below.
    pub(crate) fn has(&self, table: &str, key: Key<'_>, count: usize) -> bool {
        let (record, rows) = self.table(table);
        rows.iter().filter(|cells| has(record, cells, key)).count() == count
    }

    /// Puts rows that were measured together into a table, in place of all that have the cells of `key`.
    ///
    /// All of them are in the table's file when this returns, or none if it is interrupted.
    ///
    /// # Panics
    ///
    /// If a row does not have the cells of `key` or does not fit the table's columns.
    ///
    /// # Errors
    /// A table's file that cannot be written.
    pub(crate) fn put(&mut self, table: &str, key: Key<'_>, rows: Vec<Cells>) -> Result<()> {
        let place = self.place(table);
        let (record, there) = (&self.study.record.tables[place], &mut self.study.rows[place]);
        for cells in &rows {
            let fits = cells.len() == record.columns.len()
                && record.columns.iter().zip(cells).all(|(column, cell)| column.format.takes(cell));
            assert!(fits, "a row of `{table}` does not fit its columns: {cells:?}");
            assert!(has(record, cells, key), "a row of `{table}` is not one of {key:?}: {cells:?}");
        }
        let at = there.iter().position(|cells| has(record, cells, key)).unwrap_or(there.len());
        there.retain(|cells| !has(record, cells, key));
        there.splice(at..at, rows);
        write_table(self.folder.path(), record, there)
    }

    /// Adds a note about all of the study, once however often it is begun.
    ///
    /// # Errors
    /// A record that cannot be written.
    pub(crate) fn note(&mut self, note: String) -> Result<()> {
        if self.study.record.notes.contains(&note) {
            return Ok(());
        }
        self.study.record.notes.push(note);
        write(self.folder.path(), &self.study.record)
    }

    /// Notes a picture; gives the file that it is to be written to, `None` where that is there.
    ///
    /// # Errors
    /// A record that cannot be written.
    pub(crate) fn picture(&mut self, file: &str, title: String) -> Result<Option<PathBuf>> {
        let pictures = &mut self.study.record.pictures;
        if !pictures.iter().any(|picture| picture.file == file) {
            pictures.push(PictureRecord { file: file.to_owned(), title });
            write(self.folder.path(), &self.study.record)?;
        }
        let path = self.folder.path().join(file);
        Ok((!path.exists()).then_some(path))
    }

    /// A table and its rows so far.
    ///
    /// # Panics
    ///
    /// If there is no such table.
    pub(crate) fn table(&self, name: &str) -> (&TableRecord, &[Cells]) {
        let at = self.place(name);
        (&self.study.record.tables[at], &self.study.rows[at])
    }

    fn place(&self, table: &str) -> usize {
        self.study.record.tables.iter().position(|t| t.name == table).expect("a study names its own tables")
    }

    /// Ends the study, which took `wall_s` seconds; one that has ended before stays as it is.
    ///
    /// `derive` writes what follows from a study into its folder: what says that it is finished is written after that.
    ///
    /// # Errors
    /// An error of `derive`; a record that cannot be written.
    pub(crate) fn finish(mut self, wall_s: f64, derive: impl FnOnce(&Path, &Study) -> Result<()>) -> Result<Study> {
        let finished = self.study.record.finished;
        if !finished {
            (self.study.record.finished, self.study.record.wall_s) = (true, wall_s);
        }
        derive(self.folder.path(), &self.study)?;
        if !finished {
            write(self.folder.path(), &self.study.record)?;
        }
        Ok(self.study)
    }
}

/// Columns and their cells, by which rows that were measured together are told from others; all rows where there are none.
pub(crate) type Key<'a> = &'a [(&'a str, Cell)];

/// Whether a row has the cells of `key`.
fn has(table: &TableRecord, cells: &Cells, key: Key<'_>) -> bool {
    key.iter().all(|(column, cell)| cells[table.column(column).expect("a study names its own columns")] == *cell)
}

/// Whether `folder` holds a study.
pub(crate) fn is_study(folder: &Path) -> bool {
    folder.join(STUDY_FILE).exists()
}

/// Reads the study in `folder`. A last line of a table without its line break is an interrupted write and left out, and
/// a table of an unfinished study may not be there yet.
///
/// # Errors
/// A file that cannot be read; a record of another schema, or with a mistake, with its line; anything else that is not
/// a row, with file, line and column.
pub(crate) fn read_study(folder: &Path) -> Result<Study> {
    let record: StudyRecord = store::read_record(&folder.join(STUDY_FILE), STUDY_SCHEMA)?;
    let read = |table| read_table(&table_file(folder, table), table, record.finished);
    let rows = record.tables.iter().map(read).collect::<Result<_>>()?;
    Ok(Study { record, rows })
}

fn write(folder: &Path, record: &StudyRecord) -> Result<()> {
    store::write_record(&folder.join(STUDY_FILE), record)
}

fn table_file(folder: &Path, table: &TableRecord) -> PathBuf {
    folder.join(format!("{}.csv", file_name(&table.name)))
}

fn write_table(folder: &Path, table: &TableRecord, rows: &[Cells]) -> Result<()> {
    let path = table_file(folder, table);
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    let mut text = line(&names).map_err(Error::io("write", &path))?;
    for cells in rows {
        let fields: Vec<String> = cells.iter().map(field).collect();
        text.extend(line(&fields).map_err(Error::io("write", &path))?);
    }
    write_whole(&path, &text)
}

fn read_table(path: &Path, table: &TableRecord, finished: bool) -> Result<Vec<Cells>> {
    let text = match fs::read_to_string(path) {
        Err(e) if e.kind() == ErrorKind::NotFound && !finished => return Ok(Vec::new()),
        read => read.map_err(Error::io("read", path))?,
    };
    let whole = &text[..store::finished_bytes(&text)];
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(whole.as_bytes());
    let mut rows = Vec::new();
    for (at, record) in reader.records().enumerate() {
        let line = Some(at + 1);
        let record = record.map_err(|e| input(path, line, "", e.to_string()))?;
        if record.len() != table.columns.len() {
            let (given, expected) = (record.len(), table.columns.len());
            return Err(input(path, line, "", format!("{given} fields where {expected} are expected")));
        }
        let columns = table.columns.iter().zip(&record);
        if at == 0 {
            if let Some((column, given)) = columns.clone().find(|(column, given)| column.name != *given) {
                let text = format!("column `{given}` stands where {STUDY_FILE} has `{}`", column.name);
                return Err(input(path, line, "", text));
            }
            continue;
        }
        let cells = columns.map(|(column, given)| {
            let refuse = |what| input(path, line, &column.name, format!("`{given}` is not {what}"));
            parse(column.format, given).map_err(refuse)
        });
        rows.push(cells.collect::<Result<_>>()?);
    }
    Ok(rows)
}

/// A cell as it stands in the file.
fn field(cell: &Cell) -> String {
    match cell {
        Cell::Missing => String::new(),
        Cell::Text(text) => text.clone(),
        Cell::Whole(count) => count.to_string(),
        // `{:?}` is the shortest text that reads back as the same number.
        Cell::Number(number) => format!("{number:?}"),
    }
}

/// The cell that a field says, or what it should have been.
fn parse(format: Format, field: &str) -> std::result::Result<Cell, &'static str> {
    if field.is_empty() {
        Ok(Cell::Missing)
    } else if format.is_text() {
        Ok(field.into())
    } else if format.is_whole() {
        field.parse().map(Cell::Whole).map_err(|_| "a whole number")
    } else {
        field.parse().map(Cell::Number).map_err(|_| "a number")
    }
}
