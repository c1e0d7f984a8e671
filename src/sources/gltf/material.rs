//! Does a material reflect or emit?

use super::albedo::Bases;
use super::document::Document;
use super::extras::{MaterialExtras, read};
use super::glow::{Glow, Glows};
use super::images::Images;
use super::looks::Material as Entry;
use super::mesh::{Piece, Place};
use super::nodes::Placed;
use super::reader::Reader;
use crate::base::error::Result;
use crate::scene::{Material, Surface};
use crate::sources::limits::BRIGHTEST;
use crate::sources::name;
use glam::{DVec3, Vec3};
use std::collections::{HashMap, HashSet};

/// How far above 1, or below 0, a base colour may lie: exporters compute them in f32, and in other spaces of colour.
const HAIR: f64 = 0.01;

/// Most cells of a level of all emissive textures, and of one: 2^23 take 128 MiB.
const MOST_KEPT: usize = 1 << 23;
const MOST_KEPT_EACH: usize = 1 << 22;

/// What a primitive is covered with.
#[derive(Clone, Copy)]
pub(super) enum Cover {
    /// A reflector: the number of a material of the scene.
    Reflector(u32),
    /// An emitter.
    Emitter {
        /// Radiance in cd/m^2.
        radiance: Vec3,
        /// Whether it shines from both sides.
        double_sided: bool,
    },
    /// An emitter whose radiance a texture decides.
    Glowing {
        /// Its number among the [`Glows`].
        glow: usize,
        /// The number of the material that it has where the texture is dark.
        dark: u32,
        /// Whether it shines from both sides.
        double_sided: bool,
    },
}

/// All materials of a document.
pub(super) struct Palette {
    /// Of each material; `None` for one that nothing shows and that is broken, or emits.
    covers: Vec<Option<Cover>>,
    materials: Vec<Material>,
    /// The materials of primitives that differ from the others of theirs by what of a texture they show.
    own: HashMap<Place, u32>,
    /// What textures decide.
    pub(super) glows: Glows,
}

