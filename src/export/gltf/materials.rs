//! Materials: reflectors, and emitters that reflect nothing.
//!
//! Metallic 0, roughness 1 and specular 0 make each Lambertian elsewhere.

use super::extras::extras;
use super::factored::factored;
use crate::base::error::Result;
use crate::scene::Material;
use ::gltf::json::extensions::material::{
    EmissiveStrength, EmissiveStrengthFactor, Material as Extensions, Specular, SpecularColorFactor, SpecularFactor,
};
use ::gltf::json::material::{EmissiveFactor, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use ::gltf::json::{self, Root};
use glam::Vec3;

/// Adds what a surface is made of, and gives its index; it reflects on both sides.
pub(super) fn reflector(material: &Material, root: &mut Root) -> u32 {
    let material = json::Material {
        name: Some(material.name.clone()),
        double_sided: true,
        extras: material.street.then(|| extras("{\"street\":true}")),
        ..lambertian(material.albedo)
    };
    root.push(material).value() as u32
}

/// Adds what a triangle light is made of, and gives its index; it emits from its front alone.
pub(super) fn emitter(radiance: Vec3, root: &mut Root) -> Result<u32> {
    let (factor, strength) = factored(radiance)?;
    let mut material = lambertian(Vec3::ZERO);
    material.name = Some(format!("emission {}", root.materials.len()));
    material.emissive_factor = EmissiveFactor(factor);
    if let (Some(extensions), true) = (&mut material.extensions, strength != 1.0) {
        extensions.emissive_strength = Some(EmissiveStrength { emissive_strength: EmissiveStrengthFactor(strength) });
    }
    Ok(root.push(material).value() as u32)
}

fn lambertian(albedo: Vec3) -> json::Material {
    let [r, g, b] = albedo.to_array();
    let specular = Specular {
        specular_factor: SpecularFactor(0.0),
        specular_texture: None,
        specular_color_factor: SpecularColorFactor::default(),
        specular_color_texture: None,
        extras: None,
    };
    json::Material {
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(1.0),
            ..PbrMetallicRoughness::default()
        },
        extensions: Some(Extensions { specular: Some(specular), ..Extensions::default() }),
        ..json::Material::default()
    }
}
