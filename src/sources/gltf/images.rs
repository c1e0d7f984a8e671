//! Which picture is an image of the document?
//!
//! PNG and JPEG, within the document, in a buffer or beside it, told apart by their first bytes. How many texels are
//! decoded is bounded by the bytes that are there, for one image and for all together.

use super::looks::Image;
use super::reader::Reader;
use crate::base::error::Result;
use crate::texture::decode::{Decoded, decode};
use crate::texture::picture::Picture;
use std::borrow::Cow;
use std::fmt::Display;

/// Most bytes of an image file.
const LARGEST_FILE: u64 = 1 << 28;
/// Texels that any one image may have: 2048 x 2048.
const ALWAYS: u64 = 1 << 22;
/// Texels that all images of a file may have.
const ALWAYS_IN_ALL: u64 = 1 << 25;
/// Texels that all images of a file may have beyond that, whatever their bytes: they take half a minute.
const MOST_IN_ALL: u64 = 1 << 31;
/// Texels for each byte of an image, beyond that: as many as deflate can pack of one colour.
const FOR_A_BYTE: u64 = 400;
/// Most texels of an image: 16384 x 8192.
const MOST: u64 = 1 << 27;

/// The images of a document, as long as there is room for their texels.
pub(super) struct Images<'r> {
    reader: &'r Reader<'r>,
    left: u64,
    /// What may still be added to that.
    room: u64,
}

impl<'r> Images<'r> {
    /// None decoded yet.
    pub(super) fn new(reader: &'r Reader<'r>) -> Self {
        let buffers: usize = reader.buffers.iter().map(|buffer| buffer.len()).sum();
        let within: usize = reader.document.images.iter().filter_map(|image| image.uri.as_ref()).map(String::len).sum();
        let mut images = Self { reader, left: ALWAYS_IN_ALL, room: MOST_IN_ALL };
        images.add(buffers + within);
        images
    }

    /// Adds texels for these bytes.
    fn add(&mut self, bytes: usize) {
        let more = FOR_A_BYTE.saturating_mul(bytes as u64).min(self.room);
        (self.left, self.room) = (self.left + more, self.room - more);
    }

    /// Decodes the image of that number, which is in the document, and keeps levels of at most so many cells.
    pub(super) fn picture(&mut self, id: u32, most_cells: usize) -> Result<Picture> {
        let entry = &self.reader.document.images[id as usize];
        let refuse = |message: &dyn Display| self.reader.wrong(format_args!("images[{id}]"), message);
        if self.left == 0 {
            return Err(refuse(&"the images before it have as many texels as this file may have; scale them down"));
        }
        let bytes = self.bytes(id, entry)?;
        if entry.uri.as_deref().is_some_and(|uri| !uri.starts_with("data:")) {
            self.add(bytes.len());
        }
        // Reading takes time too.
        self.left = self.left.saturating_sub(bytes.len() as u64);
        let most = (ALWAYS + FOR_A_BYTE * bytes.len() as u64).min(MOST).min(self.left);
        let ([width, height], codes) = match decode(&bytes, most) {
            Decoded::Picture(size, codes) => (size, codes),
            Decoded::TooLarge([width, height]) => {
                return Err(refuse(&format_args!(
                    "{width} x {height} texels in {} bytes are given; {most} texels are the most here; scale it down",
                    bytes.len()
                )));
            }
            Decoded::Foreign => {
                return Err(refuse(&format_args!(
                    "\"{}\" begins it; PNG and JPEG are read here; `gltf-transform png`, or `ktxdecompress`, makes PNG of it",
                    bytes[..bytes.len().min(8)].escape_ascii()
                )));
            }
            Decoded::Broken(error) => return Err(refuse(&format_args!("this picture cannot be read: {error}"))),
        };
        self.left -= u64::from(width) * u64::from(height);
        Ok(Picture::new([width as usize, height as usize], codes, most_cells))
    }

    fn bytes(&self, id: u32, entry: &Image) -> Result<Cow<'r, [u8]>> {
        let field = |name: &str| format!("images[{id}].{name}");
        match (&entry.uri, entry.buffer_view) {
            (Some(uri), _) => self.reader.source.fetch(&field("uri"), uri, LARGEST_FILE).map(Cow::Owned),
            (None, Some(view)) => self.reader.bytes_of_view(view, &field("bufferView")).map(Cow::Borrowed),
            (None, None) => {
                let text =
                    "is missing; the name of a file beside this one, data in base64 or a `bufferView` is asked for";
                Err(self.reader.wrong(field("uri"), text))
            }
        }
    }
}
