//! Pictures: what one is, which file format a name asks for, and how far two are apart.
//!
//! PNG is for the eye (exposure and the sRGB curve, 8 bits), EXR for numbers (linear, 32-bit floats, no exposure).

pub mod exr;
pub mod flip;
pub mod map;
pub mod metrics;
pub mod png;

use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use std::path::Path;

/// A picture with more pixels than this is not read: 8,192 x 8,192, which is 800 MB.
pub const MOST_PIXELS: usize = 1 << 26;

/// A picture in linear Rec. 709, in any unit (the renderer uses cd/m^2).
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top, `width * height` of them.
    pub pixels: Vec<[f32; 3]>,
}

impl Picture {
    /// How many pixels have a component that is NaN or infinite.
    pub fn not_finite(&self) -> usize {
        self.pixels.iter().filter(|p| !p.iter().all(|c| c.is_finite())).count()
    }

    /// Whether the sides are positive and the pixels as many as they say.
    fn check(&self) -> Result<()> {
        let (width, height, pixels) = (self.width, self.height, self.pixels.len());
        if pixels == 0 || pixels as u64 != u64::from(width) * u64::from(height) {
            return Err(Error::Invalid(format!("a picture of {width} x {height} cannot have {pixels} pixels")));
        }
        Ok(())
    }
}

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
    pub fn of(path: &Path) -> Result<Self> {
        match path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase().as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            _ => Err(Error::Invalid(format!("cannot tell the format of `{}`: use .png or .exr", path.display()))),
        }
    }
}

/// Reads a picture in the format that the extension of `path` names.
///
/// EXR gives its numbers as they are, PNG its displayed values, `[0, 1]`, with the sRGB curve undone.
pub fn read(path: &Path) -> Result<Picture> {
    match Format::of(path)? {
        Format::Png => png::read(path),
        Format::Exr => exr::read(path),
    }
}

/// Writes `picture` in the format that the extension of `path` names, whole or not at all.
///
/// `exposure` (display units per unit of the picture) is for PNG alone: EXR keeps the numbers as they are. Gives the
/// number of pixels that are not finite: magenta in a PNG, kept in an EXR.
pub fn write(path: &Path, picture: &Picture, exposure: f32) -> Result<usize> {
    let bytes = match Format::of(path)? {
        Format::Png => png::encode(picture, exposure)?,
        Format::Exr => exr::encode(picture)?,
    };
    write_whole(path, &bytes)?;
    Ok(picture.not_finite())
}
