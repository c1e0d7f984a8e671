//! The files of a result folder: how they are named, and how an error says what is wrong in one.

use crate::base::error::Error;
use std::path::Path;

/// The file of a [`RunRecord`](super::run::RunRecord) in its folder.
pub(crate) const RUN_FILE: &str = "run.json";
/// The file of the [`Row`](super::row::Row)s in their folder.
pub(crate) const ROWS_FILE: &str = "runs.csv";
/// The file of a [`StudyRecord`](super::study::StudyRecord) in its folder.
pub(crate) const STUDY_FILE: &str = "study.json";

/// Longest name from [`file_name`], in bytes: systems take 255, and an extension, a number or what marks a file as
/// unfinished is added.
const LONGEST: usize = 160;

/// Digits of a hash that stand for the rest of a longer name.
const DIGITS: usize = 16;

/// `name` with everything but ASCII letters, digits, `.`, `_` and `-` replaced by `-`, safe to name a file with. Of a
/// long one the beginning is kept, and a hash of all of it.
pub(crate) fn file_name(name: &str) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '-' };
    let mut safe: String = name.chars().map(kept).collect();
    if safe.len() > LONGEST {
        safe.truncate(LONGEST - DIGITS - 1);
        safe.push('-');
        safe.push_str(&blake3::hash(name.as_bytes()).to_hex()[..DIGITS]);
    }
    safe
}

/// What is wrong in a file, at this line and in this field.
pub(super) fn input(path: &Path, line: Option<usize>, field: &str, message: String) -> Error {
    Error::Input { file: path.to_owned(), line, field: field.to_owned(), message }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_is_shortened_and_still_told_from_others() {
        assert_eq!(file_name("light-tree:arity=8, a/b\u{e9}.md"), "light-tree-arity-8--a-b-.md");
        let longest = "x".repeat(LONGEST);
        assert_eq!(file_name(&longest), longest);
        let names = ["a", "b"].map(|end| file_name(&format!("{}{end}", "x".repeat(5_000))));
        assert!(names.iter().all(|name| name.len() == LONGEST && name.starts_with("xxx")), "{names:?}");
        assert_ne!(names[0], names[1]);
    }
}
