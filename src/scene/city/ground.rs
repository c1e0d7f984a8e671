//! What do people walk and drive on?
//!
//! Asphalt at z = 0, one quad per crossing and per street between two crossings, so that no triangle is as long as the
//! city; each block is a slab of pavement with kerbs.

use crate::scene::city::buildings::{FACADES, Town};
use crate::scene::city::round;
use crate::scene::{Material, Surface};
use glam::{DVec3, Vec3};

/// Height of the kerb in m; a multiple of 2^-10.
pub(super) const KERB: f64 = 0.15625;

/// Material of the carriageway.
const ASPHALT: u32 = 0;
/// Material of pavements and squares.
const PAVEMENT: u32 = 1;
/// Material of the kerbs' sides.
const CURB: u32 = 2;
/// Material of roofs.
pub(super) const ROOF: u32 = 3;
/// Material of the first kind of facade.
pub(super) const FIRST_FACADE: u32 = 4;

/// All materials of a city. Albedos are those of dry, worn materials.
pub(super) fn materials() -> Vec<Material> {
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

pub(super) fn surfaces(town: &Town) -> Vec<Surface> {
    let mut out = Vec::new();
    let mut flat = |x: [f64; 2], y: [f64; 2]| {
        out.extend(quad(
            [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(|[x, y]| DVec3::new(x, y, 0.0)),
            ASPHALT,
        ));
    };
    let (x, y) = (&town.layout.x, &town.layout.y);
    for &across in &x.streets {
        y.streets.iter().chain(&y.blocks).for_each(|&along| flat(across, along));
    }
    for &across in &y.streets {
        x.blocks.iter().for_each(|&along| flat(along, across));
    }
    for block in &town.blocks {
        let (low, high) = (block.low.extend(0.0), block.high.extend(KERB));
        out.extend(faces(low, high, CURB, PAVEMENT));
    }
    out
}

/// The sides and the top of a box, outward faces counter-clockwise: -y, +x, +y, -x, top.
pub(super) fn faces(low: DVec3, high: DVec3, side: u32, top: u32) -> impl Iterator<Item = Surface> {
    let corner = |x: bool, y: bool, z: bool| {
        DVec3::new(if x { high.x } else { low.x }, if y { high.y } else { low.y }, if z { high.z } else { low.z })
    };
    let ring = [
        corner(false, false, false),
        corner(true, false, false),
        corner(true, true, false),
        corner(false, true, false),
    ];
    let sides: Vec<_> = (0..4)
        .flat_map(|i| {
            let (a, b) = (ring[i], ring[(i + 1) % 4]);
            quad([a, b, b.with_z(high.z), a.with_z(high.z)], side)
        })
        .collect();
    sides.into_iter().chain(quad(ring.map(|p| p.with_z(high.z)), top))
}

fn quad(corners: [DVec3; 4], material: u32) -> [Surface; 2] {
    let [a, b, c, d]: [Vec3; 4] = corners.map(round::position);
    [Surface { corners: [a, b, c], material }, Surface { corners: [a, c, d], material }]
}
