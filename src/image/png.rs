//! Linear light to 8 bits that a screen shows.

use super::Picture;
use crate::base::colour::srgb_encode;
use crate::base::error::{Error, Result};
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder};

/// What a pixel that is not finite becomes: a colour that no lamp has.
const MAGENTA: [u8; 3] = [255, 0, 255];

/// The bytes of a PNG file: `exposure` times the picture, clamped to `[0, 1]`, through the sRGB curve, rounded to 8
/// bits.
///
/// A pixel with a component that is NaN or infinite becomes magenta. The same picture gives the same bytes.
pub fn encode(picture: &Picture, exposure: f32) -> Result<Vec<u8>> {
    picture.check()?;
    let texels: Vec<u8> = picture.pixels.iter().flat_map(|pixel| texel(*pixel, exposure)).collect();
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(&texels, picture.width, picture.height, ExtendedColorType::Rgb8)
        .map_err(|e| Error::Invalid(format!("cannot encode the picture as PNG: {e}")))?;
    Ok(bytes)
}

/// One pixel in 8 bits.
fn texel(pixel: [f32; 3], exposure: f32) -> [u8; 3] {
    if pixel.iter().all(|c| c.is_finite()) {
        pixel.map(|c| (255.0 * srgb_encode(exposure * c) + 0.5) as u8)
    } else {
        MAGENTA
    }
}
