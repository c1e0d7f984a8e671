//! Which file format does a name ask for?

use crate::base::error::{Error, Result};
use std::path::Path;

/// The formats that pictures are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// For the eye: exposed, through the sRGB curve, 8 bits.
    Png,
    /// For numbers: linear, 32-bit floats.
    Exr,
}

impl Format {
    /// The format that the extension of `path` names; a caller asks before the work, not after it.
    ///
    /// # Errors
    /// An extension that is neither `.png` nor `.exr`, or none at all.
    pub fn of(path: &Path) -> Result<Self> {
        match path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase().as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            _ => Err(Error::Invalid(format!("cannot tell the format of `{}`: use .png or .exr", path.display()))),
        }
    }
}
