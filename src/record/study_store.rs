//! Where studies lie: a folder with `study.json` and a CSV file a table, whose rows are there as soon as they are
//! known.

use super::store::{self, input, line};
use super::study::{Cell, Cells, Format, PictureRecord, STUDY_SCHEMA, Study, StudyRecord, TableRecord};
use crate::base::error::{Error, Result};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The file of a [`StudyRecord`] in its folder.
pub const STUDY_FILE: &str = "study.json";

/// A study being made: rows are appended to its files one by one, so that an interruption loses none.
pub struct StudyWriter {
    folder: PathBuf,
    study: Study,
}

impl StudyWriter {
    /// Begins a study in `folder`, which must hold none yet.
    pub fn create(folder: &Path, record: StudyRecord) -> Result<Self> {
        if folder.join(STUDY_FILE).exists() {
            let folder = folder.display();
            let text = format!("{folder} holds a study; results are never overwritten: name another folder");
            return Err(Error::Invalid(text));
        }
        for table in &record.tables {
            let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
            append(&table_file(folder, table), &names, true)?;
        }
        write(folder, &record)?;
        let rows = vec![Vec::new(); record.tables.len()];
        Ok(Self { folder: folder.to_owned(), study: Study { record, rows } })
    }

    /// Adds a row to the table of that name; it is in its file when this returns.
    ///
    /// # Panics
    ///
    /// If there is no such table or the cells are not those of its columns: a mistake in a study's own code.
    pub fn row(&mut self, table: &str, cells: Cells) -> Result<()> {
        let at = self.place(table);
        let columns = &self.study.record.tables[at].columns;
        let fits = cells.len() == columns.len() && columns.iter().zip(&cells).all(|(c, cell)| c.format.takes(cell));
        assert!(fits, "a row of `{table}` does not fit its columns: {cells:?}");
        let fields: Vec<String> = cells.iter().map(field).collect();
        append(&table_file(&self.folder, &self.study.record.tables[at]), &fields, false)?;
        self.study.rows[at].push(cells);
        Ok(())
    }

    /// Adds a note about all of the study.
    pub fn note(&mut self, note: String) {
        self.study.record.notes.push(note);
    }

    /// Notes a picture; gives the file that it is to be written to.
    pub fn picture(&mut self, file: &str, title: String) -> PathBuf {
        self.study.record.pictures.push(PictureRecord { file: file.to_owned(), title });
        self.folder.join(file)
    }

    /// A table and its rows so far.
    ///
    /// # Panics
    ///
    /// If there is no such table: a mistake in a study's own code.
    pub fn table(&self, name: &str) -> (&TableRecord, &[Cells]) {
        let at = self.place(name);
        (&self.study.record.tables[at], &self.study.rows[at])
    }

    fn place(&self, table: &str) -> usize {
        self.study.record.tables.iter().position(|t| t.name == table).expect("a study names its own tables")
    }

    /// Ends the study, which took `wall_s` seconds.
    pub fn finish(mut self, wall_s: f64) -> Result<Study> {
        (self.study.record.finished, self.study.record.wall_s) = (true, wall_s);
        write(&self.folder, &self.study.record)?;
        Ok(self.study)
    }
}

/// Whether `folder` holds a study.
pub fn is_study(folder: &Path) -> bool {
    folder.join(STUDY_FILE).exists()
}

/// Reads the study in `folder`. A last line of a table without its line break is an interrupted write and left out;
/// anything else that is not a row is an error that names file, line and column.
pub fn read_study(folder: &Path) -> Result<Study> {
    let record: StudyRecord = store::read_record(&folder.join(STUDY_FILE), STUDY_SCHEMA)?;
    let rows =
        record.tables.iter().map(|table| read_table(&table_file(folder, table), table)).collect::<Result<_>>()?;
    Ok(Study { record, rows })
}

fn write(folder: &Path, record: &StudyRecord) -> Result<()> {
    store::write_record(&folder.join(STUDY_FILE), record)
}

fn table_file(folder: &Path, table: &TableRecord) -> PathBuf {
    folder.join(format!("{}.csv", store::file_name(&table.name)))
}

fn append<T: AsRef<[u8]>>(path: &Path, fields: &[T], new: bool) -> Result<()> {
    let mut file = OpenOptions::new().append(true).create_new(new).open(path).map_err(Error::io("write", path))?;
    line(fields).and_then(|line| file.write_all(&line)).map_err(Error::io("write", path))
}

fn read_table(path: &Path, table: &TableRecord) -> Result<Vec<Cells>> {
    let text = fs::read_to_string(path).map_err(Error::io("read", path))?;
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
