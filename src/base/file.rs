//! Files that are there whole or not at all.

use crate::base::error::{Error, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// Writes `bytes` to `path`, replacing what was there.
///
/// The bytes go to a hidden file in the same folder first, which then takes the name: a reader, or a run that dies
/// half-way, never sees a part. Errors name `path`.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_together(&[(path.to_owned(), bytes)])
}

/// Writes files that belong together, replacing what was there: none takes its name before all are on disk.
///
/// The last one should be the one that names the others.
pub fn write_together(files: &[(PathBuf, impl AsRef<[u8]>)]) -> Result<()> {
    let mut partials = Vec::new();
    let written = files.iter().try_for_each(|(path, bytes)| {
        let partial = partial(path)?;
        partials.push((partial.clone(), path));
        fs::write(partial, bytes).map_err(Error::io("write", path))
    });
    let done = written.and_then(|()| {
        partials.iter().try_for_each(|(partial, path)| fs::rename(partial, path).map_err(Error::io("write", *path)))
    });
    if done.is_err() {
        for (partial, _) in partials {
            // It may never have come to be, or have its name already; the first error is the one to tell.
            let _ = fs::remove_file(partial);
        }
    }
    done
}

/// The hidden file that becomes `path`.
fn partial(path: &Path) -> Result<PathBuf> {
    let Some(name) = path.file_name() else {
        return Err(Error::Invalid(format!("cannot write `{}`: it names no file", path.display())));
    };
    // The process number keeps two runs that write the same file apart.
    Ok(path.with_file_name(format!(".{}.{}.part", name.to_string_lossy(), std::process::id())))
}
