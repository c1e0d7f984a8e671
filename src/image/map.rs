//! A map of errors for the eye: dark violet is none, pale yellow is most.

use super::format::Format;
use super::picture::Picture;
use super::{exr, png};
use crate::base::error::Result;
use crate::base::file::write_whole;
use std::path::Path;

/// The colour map magma at 31 even steps, joined by straight lines: within 0.7/255 of its 256 colours.
///
/// Source: Smith and van der Walt, "A Better Default Colormap for Matplotlib", SciPy 2015; the map is in the public
/// domain (CC0). FLIP's authors show their maps in it.
const MAGMA: [u32; 31] = [
    0x00_0003, 0x03_0312, 0x0b_0924, 0x15_0e37, 0x1f_114b, 0x2c_1160, 0x3b_0f70, 0x4a_1079, 0x57_147e, 0x64_1a80,
    0x72_1f81, 0x7f_2482, 0x8c_2981, 0x9a_2e80, 0xa8_327d, 0xb6_367a, 0xc4_3c75, 0xd1_426f, 0xde_4968, 0xe9_5362,
    0xf1_605d, 0xf7_6f5b, 0xfa_7f5e, 0xfc_8f64, 0xfe_9f6d, 0xfe_af78, 0xfe_bf84, 0xfe_ce91, 0xfd_dea0, 0xfc_edaf,
    0xfc_fdbf,
];

/// A pixel that is left out: a grey, which magma has not.
const LEFT_OUT: [u8; 3] = [128; 3];

/// How values become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// From 0 to 1.
    Unit,
    /// By the logarithm, from the first value to the second, both above 0; beyond them the ends.
    Decades(f64, f64),
}

/// A value for each pixel of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Map<'a> {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top, `width * height` of them.
    pub values: &'a [f64],
    /// Whether each pixel counts; as many.
    pub counted: &'a [bool],
    /// How the values become colours.
    pub scale: Scale,
}

impl Scale {
    /// Where a value lies, 0 to 1.
    fn place(self, value: f64) -> f64 {
        match self {
            Self::Unit => value.clamp(0.0, 1.0),
            Self::Decades(low, high) => ((value / low).ln() / (high / low).ln()).clamp(0.0, 1.0),
        }
    }
}

impl Map<'_> {
    /// Writes the map whole or not at all: colours to a PNG (grey where a pixel is left out), the values themselves to
    /// the three channels of an EXR (NaN there).
    ///
    /// # Errors
    /// An extension that is neither `.png` nor `.exr`; a map without pixels; a file that cannot be written.
    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        let pixels = self.values.iter().zip(self.counted);
        let bytes = match Format::of(path)? {
            Format::Png => {
                let texel = |(&value, &counted): (&f64, &bool)| {
                    if counted { magma(self.scale.place(value)) } else { LEFT_OUT }
                };
                png::encode_texels(self.width, self.height, &pixels.map(texel).collect::<Vec<_>>())?
            }
            Format::Exr => {
                let grey = |(&value, &counted): (&f64, &bool)| [if counted { value as f32 } else { f32::NAN }; 3];
                exr::encode(&Picture { width: self.width, height: self.height, pixels: pixels.map(grey).collect() })?
            }
        };
        write_whole(path, &bytes)
    }
}

/// The colour at `t`, 0 to 1, as 8-bit sRGB.
pub(crate) fn magma(t: f64) -> [u8; 3] {
    let place = t.clamp(0.0, 1.0) * (MAGMA.len() - 1) as f64;
    let below = (place as usize).min(MAGMA.len() - 2);
    let share = place - below as f64;
    let channel = |step: usize, shift: u32| f64::from(MAGMA[step] >> shift & 0xff);
    [16, 8, 0].map(|shift| (channel(below, shift) * (1.0 - share) + channel(below + 1, shift) * share + 0.5) as u8)
}
