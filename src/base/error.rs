//! The library's one error type: what was tried, where, and what would be right.

use super::names;
use std::path::PathBuf;

/// Everything that can go wrong because of what a user gave or where it runs.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file says something that cannot be used.
    #[error("{}{}: {}{message}", .file.display(), line_suffix(*.line), field_prefix(.field))]
    Input {
        /// The file, as the user named it.
        file: PathBuf,
        /// Line in the file, from 1, where it is known.
        line: Option<usize>,
        /// The field's path, `camera.position`; empty where none is meant.
        field: String,
        /// What is wrong and what would be right.
        message: String,
    },
    /// A name that nothing bears.
    #[error("unknown {what} `{name}`{}", names::told(.near, .known))]
    Unknown {
        /// The kind of thing that was named: `strategy`, `scene`.
        what: &'static str,
        /// The name as given.
        name: String,
        /// The names that come near, nearest first; empty where none does.
        near: Vec<String>,
        /// All the names there are, which are told where none comes near.
        known: Vec<String>,
    },
    /// A parameter outside its range or of the wrong type.
    #[error("{owner}: parameter `{name}` is `{value}`: {expected}")]
    Parameter {
        /// Whose parameter it is.
        owner: String,
        /// The parameter.
        name: String,
        /// The value as given.
        value: String,
        /// What would be right.
        expected: String,
    },
    /// The operating system refused.
    #[error("cannot {doing} {}: {source}", .path.display())]
    Io {
        /// What was tried: `write`, `read`.
        doing: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Anything else that the user can mend; the text says how.
    #[error("{0}")]
    Invalid(String),
    /// The user asked to stop; what was finished has been kept.
    #[error("interrupted; what was finished is kept")]
    Interrupted,
}

/// The library's result.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An [`Error::Unknown`]: `name` is none of `known`.
    pub(crate) fn unknown<'a>(
        what: &'static str,
        name: impl Into<String>,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let (name, known): (String, Vec<&str>) = (name.into(), known.into_iter().collect());
        let near = names::near(&name, known.iter().copied());
        Self::Unknown { what, name, near, known: known.into_iter().map(str::to_owned).collect() }
    }

    /// An [`Error::Io`] for `path`, to be used with `map_err`.
    pub(crate) fn io(doing: &'static str, path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { doing, path, source }
    }
}

fn line_suffix(line: Option<usize>) -> String {
    line.map_or_else(String::new, |line| format!(":{line}"))
}

fn field_prefix(field: &str) -> String {
    if field.is_empty() { String::new() } else { format!("`{field}`: ") }
}
