//! Where on a wall is that?

use super::round;
use crate::scene::light::Shape;
use glam::{DVec3, Vec3};

/// The sides of a box, by the way they look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    South,
    East,
    North,
    West,
}

impl Side {
    pub(super) const ALL: [Self; 4] = [Self::South, Self::East, Self::North, Self::West];
}

/// A wall as seen from outside: `u` runs to the right, `v` upwards, both in m from its lower left corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wall {
    corner: DVec3,
    right: DVec3,
    pub(super) out: DVec3,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Wall {
    pub(super) fn of(low: DVec3, high: DVec3, side: Side) -> Self {
        let (corner, right, out, width) = match side {
            Side::South => (low, DVec3::X, DVec3::NEG_Y, high.x - low.x),
            Side::East => (low.with_x(high.x), DVec3::Y, DVec3::X, high.y - low.y),
            Side::North => (high.with_z(low.z), DVec3::NEG_X, DVec3::Y, high.x - low.x),
            Side::West => (low.with_y(high.y), DVec3::NEG_Y, DVec3::NEG_X, high.y - low.y),
        };
        Self { corner, right, out, width, height: high.z - low.z }
    }

    /// The point at `(u, v)`, `proud` m in front of the wall.
    pub(super) fn point(&self, u: f64, v: f64, proud: f64) -> DVec3 {
        self.corner + self.right * u + DVec3::Z * v + self.out * proud
    }

    /// An emitting rectangle parallel to the wall, which it looks away from.
    pub(super) fn panel(&self, u: [f64; 2], v: [f64; 2], proud: f64, radiance: Vec3) -> [Shape; 2] {
        emitter(
            [[u[0], v[0]], [u[1], v[0]], [u[1], v[1]], [u[0], v[1]]].map(|[u, v]| self.point(u, v, proud)),
            radiance,
        )
    }

    /// Two emitting rectangles that stick out of the wall at `u`, back to back and `gap` m apart, from `out[0]` to
    /// `out[1]` m before it.
    pub(super) fn blade(&self, u: f64, v: [f64; 2], out: [f64; 2], gap: f64, radiance: Vec3) -> [Shape; 4] {
        let face = |u: f64, out: [f64; 2]| {
            let corners = [[out[0], v[0]], [out[1], v[0]], [out[1], v[1]], [out[0], v[1]]];
            emitter(corners.map(|[out, v]| self.point(u, v, out)), radiance)
        };
        // Seen from the right, going outwards is going to the left.
        let [a, b] = face(u + 0.5 * gap, [out[1], out[0]]);
        let [c, d] = face(u - 0.5 * gap, out);
        [a, b, c, d]
    }
}

/// The two triangles of an emitting rectangle, corners counter-clockwise.
fn emitter(corners: [DVec3; 4], radiance: Vec3) -> [Shape; 2] {
    let [a, b, c, d] = corners.map(round::position);
    [Shape::Triangle { corners: [a, b, c], radiance }, Shape::Triangle { corners: [a, c, d], radiance }]
}
