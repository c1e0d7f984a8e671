//! A picture as an EXR file.

use super::primaries::REC_709;
use crate::base::error::{Error, Result};
use crate::image::picture::Picture;
use ::exr::meta::attribute::Text;
use ::exr::prelude::{Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage};
use std::io::Cursor;

/// The bytes of an EXR file with 32-bit channels R, G and B, losslessly compressed; the same picture gives the same
/// bytes.
///
/// NaN and infinite components are kept. The header says by which program and with which primaries.
///
/// # Errors
/// A picture without pixels, or with another number of them than its sides say.
pub(crate) fn encode(picture: &Picture) -> Result<Vec<u8>> {
    picture.check()?;
    let (width, height) = (picture.width as usize, picture.height as usize);
    let channels = SpecificChannels::rgb(|Vec2(x, y)| {
        let [r, g, b] = picture.pixels[y * width + x];
        (r, g, b)
    });
    let attributes = LayerAttributes {
        software_name: Text::new_or_none(concat!("citylights ", env!("CARGO_PKG_VERSION"))),
        ..LayerAttributes::default()
    };
    let mut image = Image::from_layer(Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels));
    image.attributes.chromaticities = Some(REC_709);
    let mut bytes = Vec::new();
    image
        .write()
        .to_buffered(Cursor::new(&mut bytes))
        .map_err(|e| Error::Invalid(format!("cannot encode the picture as EXR: {e}")))?;
    Ok(bytes)
}
