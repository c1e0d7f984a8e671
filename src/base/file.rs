//! Files that are there whole or not at all.

use crate::base::error::{Error, Result};
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes `bytes` to `path`, replacing what was there.
///
/// The bytes go to a hidden file in the same folder first, which takes the name once it is on disk: a reader, or a run
/// that dies half-way, never sees a part.
///
/// # Errors
/// A path that names no file, or a file that cannot be written; the error names `path`.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_together(&[(path.to_owned(), bytes)])
}

/// Writes files that belong together, replacing what was there: none takes its name before all are on disk.
///
/// The last one should be the one that names the others.
///
/// # Errors
/// A path that names no file, or a file that cannot be written.
pub(crate) fn write_together(files: &[(PathBuf, impl AsRef<[u8]>)]) -> Result<()> {
    let mut partials = Vec::new();
    let written = files.iter().try_for_each(|(path, bytes)| {
        let partial = partial(path)?;
        partials.push((partial.clone(), path));
        let stored = File::create(partial).and_then(|mut file| {
            file.write_all(bytes.as_ref())?;
            file.sync_all()
        });
        stored.map_err(Error::io("write", path))
    });
    let done = written.and_then(|()| {
        partials.iter().try_for_each(|(partial, path)| {
            fs::rename(partial, path).map_err(Error::io("write", *path))?;
            sync_folder_of(path);
            Ok(())
        })
    });
    if done.is_err() {
        for (partial, _) in partials {
            // It may never have come to be, or have its name already; the first error is the one to tell.
            let _ = fs::remove_file(partial);
        }
    }
    done
}

/// Sees to it that the name of a file outlives a loss of power.
pub(crate) fn sync_folder_of(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Not every system can: the file is then there or not, but never a part of it.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

const PARTIAL: &str = ".part";

/// The hidden file that becomes `path`.
fn partial(path: &Path) -> Result<PathBuf> {
    let Some(name) = path.file_name() else {
        return Err(Error::Invalid(format!("cannot write `{}`: it names no file", path.display())));
    };
    // The process number keeps two runs that write the same file apart.
    Ok(path.with_file_name(format!(".{}.{}{PARTIAL}", short(&name.to_string_lossy()), std::process::id())))
}

/// Longest part of a file's name that the hidden file bears, in bytes: systems take 255, and more is added.
const LONGEST: usize = 200;

/// The name, or of a long one its beginning and a hash of all of it.
fn short(name: &str) -> String {
    if name.len() <= LONGEST {
        return name.to_owned();
    }
    let mut hasher = DefaultHasher::new();
    name.hash(&mut hasher);
    format!("{}-{:016x}", &name[..name.floor_char_boundary(LONGEST - 17)], hasher.finish())
}

/// Removes what runs that died half-way through [`write_whole`] left in a folder that nobody else writes in.
///
/// # Errors
/// A folder that cannot be read; a file of theirs that cannot be removed.
pub(crate) fn remove_partials(folder: &Path) -> Result<()> {
    for entry in fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let path = entry.map_err(Error::io("read", folder))?.path();
        if path.file_name().and_then(|name| name.to_str()).is_some_and(is_partial) {
            fs::remove_file(&path).map_err(Error::io("remove", &path))?;
        }
    }
    Ok(())
}

/// Whether a file's name is one of [`partial`]'s.
fn is_partial(name: &str) -> bool {
    let inner = name.strip_prefix('.').and_then(|rest| rest.strip_suffix(PARTIAL));
    let process = inner.and_then(|rest| rest.rsplit_once('.')).filter(|(name, _)| !name.is_empty());
    process.is_some_and(|(_, number)| !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_may_have_the_longest_name_that_there_is() {
        let folder = tempfile::tempdir().expect("a folder");
        // 127 letters of two bytes each, and one of one.
        let names = ["a", "b"].map(|end| folder.path().join(format!("{}{end}", "\u{e9}".repeat(127))));
        write_together(&names.clone().map(|path| (path, b"text"))).expect("written");
        assert!(names.iter().all(|path| path.file_name().is_some_and(|name| name.len() == 255) && path.exists()));
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 2);
        fs::write(partial(&names[0]).expect("a name"), "half").expect("written");
        remove_partials(folder.path()).expect("removed");
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 2);
    }

    #[test]
    fn only_its_own_partial_files_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = |name: &str| folder.path().join(name);
        let own = partial(&file("run.json")).expect("a name");
        let others = ["run.json", ".part", ".1.part", ".run.json.part", ".run.json.x1.part", "run.json.7.part"];
        for path in others.map(file).iter().chain([&own]) {
            fs::write(path, "text").expect("written");
        }
        remove_partials(folder.path()).expect("removed");
        assert!(!own.exists());
        others.iter().for_each(|name| assert!(file(name).exists(), "{name}"));
    }
}
