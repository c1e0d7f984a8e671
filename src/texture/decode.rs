//! Which texels do the bytes of an image hold?
//!
//! PNG and JPEG, told apart by their first bytes, in 8 bits of sRGB; opacity, profiles of colour and gamma are not used, as
//! glTF has it. An image says how large it is before anything is kept for it.

use ::image::codecs::jpeg::JpegDecoder;
use ::image::codecs::png::PngDecoder;
use ::image::{DynamicImage, ImageDecoder, ImageError, ImageResult, Limits};
use std::io::Cursor;

/// What became of the bytes.
pub(crate) enum Decoded {
    /// Texels across and down, and three codes of 8 bits for each, row by row from the top.
    Picture([u32; 2], Vec<u8>),
    /// Texels across and down, more than were wanted.
    TooLarge([u32; 2]),
    /// Neither PNG nor JPEG.
    Foreign,
    /// PNG or JPEG, but what it says makes no picture.
    Broken(ImageError),
}

/// Decodes an image of at most so many texels.
pub(crate) fn decode(bytes: &[u8], most: u64) -> Decoded {
    let decoded = if bytes.starts_with(b"\x89PNG") {
        png(bytes, most)
    } else if bytes.starts_with(b"\xff\xd8\xff") {
        JpegDecoder::new(Cursor::new(bytes)).and_then(|decoder| texels(decoder, most))
    } else {
        Ok(Decoded::Foreign)
    };
    decoded.unwrap_or_else(Decoded::Broken)
}

fn png(bytes: &[u8], most: u64) -> ImageResult<Decoded> {
    let mut limits = Limits::default();
    // 16 bits in four channels.
    limits.max_alloc = Some(8 * most + (1 << 20));
    texels(PngDecoder::with_limits(Cursor::new(bytes), limits)?, most)
}

fn texels(decoder: impl ImageDecoder, most: u64) -> ImageResult<Decoded> {
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > most {
        return Ok(Decoded::TooLarge([width, height]));
    }
    Ok(Decoded::Picture([width, height], DynamicImage::from_decoder(decoder)?.into_rgb8().into_raw()))
}
