//! What of a texture is the albedo of a primitive?
//!
//! Its mean over the primitive's triangles, each weighing by its area, times the factor.

use super::images::Images;
use super::mapping::Mapping;
use super::mesh::{Piece, Place};
use super::nodes::Placed;
use super::reader::Reader;
use crate::base::error::Result;
use crate::texture::coverage;
use crate::texture::picture::Picture;
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Most cells of textures that are looked at, in all and for a triangle.
const MOST_CELLS: usize = 1 << 24;
const MOST_CELLS_EACH: usize = 1 << 8;
/// Most cells of a level of an image, of which one is held at a time.
const MOST_KEPT: usize = 1 << 22;

/// A primitive with a textured base colour, at the first node that shows it.
struct Base<'a> {
    place: Place,
    material: u32,
    node: &'a Placed,
    mapping: Mapping,
}

/// Primitives with textured base colours.
#[derive(Default)]
pub(super) struct Bases<'a> {
    all: Vec<Base<'a>>,
    triangles: usize,
    /// What is wrong with those textures that cannot be read, and of which materials they are.
    unreadable: Vec<(u32, String)>,
}

impl<'a> Bases<'a> {
    /// Adds a primitive if its base colour has a texture, and gives how that lies on it.
    pub(super) fn add(&mut self, reader: &Reader, node: &'a Placed, piece: &Piece) -> Option<Mapping> {
        let id = piece.material?;
        let (texture, name) = reader.document.materials.get(id as usize)?.base_texture()?;
        match reader.mapping(texture, &format_args!("materials[{id}].{name}")) {
            Ok(mapping) => {
                self.triangles = self.triangles.saturating_add(piece.len());
                self.all.push(Base { place: piece.place, material: id, node, mapping });
                Some(mapping)
            }
            Err(error) => {
                self.unreadable.push((id, error.to_string()));
                None
            }
        }
    }

    /// The albedo of each, in the order in which they were added; what was decided here is told in `notes`.
    pub(super) fn means(
        mut self,
        reader: &Reader,
        images: &mut Images,
        notes: &mut Vec<String>,
    ) -> Result<Vec<(Place, u32, Vec3)>> {
        // One image at a time.
        let mut order: Vec<usize> = (0..self.all.len()).collect();
        order.sort_by_key(|&i| self.all[i].mapping.image);
        let mut found: HashMap<usize, Vec3> = HashMap::new();
        let cells = (MOST_CELLS / self.triangles.max(1)).clamp(1, MOST_CELLS_EACH);
        for run in order.chunk_by(|&a, &b| self.all[a].mapping.image == self.all[b].mapping.image) {
            match images.picture(self.all[run[0]].mapping.image, MOST_KEPT) {
                Ok(picture) => {
                    for &i in run {
                        found.insert(i, self.all[i].mean(reader, &picture, cells)?);
                    }
                }
                Err(error) => self.unreadable.extend(run.iter().map(|&i| (self.all[i].material, error.to_string()))),
            }
        }
        let count = |mut materials: Vec<u32>| {
            materials.sort_unstable();
            materials.dedup();
            materials.len()
        };
        let read = count(found.keys().map(|&i| self.all[i].material).collect());
        if read > 0 {
            notes.push(format!(
                "base colour textures of materials: {read}; their mean over each primitive, times the factor, is the albedo"
            ));
        }
        if let Some((_, first)) = self.unreadable.first() {
            let unread = count(self.unreadable.iter().map(|(material, _)| *material).collect());
            notes.push(format!(
                "base colour textures of materials that cannot be read: {unread}; the factor alone is the albedo ({first})"
            ));
        }
        let all = self.all.iter().enumerate();
        Ok(all.filter_map(|(i, base)| Some((base.place, base.material, *found.get(&i)?))).collect())
    }
}

impl Base<'_> {
    fn mean(&self, reader: &Reader, picture: &Picture, cells: usize) -> Result<Vec3> {
        let factor = DVec3::from_array(reader.document.materials[self.material as usize].base_factor());
        let (mut sum, mut area) = (DVec3::ZERO, 0.0);
        if let Some(piece) = reader.piece(self.node, self.place)? {
            for (corners, places) in piece.triangles().zip(piece.places(&self.mapping)?) {
                let ([a, b, c], places) = (corners?, places?);
                let weight = (b - a).cross(c - a).length();
                sum += weight * coverage::mean(picture, self.mapping.wrap, places, cells).as_dvec3();
                area += weight;
            }
        }
        let mean = if area > 0.0 { sum / area } else { picture.mean().as_dvec3() };
        Ok((factor * mean).clamp(DVec3::ZERO, DVec3::ONE).as_vec3())
    }
}
