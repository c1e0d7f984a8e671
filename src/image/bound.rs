//! How many pixels may a file have?
//!
//! Memory is taken for as many as its header claims, and a few bytes can claim any number: 65 kB of PNG unpack to 8,192 x
//! 8,192. So a small file may have few.

use super::picture::MOST_PIXELS;
use crate::base::error::{Error, Result};
use std::fs::File;
use std::path::Path;

/// Pixels that any file may have: an ultra-HD screen's, which is 1.2 GB in a comparison of two.
const FREE: usize = 1 << 23;

/// Pixels that a byte of a larger picture may stand for. A mask of few shapes has some tens to a byte; what is packed to
/// take memory has a thousand.
const A_BYTE: u64 = 64;

/// The most pixels that are read of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    pub(super) pixels: usize,
    /// Bytes of the file.
    bytes: u64,
}

impl Bound {
    /// Of an open file: as many as are asked for, or what its size suggests.
    pub(super) fn of(file: &File, path: &Path, asked: Option<usize>) -> Result<Self> {
        let bytes = file.metadata().map_err(Error::io("read", path))?.len();
        let suggested = usize::try_from(bytes.saturating_mul(A_BYTE)).unwrap_or(MOST_PIXELS);
        let pixels = asked.unwrap_or(suggested.max(FREE)).min(MOST_PIXELS);
        Ok(Self { pixels, bytes })
    }

    /// The number of pixels of a window, if it has any and not too many.
    pub(super) fn area(self, width: u64, height: u64) -> std::result::Result<usize, String> {
        let area = width.checked_mul(height).and_then(|area| usize::try_from(area).ok());
        area.filter(|area| (1..=self.pixels).contains(area)).ok_or_else(|| {
            let Self { pixels, bytes } = self;
            format!(
                "{width} x {height} pixels; 1 to {pixels} are read of a file of {bytes} bytes (`diff-image --max-pixels` \
                 takes up to {MOST_PIXELS})"
            )
        })
    }
}
