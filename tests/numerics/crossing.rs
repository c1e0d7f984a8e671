//! Where does a ray cross a mesh, and is it so near an outline of the mesh that rounding may say otherwise?

use super::meshes::Mesh;
use super::predicate::side;
use glam::{DVec3, Vec3};

/// A mesh with what its triangles lie within.
pub(super) struct Exactly<'a> {
    pub(super) mesh: &'a Mesh,
    /// Middles and radii of balls.
    balls: Vec<(DVec3, f64)>,
}

/// What is so of a ray, its direction taken as f32.
pub(super) struct Crossing {
    /// The triangles that it crosses ahead, edges and corners included, each with where, in multiples of the direction.
    /// A triangle whose plane it lies in is none.
    pub(super) met: Vec<(usize, f64)>,
    /// Whether it passes nearer than the margin to an edge that has all its triangles on one side, as the ray sees them: to
    /// the rim of an open mesh, or a fold. Everywhere else, triangles on both sides keep a ray that is moved by less than the
    /// margin from passing.
    pub(super) outline: bool,
    /// How flat it meets those that it meets or whose edges are that near, at the flattest: the cosine to the normal.
    pub(super) flat: f64,
}

impl<'a> Exactly<'a> {
    pub(super) fn new(mesh: &'a Mesh) -> Self {
        let ball = |of: &[usize; 3]| {
            let corners = of.map(|i| mesh.corners[i].as_dvec3());
            let middle = corners.iter().sum::<DVec3>() / 3.0;
            (middle, corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max))
        };
        Self { mesh, balls: mesh.triangles.iter().map(ball).collect() }
    }

    /// Of the ray from `origin`, which lies on no triangle, with a margin in metres.
    pub(super) fn crossing(&self, origin: Vec3, along: Vec3, margin: f64) -> Crossing {
        let unit = along.as_dvec3().normalize();
        let from = |place: DVec3| place - origin.as_dvec3();
        let aside = |place: DVec3| from(place) - unit * from(place).dot(unit);
        let corner = |i: usize| self.mesh.corners[i];
        // Edges near the ray, the lower number first, each with on which side its triangle's third corner is.
        let (mut met, mut edges, mut flat) = (Vec::new(), Vec::new(), f64::INFINITY);
        for (nth, &(middle, radius)) in self.balls.iter().enumerate() {
            if aside(middle).length_squared() > (radius + 2.0 * margin).powi(2) {
                continue;
            }
            let [a, b, c] = self.mesh.triangles[nth];
            let before = (met.len(), edges.len());
            let sides = [(b, c), (c, a), (a, b)].map(|(p, q)| side(along, origin, corner(p), corner(q)));
            let area = sides.iter().sum::<f64>();
            if area != 0.0 && (sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)) {
                let ahead = [a, b, c].map(|i| from(corner(i).as_dvec3()).dot(unit));
                let t = (0..3).map(|i| sides[i] / area * ahead[i]).sum::<f64>();
                met.extend((t > 0.0).then_some((nth, t / along.as_dvec3().length())));
            }
            for (p, q, third) in [(a, b, c), (b, c, a), (c, a, b)] {
                let (p, q) = (p.min(q), p.max(q));
                let [start, end] = [p, q].map(|i| aside(corner(i).as_dvec3()));
                let share = -start.dot(end - start) / (end - start).length_squared();
                let nearest = if share.is_nan() { start } else { start.lerp(end, share.clamp(0.0, 1.0)) };
                if nearest.length() < margin {
                    edges.push((p, q, side(along, corner(p), corner(q), corner(third))));
                }
            }
            if before != (met.len(), edges.len()) {
                flat = flat.min(self.cosine(nth, unit));
            }
        }
        edges.sort_by_key(|&(p, q, _)| (p, q));
        let is_inner = |of: &[(usize, usize, f64)]| matches!(of, [(_, _, one), (_, _, other)] if one * other < 0.0);
        let outline = !edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(is_inner);
        Crossing { met, outline, flat }
    }

    /// How far a place is from a triangle.
    pub(super) fn distance(&self, triangle: usize, place: DVec3) -> f64 {
        let [a, b, c] = self.mesh.triangles[triangle].map(|i| self.mesh.corners[i].as_dvec3() - place);
        let normal = (b - a).cross(c - a);
        let edge = |p: DVec3, q: DVec3| p.lerp(q, (-p.dot(q - p) / (q - p).length_squared()).clamp(0.0, 1.0)).length();
        let is_over = [(a, b), (b, c), (c, a)].iter().all(|&(p, q)| (q - p).cross(-p).dot(normal) >= 0.0);
        let over = if is_over { (a.dot(normal) / normal.length()).abs() } else { f64::INFINITY };
        over.min(edge(a, b)).min(edge(b, c)).min(edge(c, a))
    }

    fn cosine(&self, triangle: usize, unit: DVec3) -> f64 {
        let [a, b, c] = self.mesh.triangles[triangle].map(|i| self.mesh.corners[i].as_dvec3());
        (b - a).cross(c - a).normalize().dot(unit).abs()
    }
}
