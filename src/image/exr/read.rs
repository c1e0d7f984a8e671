//! An EXR file as a picture.

use super::channels::{Chosen, choose};
use super::primaries::to_rec_709;
use crate::base::error::{Error, Result};
use crate::base::names::printable;
use crate::image::bound::Bound;
use crate::image::picture::Picture;
use ::exr::block::chunk::TileCoordinates;
use ::exr::block::reader::ChunksReader;
use ::exr::block::{BlockIndex, UncompressedBlock};
use ::exr::error::Error as ExrError;
use ::exr::math::Vec2;
use ::exr::meta::attribute::{IntegerBounds, SampleType};
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, MetaData};
use ::exr::prelude::f16;
use glam::Vec3;
use std::collections::HashSet;
use std::fmt::Display;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

/// A block that unpacks to more bytes a pixel of the bound is no picture's: 16 channels in a picture of one block, more
/// where it has several.
const BLOCK_BYTES: usize = 64;

/// Reads the colours of an EXR file: its channels `R`, `G`, `B`; else those of the one layer that has them
/// (`albedo.R`), or of several the one called `Combined`; else `Y` alone as grey.
///
/// 16-bit floats and whole numbers are widened. The picture is the file's display window: pixels of it without data
/// are 0, data outside it are left. Colours of other primaries than those of Rec. 709 are turned into these. Of several resolutions the largest is taken. What the header claims is checked
/// before memory is taken for it.
///
/// # Errors
/// A file that cannot be opened is [`Error::Io`]; one that is cut short, damaged, deep, without one such picture, or with
/// more pixels than are asked for, or without that than its size [suggests](Bound), is [`Error::Input`].
pub(crate) fn read(path: &Path, pixels: Option<usize>) -> Result<Picture> {
    let file = File::open(path).map_err(Error::io("read", path))?;
    let bound = Bound::of(&file, path, pixels)?;
    picture(BufReader::new(file), bound).map_err(|why| Error::Input {
        file: path.to_owned(),
        line: None,
        field: String::new(),
        // Names of channels and attributes are whatever the file says.
        message: format!("not an EXR picture that can be read: {}", printable(&why)),
    })
}

fn picture(file: impl Read + Seek, bound: Bound) -> std::result::Result<Picture, String> {
    let reader = ::exr::block::read(file, false).map_err(text)?;
    reader.headers().iter().try_for_each(|part| sane(part, bound))?;
    let chosen = choose(reader.headers())?;
    let part = &reader.headers()[chosen.part];
    if part.deep {
        return Err("deep data: flatten it first".into());
    }
    // Grey is grey in all.
    let primaries = part.shared_attributes.chromaticities.as_ref().filter(|_| !chosen.is_grey());
    let matrix = primaries.map(to_rec_709).transpose()?.flatten();
    let mut canvas = Canvas::new(part, chosen, bound)?;
    let wanted = |_: &MetaData, tile: TileCoordinates, block: BlockIndex| {
        block.layer == chosen.part && tile.is_largest_resolution_level()
    };
    reader
        .filter_chunks(false, wanted)
        .and_then(|chunks| chunks.decompress_sequential(false, |data, block| canvas.put(data, &block)))
        .map_err(text)?;
    let mut picture = canvas.picture;
    if let Some(matrix) = matrix {
        for pixel in &mut picture.pixels {
            *pixel = (matrix * Vec3::from(*pixel).as_dvec3()).as_vec3().to_array();
        }
    }
    Ok(picture)
}

/// What an error says.
fn text(error: impl Display) -> String {
    error.to_string()
}

/// Whether what a header claims could be a picture's.
fn sane(part: &Header, bound: Bound) -> std::result::Result<(), String> {
    area(part.layer_size, bound)?;
    area(part.shared_attributes.display_window.size, bound)?;
    let (block, lines) = match part.blocks {
        BlockDescription::Tiles(tiles) => (tiles.tile_size.width(), tiles.tile_size.height()),
        BlockDescription::ScanLines => (part.layer_size.width(), part.compression.scan_lines_per_block()),
    };
    let bytes = block.saturating_mul(lines).saturating_mul(part.channels.bytes_per_pixel);
    let most = bound.pixels.saturating_mul(BLOCK_BYTES);
    if bytes > most {
        return Err(format!("its blocks unpack to {bytes} bytes; at most {most} are read"));
    }
    Ok(())
}

/// The number of pixels of a window, if it has any and not too many.
fn area(Vec2(width, height): Vec2<usize>, bound: Bound) -> std::result::Result<usize, String> {
    bound.area(width as u64, height as u64).map_err(|why| format!("a window of {why}"))
}

/// The picture as it fills.
struct Canvas {
    picture: Picture,
    chosen: Chosen,
    display: IntegerBounds,
    /// Where the data begin, in the coordinates of the display window.
    data: Vec2<i32>,
    filled: HashSet<Vec2<usize>>,
}

impl Canvas {
    fn new(part: &Header, chosen: Chosen, bound: Bound) -> std::result::Result<Self, String> {
        let display = part.shared_attributes.display_window;
        let Vec2(width, height) = display.size;
        let side = |n: usize| u32::try_from(n).map_err(text);
        // Zeroed memory that is never written to costs nothing: a header alone cannot fill it.
        let pixels = vec![[0.0; 3]; area(display.size, bound)?];
        Ok(Self {
            picture: Picture { width: side(width)?, height: side(height)?, pixels },
            chosen,
            display,
            data: part.own_attributes.layer_position,
            filled: HashSet::new(),
        })
    }

    /// Takes the colours of one block.
    fn put(&mut self, file: &MetaData, block: &UncompressedBlock) -> ::exr::error::Result<()> {
        let index = block.index;
        // The table of blocks may say anything: without repeats, as many blocks as there should be are all of them.
        if index.layer != self.chosen.part || index.level != Vec2(0, 0) || !self.filled.insert(index.pixel_position) {
            return Err(ExrError::Invalid("its table of blocks".into()));
        }
        let channels = &file.headers[index.layer].channels;
        for line in block.lines(channels) {
            let rgb = self.chosen.rgb;
            for colour in (0..3).filter(|&c| rgb[c] == line.location.channel) {
                let at = line.location.position;
                match channels.list[line.location.channel].sample_type {
                    SampleType::F32 => self.fill(at, colour, line.read_samples::<f32>())?,
                    SampleType::F16 => self.fill(at, colour, line.read_samples::<f16>().map(|x| x.map(f16::to_f32)))?,
                    SampleType::U32 => {
                        self.fill(at, colour, line.read_samples::<u32>().map(|x| x.map(|x| x as f32)))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Writes the samples of one colour along a line whose first pixel lies at `at` in the data window.
    fn fill(
        &mut self,
        Vec2(x, y): Vec2<usize>,
        colour: usize,
        samples: impl Iterator<Item = ::exr::error::Result<f32>>,
    ) -> ::exr::error::Result<()> {
        let Vec2(width, height) = self.display.size;
        let place = |data: i32, offset: usize, display: i32, size: usize| {
            let place = i64::from(data) + offset as i64 - i64::from(display);
            usize::try_from(place).ok().filter(|&place| place < size)
        };
        let Some(row) = place(self.data.y(), y, self.display.position.y(), height) else { return Ok(()) };
        for (i, sample) in samples.enumerate() {
            let sample = sample?;
            if let Some(column) = place(self.data.x(), x + i, self.display.position.x(), width) {
                self.picture.pixels[row * width + column][colour] = sample;
            }
        }
        Ok(())
    }
}
