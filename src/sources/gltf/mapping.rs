//! How does a texture lie on a surface?

use super::looks::TextureInfo;
use super::reader::Reader;
use crate::base::error::Result;
use crate::texture::coverage::Wrap;
use glam::{DMat2, DVec2};
use std::fmt::Display;

/// Which image a texture shows, and where.
#[derive(Clone, Copy)]
pub(super) struct Mapping {
    /// The image's number.
    pub(super) image: u32,
    /// The set of texture coordinates.
    pub(super) set: u32,
    /// Across and down.
    pub(super) wrap: [Wrap; 2],
    turn: DMat2,
    offset: DVec2,
}

impl Mapping {
    /// Where in the image coordinates of the set lie, in widths and heights from its upper left corner.
    pub(super) fn place(&self, coordinates: DVec2) -> DVec2 {
        self.turn * coordinates + self.offset
    }
}

impl Reader<'_> {
    /// The mapping that the document gives at `field`.
    pub(super) fn mapping(&self, info: &TextureInfo, field: &dyn Display) -> Result<Mapping> {
        let (textures, images) = (&self.document.textures, &self.document.images);
        let id = info.index;
        let texture = textures.get(id as usize);
        let texture =
            texture.ok_or_else(|| self.no_such("texture", id, textures.len(), &format_args!("{field}.index")))?;
        let source = format!("textures[{id}].source");
        let Some(image) = texture.source else {
            let text = "is missing: PNG and JPEG are read here, and this texture has another format alone; \
                        `gltf-transform png`, or `ktxdecompress`, makes PNG of it";
            return Err(self.wrong(source, text));
        };
        if image as usize >= images.len() {
            return Err(self.no_such("image", image, images.len(), &source));
        }
        let samplers = &self.document.samplers;
        let wrap = match texture.sampler {
            None => [Wrap::Repeat; 2],
            Some(sampler) => {
                let missing =
                    || self.no_such("sampler", sampler, samplers.len(), &format_args!("textures[{id}].sampler"));
                let entry = samplers.get(sampler as usize).ok_or_else(missing)?;
                [self.wrap(sampler, "wrapS", entry.wrap_s)?, self.wrap(sampler, "wrapT", entry.wrap_t)?]
            }
        };
        let plain = Mapping { image, set: info.tex_coord, wrap, turn: DMat2::IDENTITY, offset: DVec2::ZERO };
        let Some(transform) = &info.extensions.transform else { return Ok(plain) };
        // Counter-clockwise for coordinates that run downwards.
        let turn = DMat2::from_angle(-transform.rotation.unwrap_or(0.0));
        Ok(Mapping {
            set: transform.tex_coord.unwrap_or(info.tex_coord),
            turn: turn * DMat2::from_diagonal(transform.scale.unwrap_or([1.0; 2]).into()),
            offset: transform.offset.unwrap_or([0.0; 2]).into(),
            ..plain
        })
    }

    fn wrap(&self, sampler: u32, name: &str, given: Option<u32>) -> Result<Wrap> {
        match given {
            None | Some(10497) => Ok(Wrap::Repeat),
            Some(33648) => Ok(Wrap::Mirror),
            Some(33071) => Ok(Wrap::Clamp),
            Some(other) => {
                let text =
                    format_args!("{other} is given; 10497 (repeat), 33648 (mirror) or 33071 (clamp) is asked for");
                Err(self.wrong(format_args!("samplers[{sampler}].{name}"), text))
            }
        }
    }
}
