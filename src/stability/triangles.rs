//! Which triangles, seen from the origin, are hard?

use crate::base::random::Stream;
use crate::base::triangle::Seen;
use glam::{DVec3, Vec3};

/// A triangle seen from the origin, all exact in f32.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Posed {
    /// The triangle.
    pub corners: [Vec3; 3],
    /// The receiver's normal, of unit length but for rounding.
    pub normal: Vec3,
}

impl Posed {
    /// The triangle in f64.
    pub(crate) fn seen(&self) -> Seen {
        Seen::new(self.corners.map(Vec3::as_dvec3))
    }

    /// The corners' coordinates in f64.
    pub(crate) fn coordinates(&self) -> [[f64; 3]; 3] {
        self.corners.map(|corner| corner.as_dvec3().to_array())
    }
}

/// A way to draw one.
pub(crate) type Draw = fn(&mut Stream) -> Posed;

/// All of them by name.
#[cfg(test)]
pub(crate) const FAMILIES: [(&str, Draw); 11] = [
    ("ordinary", ordinary),
    ("distant", distant),
    ("sliver", sliver),
    ("vertex", vertex),
    ("edge", edge),
    ("micro", micro),
    ("huge", huge),
    ("touching", touching),
    ("grazing", grazing),
    ("degenerate", degenerate),
    ("repeated", repeated),
];

/// A number by its order of magnitude: 10 to a uniform power.
pub(super) fn magnitude(stream: &mut Stream, low: f64, high: f64) -> f64 {
    10f64.powf(low + (high - low) * stream.uniform64())
}

fn signed(stream: &mut Stream) -> f64 {
    2.0 * stream.uniform64() - 1.0
}

/// A point within the cube of two metres.
pub(super) fn point(stream: &mut Stream) -> DVec3 {
    DVec3::new(signed(stream), signed(stream), signed(stream))
}

pub(super) fn direction(stream: &mut Stream) -> DVec3 {
    loop {
        let p = point(stream);
        if (0.01..1.0).contains(&p.length_squared()) {
            return p.normalize();
        }
    }
}

fn posed(stream: &mut Stream, corners: [DVec3; 3]) -> Posed {
    Posed { corners: corners.map(DVec3::as_vec3), normal: direction(stream).as_vec3() }
}

fn three(stream: &mut Stream, size: f64) -> [DVec3; 3] {
    [point(stream) * size, point(stream) * size, point(stream) * size]
}

/// About the receiver, of any solid angle.
pub(crate) fn ordinary(stream: &mut Stream) -> Posed {
    let corners = three(stream, 5.0);
    posed(stream, corners)
}

/// A metre large at 100 m to 100 km: down to 1e-10 sr.
pub(crate) fn distant(stream: &mut Stream) -> Posed {
    let centre = direction(stream) * magnitude(stream, 2.0, 5.0);
    let corners = three(stream, 1.5).map(|corner| centre + corner);
    posed(stream, corners)
}

/// A thousand to ten million times as long as wide.
pub(crate) fn sliver(stream: &mut Stream) -> Posed {
    let [a, b, c] = three(stream, 3.0);
    let centre = direction(stream) * magnitude(stream, 0.0, 1.5);
    let width = magnitude(stream, -6.5, -3.0);
    let corners = [a, b, a + (c - a) * width].map(|corner| centre + corner);
    posed(stream, corners)
}

/// A corner at the receiver, but for 0.1 mm and far less.
pub(crate) fn vertex(stream: &mut Stream) -> Posed {
    let [a, b, c] = three(stream, 3.0);
    let corners = [a * magnitude(stream, -12.0, -4.0), b, c];
    posed(stream, corners)
}

/// An ordinary one shrunk to the size of atoms and less.
pub(crate) fn micro(stream: &mut Stream) -> Posed {
    let size = magnitude(stream, -16.0, -9.0);
    let corners = three(stream, size);
    posed(stream, corners)
}

/// An ordinary one as large as the solar system.
pub(crate) fn huge(stream: &mut Stream) -> Posed {
    let size = magnitude(stream, 8.0, 12.0);
    let corners = three(stream, size);
    posed(stream, corners)
}

/// The receiver next to the inside of the triangle: nearly half the sphere.
pub(crate) fn touching(stream: &mut Stream) -> Posed {
    beside(stream, -6.0, -1.0)
}

/// The receiver in the plane of the triangle but for rounding, inside or beside it.
pub(crate) fn grazing(stream: &mut Stream) -> Posed {
    beside(stream, -12.0, -6.0)
}

/// The receiver by a point of the triangle's plane, between the two powers of ten of its size away from it.
fn beside(stream: &mut Stream, low: f64, high: f64) -> Posed {
    let [a, b, c] = three(stream, 4.0);
    let (s, t) = (signed(stream), signed(stream));
    let near = a + (b - a) * s + (c - a) * t;
    let lift = (b - a).cross(c - a).normalize() * (4.0 * magnitude(stream, low, high));
    let corners = [a, b, c].map(|corner| corner - near - lift);
    posed(stream, corners)
}

/// The receiver next to an edge, or on it but for rounding.
pub(crate) fn edge(stream: &mut Stream) -> Posed {
    let [a, b, c] = three(stream, 4.0);
    let near = a + (b - a) * stream.uniform64() + direction(stream) * magnitude(stream, -12.0, -2.0);
    let corners = [a, b, c].map(|corner| corner - near);
    posed(stream, corners)
}

/// Three corners on a line, but for rounding to f32.
pub(crate) fn degenerate(stream: &mut Stream) -> Posed {
    let [a, b, _] = three(stream, 3.0);
    let corners = [a, b, a + (b - a) * (3.0 * stream.uniform64())];
    posed(stream, corners)
}

/// Two corners that are one.
pub(crate) fn repeated(stream: &mut Stream) -> Posed {
    let [a, b, _] = three(stream, 3.0);
    let corners = [[a, a, b], [a, b, a], [b, a, a], [a, a, a]][stream.below(4)];
    posed(stream, corners)
}