impl Palette {
    /// Reads all materials: the reflectors, in the document's order, become the scene's materials. What was decided here
    /// is told in `notes`.
    pub(super) fn read<'a>(reader: &'a Reader<'a>, placed: &'a [Placed], notes: &mut Vec<String>) -> Result<Self> {
        let Document { nodes, materials: entries, .. } = reader.document;
        let mut seen = HashSet::new();
        let first = |node: &&Placed| nodes[node.id as usize].mesh.is_some_and(|mesh| seen.insert(mesh));
        let firsts: Vec<&Placed> = placed.iter().filter(first).collect();
        let mut used = vec![false; entries.len()];
        for node in &firsts {
            reader.pieces(std::slice::from_ref(*node), &mut |piece| {
                let material = piece.material.and_then(|id| used.get_mut(id as usize));
                material.into_iter().for_each(|used| *used = true);
                Ok(())
            })?;
        }
        let mut palette =
            Self { covers: Vec::new(), materials: Vec::new(), own: HashMap::new(), glows: Glows::default() };
        let glowing = entries.iter().zip(&used).filter(|(entry, used)| **used && entry.emissive_texture.is_some());
        let most_cells = (MOST_KEPT / glowing.count().max(1)).min(MOST_KEPT_EACH);
        let mut images = Images::new(reader);
        let (mut kept, mut pictures) = (Vec::new(), HashMap::new());
        for (id, entry) in entries.iter().enumerate() {
            let cover = palette.one(reader, id, entry, used[id], &mut |image| {
                if let Some(&picture) = pictures.get(&image) {
                    return Ok(picture);
                }
                kept.push(images.picture(image, most_cells)?);
                pictures.insert(image, kept.len() - 1);
                Ok(kept.len() - 1)
            });
            // What nothing shows may say what it likes.
            palette.covers.push(if used[id] { cover? } else { cover.unwrap_or(None) });
        }
        palette.glows.pictures = kept;
        palette.plan(reader, placed)?;
        let (mut bases, mut without) = (Bases::default(), 0);
        for node in firsts {
            reader.pieces(std::slice::from_ref(node), &mut |piece| {
                let glow = match palette.cover(reader, piece)? {
                    Cover::Glowing { glow, .. } => Some(palette.glows.all[glow].mapping),
                    Cover::Reflector(_) => None,
                    Cover::Emitter { .. } => return Ok(()),
                };
                let mapped = [glow, bases.add(reader, node, piece)];
                without += usize::from(mapped.iter().flatten().any(|mapping| !piece.has_coordinates(mapping)));
                Ok(())
            })?;
        }
        if without > 0 {
            notes.push(format!(
                "primitives without the texture coordinates that their material asks for: {without}; 0 is taken, as viewers do"
            ));
        }
        let mut taken = HashSet::new();
        for (place, material, albedo) in bases.means(reader, &mut images, notes)? {
            palette.set_own(place, material, albedo, &mut taken);
        }
        Ok(palette)
    }

    fn one(
        &mut self,
        reader: &Reader,
        id: usize,
        entry: &Entry,
        used: bool,
        picture: &mut dyn FnMut(u32) -> Result<usize>,
    ) -> Result<Option<Cover>> {
        let radiance = radiance(reader, id, entry)?;
        let albedo = albedo(reader, id, entry)?;
        let double_sided = entry.double_sided;
        let glow = match &entry.emissive_texture {
            _ if radiance == Vec3::ZERO => None,
            None => return Ok(Some(Cover::Emitter { radiance, double_sided })),
            Some(_) if !used => return Ok(None),
            Some(texture) => {
                let mapping = reader.mapping(texture, &format_args!("materials[{id}].emissiveTexture"))?;
                let picture = picture(mapping.image)?;
                self.glows.all.push(Glow { picture, mapping, radiance });
                Some(self.glows.all.len() - 1)
            }
        };
        let name = entry.name.as_deref().and_then(name::made_fit).unwrap_or_else(|| format!("material {id}"));
        let street = read::<MaterialExtras>(entry.extras).and_then(|e| e.street).unwrap_or(false);
        self.materials.push(Material { name, albedo, street });
        let dark = self.materials.len() as u32 - 1;
        Ok(Some(match glow {
            Some(glow) => Cover::Glowing { glow, dark, double_sided },
            None => Cover::Reflector(dark),
        }))
    }

    /// Decides how fine the textured triangles are cut.
    fn plan<'a>(&mut self, reader: &'a Reader<'a>, placed: &'a [Placed]) -> Result<()> {
        if self.glows.all.is_empty() {
            return Ok(());
        }
        let mut triangles = 0usize;
        reader.pieces(placed, &mut |piece| {
            if let Cover::Glowing { .. } = self.cover(reader, piece)? {
                triangles = triangles.saturating_add(piece.len());
            }
            Ok(())
        })?;
        self.glows.plan(triangles);
        Ok(())
    }

    /// Gives a primitive of a material the albedo that it has there; the first of a material, which is not yet `taken`,
    /// gives it to the material itself.
    fn set_own(&mut self, place: Place, material: u32, albedo: Vec3, taken: &mut HashSet<u32>) {
        let cover = self.covers.get(material as usize).copied().flatten();
        let Some(Cover::Reflector(of) | Cover::Glowing { dark: of, .. }) = cover else { return };
        if taken.insert(of) {
            self.materials[of as usize].albedo = albedo;
            return;
        }
        self.materials.push(Material { albedo, ..self.materials[of as usize].clone() });
        self.own.insert(place, self.materials.len() as u32 - 1);
    }

    /// What covers a primitive.
    pub(super) fn cover(&self, reader: &Reader, piece: &Piece) -> Result<Cover> {
        let Some(id) = piece.material else { return Ok(Cover::Reflector(self.plain())) };
        let cover = self.covers.get(id as usize);
        let cover = cover.ok_or_else(|| reader.no_such("material", id, self.covers.len(), &piece.material_field()))?;
        let cover = cover.expect("every material that a primitive shows is read");
        Ok(match (cover, self.own.get(&piece.place)) {
            (Cover::Reflector(_), Some(&own)) => Cover::Reflector(own),
            (Cover::Glowing { glow, double_sided, .. }, Some(&dark)) => Cover::Glowing { glow, dark, double_sided },
            (cover, _) => cover,
        })
    }

    /// The number of the material that primitives without any have: after all others.
    fn plain(&self) -> u32 {
        self.materials.len() as u32
    }

    /// The materials of a scene of these surfaces.
    pub(super) fn finish(self, surfaces: &[Surface]) -> Vec<Material> {
        let plain = self.plain();
        let mut materials = self.materials;
        if surfaces.iter().any(|surface| surface.material == plain) {
            // The specification has it white.
            materials.push(Material { name: "no material".into(), albedo: Vec3::ONE, street: false });
        }
        materials
    }
}

fn albedo(reader: &Reader, id: usize, entry: &Entry) -> Result<Vec3> {
    let albedo = DVec3::from_array(entry.base_factor());
    if !(albedo.min_element() >= -HAIR && albedo.max_element() <= 1.0 + HAIR) {
        let name = match entry.extensions.specular_glossiness {
            Some(_) => "extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor",
            None => "pbrMetallicRoughness.baseColorFactor",
        };
        return Err(reader.wrong(
            format_args!("materials[{id}].{name}"),
            format_args!("{albedo} is given; each channel must lie within 0 and 1"),
        ));
    }
    Ok(albedo.clamp(DVec3::ZERO, DVec3::ONE).as_vec3())
}

/// Radiance in cd/m^2: the factor times the strength, which is 1 where it is not given.
fn radiance(reader: &Reader, id: usize, entry: &Entry) -> Result<Vec3> {
    let strength = entry.extensions.emissive_strength.as_ref().and_then(|e| e.strength).unwrap_or(1.0);
    let factor = DVec3::from_array(entry.emissive_factor);
    let radiance = factor * strength;
    if !(strength >= 0.0 && factor.min_element() >= 0.0 && radiance.max_element() <= BRIGHTEST) {
        return Err(reader.wrong(
            format_args!("materials[{id}].emissiveFactor"),
            format_args!(
                "{factor} times a strength of {strength} is given; neither may be negative, nor the product above \
                 {BRIGHTEST} cd/m^2"
            ),
        ));
    }
    Ok(radiance.as_vec3())
}
