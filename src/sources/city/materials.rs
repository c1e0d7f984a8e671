//! What is a city made of?

use crate::scene::Material;

/// Height of the kerb in m; a multiple of 2^-10.
pub(super) const KERB: f64 = 0.15625;

/// Material of the carriageway.
pub(super) const ASPHALT: u32 = 0;
/// Material of pavements and squares.
pub(super) const PAVEMENT: u32 = 1;
/// Material of the kerbs' sides.
pub(super) const CURB: u32 = 2;
/// Material of roofs.
pub(super) const ROOF: u32 = 3;
/// Material of the first kind of facade.
pub(super) const FIRST_FACADE: u32 = 4;

/// Kinds of facade: name and albedo.
pub(super) const FACADES: [(&str, [f32; 3]); 5] = [
    ("brick", [0.36, 0.20, 0.15]),
    ("plaster", [0.56, 0.51, 0.43]),
    ("concrete", [0.38, 0.37, 0.35]),
    ("sandstone", [0.48, 0.39, 0.28]),
    ("dark glass", [0.10, 0.11, 0.13]),
];

/// The materials of every city, by whose names recipes can call them. Albedos are those of dry, worn materials.
pub(crate) fn builtin_materials() -> Vec<Material> {
    let material = |name: &str, albedo: [f32; 3], street| Material { name: name.into(), albedo: albedo.into(), street };
    let mut all = vec![
        material("asphalt", [0.10, 0.10, 0.105], true),
        material("pavement", [0.26, 0.25, 0.24], true),
        material("kerb", [0.32, 0.31, 0.30], false),
        material("roof", [0.14, 0.13, 0.13], false),
    ];
    all.extend(FACADES.map(|(name, albedo)| material(name, albedo, false)));
    all
}
