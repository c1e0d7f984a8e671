//! What is a picture?

use crate::base::error::{Error, Result};

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
    pub(super) fn check(&self) -> Result<()> {
        let (width, height, pixels) = (self.width, self.height, self.pixels.len());
        if pixels == 0 || pixels as u64 != u64::from(width) * u64::from(height) {
            return Err(Error::Invalid(format!("a picture of {width} x {height} cannot have {pixels} pixels")));
        }
        Ok(())
    }
}
