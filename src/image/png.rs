//! Linear light to 8 bits that a screen shows, and back.

use super::bound::Bound;
use super::picture::Picture;
use crate::base::colour::{srgb_decode, srgb_encode};
use crate::base::error::{Error, Result};
use ::image::codecs::png::{PngDecoder, PngEncoder};
use ::image::{DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, Limits};
use std::fmt::Display;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// What a pixel that is not finite becomes: a colour that no lamp has.
const MAGENTA: [u8; 3] = [255, 0, 255];

/// The bytes of a PNG file: `exposure` times the picture, clamped to `[0, 1]`, through the sRGB curve, rounded to 8
/// bits.
///
/// A pixel with a component that is NaN or infinite becomes magenta. The same picture gives the same bytes.
///
/// # Errors
/// A picture without pixels, or with another number of them than its sides say.
pub(crate) fn encode(picture: &Picture, exposure: f32) -> Result<Vec<u8>> {
    picture.check()?;
    encode_texels(picture.width, picture.height, &texels(&picture.pixels, exposure))
}

/// Pixels as [`encode`] shows them.
pub(crate) fn texels(pixels: &[[f32; 3]], exposure: f32) -> Vec<[u8; 3]> {
    pixels.iter().map(|pixel| texel(*pixel, exposure)).collect()
}

/// The bytes of a PNG file of these 8-bit sRGB colours, row by row from the top.
///
/// # Errors
/// A picture without pixels.
pub(crate) fn encode_texels(width: u32, height: u32, texels: &[[u8; 3]]) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(texels.as_flattened(), width, height, ExtendedColorType::Rgb8)
        .map_err(|e| Error::Invalid(format!("cannot encode the picture as PNG: {e}")))?;
    Ok(bytes)
}

/// Reads a PNG file of 8 or 16 bits, in colour or grey, as linear values in `[0, 1]`; it is taken to be sRGB, and its
/// opacity is ignored.
///
/// # Errors
/// A file that cannot be opened is [`Error::Io`]; one that is damaged or has more pixels than are asked for, or without
/// that than its size [suggests](Bound), is [`Error::Input`].
pub(crate) fn read(path: &Path, pixels: Option<usize>) -> Result<Picture> {
    let file = File::open(path).map_err(Error::io("read", path))?;
    let bound = Bound::of(&file, path, pixels)?;
    let mut limits = Limits::default();
    // 16 bits in four channels.
    limits.max_alloc = Some(8 * bound.pixels as u64);
    let decoder = PngDecoder::with_limits(BufReader::new(file), limits).map_err(|e| unreadable(path, e))?;
    let (width, height) = decoder.dimensions();
    bound.area(width.into(), height.into()).map_err(|e| unreadable(path, e))?;
    let image = DynamicImage::from_decoder(decoder).map_err(|e| unreadable(path, e))?;
    let linear = |code: u16| srgb_decode(f32::from(code) / f32::from(u16::MAX));
    let pixels = image.into_rgb16().pixels().map(|texel| texel.0.map(linear)).collect();
    Ok(Picture { width, height, pixels })
}

fn unreadable(path: &Path, why: impl Display) -> Error {
    Error::Input {
        file: path.to_owned(),
        line: None,
        field: String::new(),
        message: format!("not a PNG picture that can be read: {why}"),
    }
}

/// One pixel in 8 bits.
fn texel(pixel: [f32; 3], exposure: f32) -> [u8; 3] {
    if pixel.iter().all(|c| c.is_finite()) {
        pixel.map(|c| (255.0 * srgb_encode(exposure * c) + 0.5) as u8)
    } else {
        MAGENTA
    }
}
