//! A filled box, and its faces.

use super::round;
use crate::scene::Surface;
use glam::{DVec3, Vec3};

/// An axis-aligned box that is filled; corners in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// The corner with the least coordinates.
    pub low: Vec3,
    /// The corner with the greatest coordinates.
    pub high: Vec3,
}

impl Solid {
    /// Whether a point lies inside, not on a face.
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpgt(self.low).all() && point.cmplt(self.high).all()
    }
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

pub(super) fn quad(corners: [DVec3; 4], material: u32) -> [Surface; 2] {
    let [a, b, c, d]: [Vec3; 4] = corners.map(round::position);
    [Surface { corners: [a, b, c], material }, Surface { corners: [a, c, d], material }]
}
