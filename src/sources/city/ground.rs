//! What do people walk and drive on?
//!
//! Asphalt at z = 0, one quad per crossing and per street between two crossings, so that no triangle is as long as the
//! city; each block is a slab of pavement with kerbs.

use super::buildings::Town;
use super::materials::{ASPHALT, CURB, KERB, PAVEMENT};
use super::solid::{faces, quad};
use crate::scene::Surface;
use glam::DVec3;

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
