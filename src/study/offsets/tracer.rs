//! Is a light seen, as f64 tells from the rounded numbers?
//!
//! Every triangle is tried, by Moeller and Trumbore's test in f64; the receiver's own triangle and the light's own are
//! left out. A ray starts on the receiver's own plane, at the place that its rounded position stands for.
//!
//! A ray is undecided where the answer hangs on less than the tolerance: where it passes some triangle's edge, or
//! begins or ends at some triangle, nearer than that; nearer measured across the ray, so that a shift of the ray by the
//! tolerance could change the answer, and only then.

use glam::{DVec3, Vec3};

/// What is there on the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Truth {
    /// Nothing.
    Lit,
    /// Something.
    Dark,
    /// Something or nothing: less than the tolerance decides.
    Undecided,
}

/// A straight way, in metres.
pub(super) struct Way {
    /// Its start.
    pub(super) origin: DVec3,
    /// Unit vector along it.
    pub(super) direction: DVec3,
    /// Its length; may be infinite.
    pub(super) length: f64,
}

/// Triangles as they were rounded.
pub(super) struct Tracer {
    triangles: Vec<Triangle>,
}

struct Triangle {
    corner: DVec3,
    edges: [DVec3; 2],
    /// The triangle's heights over its three sides.
    heights: [f64; 3],
    /// Twice the area long.
    normal: DVec3,
}

impl Tracer {
    pub(super) fn new(triangles: impl Iterator<Item = [Vec3; 3]>) -> Self {
        Self { triangles: triangles.map(Triangle::new).collect() }
    }

    /// The place on the plane of a triangle that a rounded place near it stands for.
    pub(super) fn on_plane(&self, triangle: usize, place: Vec3) -> DVec3 {
        let (place, normal) = (place.as_dvec3(), self.unit_normal(triangle));
        place - normal * self.height(triangle, place)
    }

    /// Height of a place over the plane of a triangle, on the side from which its corners run counter-clockwise.
    pub(super) fn height(&self, triangle: usize, place: DVec3) -> f64 {
        self.unit_normal(triangle).dot(place - self.triangles[triangle].corner)
    }

    pub(super) fn unit_normal(&self, triangle: usize) -> DVec3 {
        self.triangles[triangle].normal.normalize()
    }

    /// What is on the way but the triangles `own`; with a tolerance of 0 m, as good as never undecided.
    pub(super) fn truth(&self, way: &Way, own: [Option<usize>; 2], tolerance: f64) -> Truth {
        let mut truth = Truth::Lit;
        for (i, triangle) in self.triangles.iter().enumerate() {
            if own.contains(&Some(i)) {
                continue;
            }
            match triangle.on(way, tolerance) {
                Truth::Dark => return Truth::Dark,
                Truth::Undecided => truth = Truth::Undecided,
                Truth::Lit => {}
            }
        }
        truth
    }
}

impl Triangle {
    fn new(corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let edges = [b - a, c - a];
        let normal = edges[0].cross(edges[1]);
        let sides = [c - b, edges[1], edges[0]];
        Self { corner: a, edges, heights: sides.map(|side| normal.length() / side.length()), normal }
    }

    /// Whether it is on the way (Moeller and Trumbore 1997).
    fn on(&self, way: &Way, tolerance: f64) -> Truth {
        let [e1, e2] = self.edges;
        let from = way.origin - self.corner;
        let across = way.direction.cross(e2);
        let determinant = e1.dot(across);
        let cosine = determinant.abs() / self.normal.length();
        if cosine < 1e-12 {
            let off = self.normal.normalize().dot(from).abs();
            return if off < tolerance { Truth::Undecided } else { Truth::Lit };
        }
        let around = from.cross(e1);
        let b1 = from.dot(across) / determinant;
        let b2 = way.direction.dot(around) / determinant;
        let t = e2.dot(around) / determinant;
        // How far a shift of the ray by the tolerance moves the crossing, in the plane and along the ray.
        let reach = tolerance / cosine;
        let [h0, h1, h2] = self.heights;
        let inside = ((1.0 - b1 - b2) * h0).min(b1 * h1).min(b2 * h2);
        let along = t.min(way.length - t);
        if inside < -reach || along < -reach {
            Truth::Lit
        } else if inside > reach && along > reach {
            Truth::Dark
        } else {
            Truth::Undecided
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_is_lit_dark_or_undecided_by_the_tolerance() {
        let tracer = Tracer::new([[Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0]].into_iter());
        let down = |x: f64, y: f64, from: f64, length: f64| {
            let way = Way { origin: DVec3::new(x, y, from), direction: DVec3::NEG_Z, length };
            tracer.truth(&way, [None; 2], 1e-3)
        };
        assert_eq!(down(1.0, 1.0, 1.0, 2.0), Truth::Dark);
        for (x, y) in [(0.002, 1.0), (1.0, 0.002), (1.998, 1.998)] {
            assert_eq!(down(x, y, 1.0, 2.0), Truth::Dark, "just inside, at {x}, {y}");
        }
        for (x, y) in [(-0.002, 1.0), (1.0, -0.002), (2.002, 2.002)] {
            assert_eq!(down(x, y, 1.0, 2.0), Truth::Lit, "just outside, at {x}, {y}");
        }
        for (x, y) in [(0.0, 1.0), (1.0, 0.0005), (2.0, 2.0)] {
            assert_eq!(down(x, y, 1.0, 2.0), Truth::Undecided, "at an edge, at {x}, {y}");
        }
        let exactly = |x: f64| {
            let way = Way { origin: DVec3::new(x, 1.0, 1.0), direction: DVec3::NEG_Z, length: 2.0 };
            tracer.truth(&way, [None; 2], 0.0)
        };
        assert_eq!([exactly(1e-9), exactly(-1e-9)], [Truth::Dark, Truth::Lit], "without a tolerance");
        assert_eq!(down(1.0, 1.0, 1.0, 1.0005), Truth::Undecided, "ends at it");
        assert_eq!(down(1.0, 1.0, 1.0, 0.99), Truth::Lit, "ends before it");
        assert_eq!(down(1.0, 1.0, -0.01, f64::INFINITY), Truth::Lit, "begins behind it");
        let way = Way { origin: DVec3::new(1.0, 1.0, 1.0), direction: DVec3::NEG_Z, length: 2.0 };
        assert_eq!(tracer.truth(&way, [Some(0), None], 1e-3), Truth::Lit, "its own triangle");
        assert_eq!(tracer.on_plane(0, Vec3::new(1.0, 2.0, 0.25)), DVec3::new(1.0, 2.0, 0.0));
    }
}
