//! What an export comes to: files that are not yet on disk, and what they cannot say.

use crate::base::error::{Error, Result};
use crate::base::file::write_together;
use std::path::PathBuf;

/// Samples a pixel that files with a sampler ask for.
pub(super) const SAMPLES: u32 = 64;

/// A scene in the words of another renderer, not yet on disk.
#[derive(Clone, Debug)]
pub(crate) struct Export {
    /// Every file with its bytes, the one that names the others last.
    pub files: Vec<(PathBuf, Vec<u8>)>,
    /// What the format cannot say, with figures.
    pub notes: Vec<String>,
}

impl Export {
    /// Writes all files; none that was there is replaced before all are on disk, and the one that names the others is
    /// replaced last.
    ///
    /// # Errors
    /// A folder that cannot be made; a file that cannot be written.
    pub(crate) fn write(&self) -> Result<()> {
        if let Some(folder) = self.files.first().and_then(|(path, _)| path.parent())
            && self.files.len() > 1
        {
            std::fs::create_dir_all(folder).map_err(Error::io("make the folder", folder))?;
        }
        write_together(&self.files)
    }
}
