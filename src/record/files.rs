//! The files of a result folder: how they are named, and how an error says what is wrong in one.

use crate::base::error::Error;
use std::path::Path;

/// The file of a [`RunRecord`](super::run::RunRecord) in its folder.
pub(crate) const RUN_FILE: &str = "run.json";
/// The file of the [`Row`](super::row::Row)s in their folder.
pub(crate) const ROWS_FILE: &str = "runs.csv";
/// The file of a [`StudyRecord`](super::study::StudyRecord) in its folder.
pub(crate) const STUDY_FILE: &str = "study.json";

/// `name` with everything but ASCII letters, digits, `.`, `_` and `-` replaced by `-`, safe to name a file with.
pub(crate) fn file_name(name: &str) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '-' };
    name.chars().map(kept).collect()
}

/// What is wrong in a file, at this line and in this field.
pub(super) fn input(path: &Path, line: Option<usize>, field: &str, message: String) -> Error {
    Error::Input { file: path.to_owned(), line, field: field.to_owned(), message }
}
