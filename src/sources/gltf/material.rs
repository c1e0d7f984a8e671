//! Does a material reflect or emit?

use super::document::Material as Entry;
use super::extras::{MaterialExtras, read};
use super::reader::Reader;
use crate::base::error::Result;
use crate::scene::{Material, Surface};
use crate::sources::limits::BRIGHTEST;
use crate::sources::name;
use glam::{DVec3, Vec3};
use std::fmt::Display;

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
}

/// All materials of a document.
pub(super) struct Palette {
    /// Of each material; `None` for an emitter whose radiance a texture decides.
    covers: Vec<Option<Cover>>,
    materials: Vec<Material>,
}

impl Palette {
    /// Reads all materials: the reflectors, in the document's order, become the scene's materials.
    pub(super) fn read(reader: &Reader) -> Result<Self> {
        let mut materials = Vec::new();
        let mut covers = Vec::with_capacity(reader.document.materials.len());
        for (id, entry) in reader.document.materials.iter().enumerate() {
            let radiance = radiance(reader, id, entry)?;
            let albedo = albedo(reader, id, entry)?;
            covers.push(if radiance == Vec3::ZERO {
                let name = entry.name.as_deref().and_then(name::made_fit).unwrap_or_else(|| format!("material {id}"));
                let street = read::<MaterialExtras>(entry.extras).and_then(|e| e.street).unwrap_or(false);
                materials.push(Material { name, albedo, street });
                Some(Cover::Reflector(materials.len() as u32 - 1))
            } else if entry.emissive_texture.is_some() {
                None
            } else {
                Some(Cover::Emitter { radiance, double_sided: entry.double_sided })
            });
        }
        Ok(Self { covers, materials })
    }

    /// What covers a primitive that names this material; `field` is where it does.
    pub(super) fn cover(&self, reader: &Reader, material: Option<u32>, field: &dyn Display) -> Result<Cover> {
        let Some(id) = material else { return Ok(Cover::Reflector(self.plain())) };
        let cover = self.covers.get(id as usize);
        cover.ok_or_else(|| reader.no_such("material", id, self.covers.len(), field))?.ok_or_else(|| {
            reader.wrong(
                format_args!("materials[{id}].emissiveTexture"),
                "textures are not read, and this one decides how bright the light is; give each part of its own \
                 brightness a material of its own with an `emissiveFactor`, as scenes/from_blender.py does",
            )
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
    let [r, g, b, _] = entry.pbr_metallic_roughness.base_color_factor;
    let albedo = DVec3::new(r, g, b);
    if !(albedo.min_element() >= 0.0 && albedo.max_element() <= 1.0) {
        return Err(reader.wrong(
            format_args!("materials[{id}].pbrMetallicRoughness.baseColorFactor"),
            format_args!("{albedo} is given; each channel must lie within 0 and 1"),
        ));
    }
    Ok(albedo.as_vec3())
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
