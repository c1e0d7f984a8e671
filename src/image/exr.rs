//! Linear light as 32-bit floats, exactly as computed.

use super::Picture;
use crate::base::error::{Error, Result};
use ::exr::prelude::{
    Encoding, Image, Layer, LayerAttributes, ReadChannels, ReadLayers, SpecificChannels, Vec2, WritableImage,
};
use std::fmt::Display;
use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::Path;

/// The bytes of an EXR file with 32-bit channels R, G and B, losslessly compressed; the same picture gives the same
/// bytes.
///
/// NaN and infinite components are kept.
pub fn encode(picture: &Picture) -> Result<Vec<u8>> {
    picture.check()?;
    let (width, height) = (picture.width as usize, picture.height as usize);
    let channels = SpecificChannels::rgb(|Vec2(x, y)| {
        let [r, g, b] = picture.pixels[y * width + x];
        (r, g, b)
    });
    let layer = Layer::new((width, height), LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Vec::new();
    Image::from_layer(layer)
        .write()
        .to_buffered(Cursor::new(&mut bytes))
        .map_err(|e| Error::Invalid(format!("cannot encode the picture as EXR: {e}")))?;
    Ok(bytes)
}

/// Reads the R, G and B channels of an EXR file (its first layer that has them; 16-bit floats are widened).
///
/// A file that cannot be opened is [`Error::Io`]; one that is cut short, damaged or without these channels is
/// [`Error::Input`].
pub fn read(path: &Path) -> Result<Picture> {
    let file = File::open(path).map_err(Error::io("read", path))?;
    let image = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.width(), vec![[0.0f32; 3]; size.area()]),
            |(width, pixels), Vec2(x, y), (r, g, b): (f32, f32, f32)| pixels[y * *width + x] = [r, g, b],
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(BufReader::new(file))
        .map_err(|e| unreadable(path, e))?;
    let Vec2(width, height) = image.layer_data.size;
    let side = |n: usize| u32::try_from(n).map_err(|_| unreadable(path, "its sides are too long"));
    Ok(Picture { width: side(width)?, height: side(height)?, pixels: image.layer_data.channel_data.pixels.1 })
}

fn unreadable(path: &Path, why: impl Display) -> Error {
    Error::Input {
        file: path.to_owned(),
        line: None,
        field: String::new(),
        message: format!("not a whole EXR picture with channels R, G and B: {why}"),
    }
}
