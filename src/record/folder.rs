//! Which folders hold results, and who writes in one?
//!
//! A result folder bears a mark, the file [`MARK`], from before anything else is in it. Files are written, replaced and
//! removed in marked folders alone; one without a mark that is not empty is somebody's own, and is refused. The mark is
//! also the lock: whoever writes holds the operating system's lock on it, which ends with the process however that ends.

use super::files::{RUN_FILE, STUDY_FILE, file_name, input};
use crate::base::error::{Error, Result};
use crate::base::file::{remove_partials, sync_folder_of};
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// The file that marks a result folder.
pub(crate) const MARK: &str = ".citylights";

/// Version of the mark; a folder of another is refused.
const MARK_SCHEMA: u32 = 1;

/// What a folder is marked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    /// A comparison.
    Comparison,
    /// A study.
    Study,
    /// What is needed for a while, and then removed with all that is in it.
    Scratch,
}

/// What stands in the mark.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Mark {
    schema: u32,
    kind: Kind,
}

/// A marked folder that nobody else writes in for as long as this lives.
#[derive(Debug)]
pub(crate) struct ResultFolder {
    path: PathBuf,
    /// Open, and locked.
    mark: File,
}

impl ResultFolder {
    /// Opens a folder of results of `kind`; one that is not there or empty is made and marked.
    ///
    /// # Errors
    /// A folder that is somebody's own, holds other results or is in use, of which nothing is touched; one that cannot
    /// be made, read or written.
    pub(crate) fn open(path: &Path, kind: Kind) -> Result<Self> {
        fs::create_dir_all(path).map_err(Error::io("create", path))?;
        if !is_marked(path) && !is_empty(path)? {
            return Err(foreign(path));
        }
        let mut folder = Self::locked(path)?;
        match folder.kind()? {
            Some(own) if own == kind => {}
            Some(own) => {
                let text = format!(
                    "{} is marked as a {}, not as a {}: name another folder",
                    path.display(),
                    own.name(),
                    kind.name()
                );
                return Err(Error::Invalid(text));
            }
            None => folder.write_mark(kind)?,
        }
        remove_partials(path)?;
        Ok(folder)
    }

    /// Makes `<results>/<date>-<what>-<short revision>/` and opens it; where it exists, `-2`, `-3` ... is appended.
    ///
    /// `what` is the scene's or study's name; the revision is shortened to its first 7 characters.
    ///
    /// # Errors
    /// A folder that cannot be made or marked.
    pub(crate) fn create(results: &Path, date: &str, what: &str, revision: &str, kind: Kind) -> Result<Self> {
        fs::create_dir_all(results).map_err(Error::io("create", results))?;
        let short: String = revision.chars().take(7).collect();
        let name = file_name(&format!("{date}-{what}-{short}"));
        let mut folder = results.join(&name);
        for next in 2.. {
            match fs::create_dir(&folder) {
                Err(e) if e.kind() == ErrorKind::AlreadyExists => folder = results.join(format!("{name}-{next}")),
                made => {
                    made.map_err(Error::io("create", &folder))?;
                    return Self::open(&folder, kind);
                }
            }
        }
        unreachable!("the numbers do not end");
    }

    /// Refuses what [`open`](Self::open) would refuse, and makes nothing: to be asked before anything is computed.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub(crate) fn check(path: &Path, kind: Kind) -> Result<()> {
        if path.exists() && !is_empty(path)? { Self::open(path, kind).map(drop) } else { Ok(()) }
    }

    /// Keeps others from writing in `path` while this lives, whatever it holds; `None` where it is not marked, as older
    /// results are.
    ///
    /// # Errors
    /// A folder that is in use by another process; a mark that cannot be opened or locked.
    pub(crate) fn hold(path: &Path) -> Result<Option<Self>> {
        if is_marked(path) { Self::locked(path).map(Some) } else { Ok(None) }
    }

    /// Where it lies.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the folder and all in it, the mark last: what is left by one who dies meanwhile is still marked.
    ///
    /// # Errors
    /// What cannot be read or removed.
    pub(crate) fn remove(&self) -> std::io::Result<()> {
        for entry in fs::read_dir(&self.path)? {
            let entry = entry?;
            if entry.file_name() == MARK {
                continue;
            }
            if entry.file_type()?.is_dir() { fs::remove_dir_all(entry.path())? } else { fs::remove_file(entry.path())? }
        }
        fs::remove_file(self.path.join(MARK))?;
        fs::remove_dir(&self.path)
    }

    fn locked(path: &Path) -> Result<Self> {
        let file = path.join(MARK);
        let mark = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&file);
        let mark = mark.map_err(Error::io("open", &file))?;
        match mark.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), mark }),
            Err(TryLockError::WouldBlock) => {
                let folder = path.display();
                let text = format!("{folder} is in use by another process: wait for its end, or name another folder");
                Err(Error::Invalid(text))
            }
            Err(TryLockError::Error(error)) => Err(Error::io("lock", &file)(error)),
        }
    }

    /// What the mark says; `None` of one just made, by this process or by one that died at once.
    fn kind(&mut self) -> Result<Option<Kind>> {
        let file = self.path.join(MARK);
        let mut text = String::new();
        self.mark.read_to_string(&mut text).map_err(Error::io("read", &file))?;
        match serde_json::from_str::<Mark>(&text) {
            Ok(mark) if mark.schema == MARK_SCHEMA => Ok(Some(mark.kind)),
            Ok(mark) => {
                let text = format!("is {}, this program knows {MARK_SCHEMA}: name another folder", mark.schema);
                Err(input(&file, None, "schema", text))
            }
            // Nothing else is written before it.
            Err(_) if is_empty(&self.path)? => Ok(None),
            Err(_) => Err(foreign(&self.path)),
        }
    }

    fn write_mark(&mut self, kind: Kind) -> Result<()> {
        let file = self.path.join(MARK);
        let text = serde_json::to_string(&Mark { schema: MARK_SCHEMA, kind }).expect("two plain fields");
        let written = self.mark.rewind().and_then(|()| self.mark.set_len(0));
        let written = written.and_then(|()| self.mark.write_all(format!("{text}\n").as_bytes()));
        written.and_then(|()| self.mark.sync_all()).map_err(Error::io("write", &file))?;
        sync_folder_of(&file);
        Ok(())
    }
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Comparison => "comparison",
            Self::Study => "study",
            Self::Scratch => "scratch folder",
        }
    }
}

/// Whether a folder bears a mark.
fn is_marked(path: &Path) -> bool {
    path.join(MARK).is_file()
}

/// Whether there is nothing in a folder but a mark.
fn is_empty(path: &Path) -> Result<bool> {
    let mut entries = fs::read_dir(path).map_err(Error::io("read", path))?;
    Ok(entries.all(|entry| entry.is_ok_and(|entry| entry.file_name() == MARK)))
}

fn foreign(path: &Path) -> Error {
    let folder = path.display();
    let results = [RUN_FILE, STUDY_FILE].iter().any(|name| path.join(name).exists());
    let why = if results {
        "holds results of an earlier version, which are read but not gone on with"
    } else {
        "is not empty and holds no results"
    };
    Error::Invalid(format!(
        "{folder} {why} (it has no file `{MARK}`): nothing was touched; name a new or an empty folder"
    ))
}
