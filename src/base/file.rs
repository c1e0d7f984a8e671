//! Files that are there whole or not at all.

use crate::base::error::{Error, Result};
use std::fs;
use std::path::Path;

/// Writes `bytes` to `path`, replacing what was there.
///
/// The bytes go to a hidden file in the same folder first, which then takes the name: a reader, or a run that dies
/// half-way, never sees a part. Errors name `path`.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let Some(name) = path.file_name() else {
        return Err(Error::Invalid(format!("cannot write `{}`: it names no file", path.display())));
    };
    // The process number keeps two runs that write the same file apart.
    let partial = path.with_file_name(format!(".{}.{}.part", name.to_string_lossy(), std::process::id()));
    let done = fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, path));
    if done.is_err() {
        // It may never have come to be; the first error is the one to tell.
        let _ = fs::remove_file(&partial);
    }
    done.map_err(Error::io("write", path))
}
