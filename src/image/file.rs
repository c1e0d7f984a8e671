//! A picture in a file: read and written in the format that the file's name asks for.

use super::format::Format;
use super::picture::Picture;
use super::{exr, png};
use crate::base::error::Result;
use crate::base::file::write_whole;
use std::path::Path;

/// Reads a picture in the format that the extension of `path` names.
///
/// EXR gives its numbers as they are, PNG its displayed values, `[0, 1]`, with the sRGB curve undone.
///
/// # Errors
/// An extension that is neither `.png` nor `.exr`; a file that cannot be opened, is damaged or too large: a small file may
/// have 2^23 pixels, a larger one 64 a byte, up to [`MOST_PIXELS`](super::MOST_PIXELS).
pub fn read(path: &Path) -> Result<Picture> {
    read_within(path, None)
}

/// The same with as many pixels at most as are asked for, whatever the file's size.
///
/// # Errors
/// As [`read`].
pub(crate) fn read_within(path: &Path, pixels: Option<usize>) -> Result<Picture> {
    match Format::of(path)? {
        Format::Png => png::read(path, pixels),
        Format::Exr => exr::read(path, pixels),
    }
}

/// Writes `picture` in the format that the extension of `path` names, whole or not at all.
///
/// `exposure` (display units per unit of the picture) is for PNG alone: EXR keeps the numbers as they are. Gives the
/// number of pixels that are not finite: magenta in a PNG, kept in an EXR.
///
/// # Errors
/// An extension that is neither `.png` nor `.exr`; a picture without pixels, or with another number of them than its
/// sides say; a file that cannot be written.
pub fn write(path: &Path, picture: &Picture, exposure: f32) -> Result<usize> {
    let bytes = match Format::of(path)? {
        Format::Png => png::encode(picture, exposure)?,
        Format::Exr => exr::encode(picture)?,
    };
    write_whole(path, &bytes)?;
    Ok(picture.not_finite())
}
