//! Is a light seen, as f64 tells from the rounded numbers?
//!
//! Every triangle is tried, by Moeller and Trumbore's test in f64; the receiver's own triangle and the light's own are
//! left out. A ray starts on the receiver's own plane, at the place that its rounded position stands for.
//!
//! A ray is undecided where the answer hangs on less than the tolerance: where it passes some triangle's edge, or
//! begins or ends at some triangle, nearer than that; nearer measured across the ray, so that a shift of the ray by the
//! tolerance could change the answer, and only then.

use crate::base::triangle::uniform_point;
use crate::scene::Scene;
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use glam::{DVec3, Vec3};

/// What is there on the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Truth {
    /// Nothing.
    Lit,
    /// Something.
    Dark,
    /// Something or nothing: less than the tolerance decides.
    Undecided,
}

/// A straight way, in metres.
struct Way {
    /// Its start.
    origin: DVec3,
    /// Unit vector along it.
    direction: DVec3,
    /// Its length; may be infinite.
    length: f64,
}

/// Triangles as they were rounded.
pub(crate) struct Tracer {
    triangles: Vec<Triangle>,
}

/// How far from its place a ray of any right policy may start, in m: what less than this decides is undecided.
pub(crate) fn tolerance(scene: &Scene) -> f64 {
    let (low, high) = scene.bounds();
    1e-4 + f64::from(5.0 * f32::EPSILON * low.abs().max(high.abs()).max_element())
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
    /// All that blocks light in a scene: its surfaces, then its emissive triangles in the table's order.
    pub(crate) fn new(scene: &Scene) -> Self {
        let emitters = scene.lights().iter().filter(|light| light.kind() == Kind::Triangle);
        let surfaces = scene.surfaces().iter().map(|surface| surface.corners);
        Self::over(surfaces.chain(emitters.map(Light::corners)))
    }

    fn over(triangles: impl Iterator<Item = [Vec3; 3]>) -> Self {
        Self { triangles: triangles.map(Triangle::new).collect() }
    }

    /// What is between a receiver and the point `uv` of a light, with the tolerance, and whether nothing is without;
    /// `own` is the light's triangle, if it has one.
    pub(crate) fn sees(
        &self,
        tolerance: f64,
        at: &Receiver,
        (light, own): (&Light, Option<usize>),
        uv: [f32; 2],
    ) -> (Truth, bool) {
        let surface = at.surface as usize;
        let origin = self.on_plane(surface, at.position);
        let side = at.normal.as_dvec3().dot(self.unit_normal(surface)).signum();
        let way = if light.kind() == Kind::Directional {
            Way { origin, direction: light.position.as_dvec3().normalize(), length: f64::INFINITY }
        } else {
            let [b1, b2] = if own.is_some() { uniform_point(uv).map(f64::from) } else { [0.0; 2] };
            let [p, a, b] = [light.position, light.a, light.b].map(Vec3::as_dvec3);
            let to_light: DVec3 = p + a * b1 + b * b2 - origin;
            Way { origin, direction: to_light.normalize(), length: to_light.length() }
        };
        // What is all but at an end's horizon may come to lie on either side of it.
        let above = side * self.unit_normal(surface).dot(way.direction * way.length.min(1e6));
        let before = own.map_or(f64::INFINITY, |own| self.height(own, origin));
        let own = [Some(surface), own];
        match self.truth(&way, own, tolerance) {
            Truth::Lit if above.min(before) >= tolerance => (Truth::Lit, true),
            Truth::Dark if above.min(before) >= tolerance => (Truth::Dark, false),
            _ => (Truth::Undecided, above.min(before) > 0.0 && self.truth(&way, own, 0.0) == Truth::Lit),
        }
    }

    /// The place on the plane of a triangle that a rounded place near it stands for.
    fn on_plane(&self, triangle: usize, place: Vec3) -> DVec3 {
        let (place, normal) = (place.as_dvec3(), self.unit_normal(triangle));
        place - normal * self.height(triangle, place)
    }

    /// Height of a place over the plane of a triangle, on the side from which its corners run counter-clockwise.
    fn height(&self, triangle: usize, place: DVec3) -> f64 {
        self.unit_normal(triangle).dot(place - self.triangles[triangle].corner)
    }

    fn unit_normal(&self, triangle: usize) -> DVec3 {
        self.triangles[triangle].normal.normalize()
    }

    /// What is on the way but the triangles `own`; with a tolerance of 0 m, as good as never undecided.
    fn truth(&self, way: &Way, own: [Option<usize>; 2], tolerance: f64) -> Truth {
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
        let tracer = Tracer::over([[Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0]].into_iter());
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
