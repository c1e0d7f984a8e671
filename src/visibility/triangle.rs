//! Where does a ray meet a triangle, so that none passes between two that share an edge?
//!
//! Corners are seen along the ray: its largest direction component becomes the depth, and a shear turns the ray into the
//! depth axis. Three edge functions of the two coordinates that are left say on which side of each edge the ray passes.
//! Both triangles at an edge get the same number, with opposite signs, since a corner that they share is sheared to the
//! same bits. A difference of two rounded products never has the wrong sign, but may be zero without cause: its sign is
//! then asked of f64, in which the products are exact. A ray that meets an edge meets both triangles; one in a triangle's
//! own plane meets none.
//!
//! Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.

use glam::{DVec3, Vec3, Vec3A};
use obvhs::ray::Ray;

/// A triangle that blocks from both sides.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    /// The x of its three corners, their y, their z.
    axes: [Vec3A; 3],
    /// Twice the area long, on the side from which its corners run clockwise.
    normal: Vec3A,
}

/// How a ray sees corners whose largest component is that of the axis `DEEP`, 0 to 2.
#[derive(Clone, Copy)]
pub(super) struct View<const DEEP: usize> {
    /// How far it goes on the next two axes for each metre of depth.
    lean: [f32; 2],
}

impl<const DEEP: usize> View<DEEP> {
    /// The two axes across.
    const ACROSS: [usize; 2] = [(DEEP + 1) % 3, (DEEP + 2) % 3];

    /// That of a ray whose direction is not zero.
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        Self { lean: Self::ACROSS.map(|axis| ray.direction[axis] / ray.direction[DEEP]) }
    }
}

impl Triangle {
    /// The triangle of these corners, in metres.
    pub(super) fn new(corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners.map(Vec3A::from);
        let axes = [0, 1, 2].map(|axis| Vec3A::new(a[axis], b[axis], c[axis]));
        Self { axes, normal: (a - b).cross(c - a) }
    }

    /// Its corners.
    #[inline]
    pub(super) fn corners(&self) -> [Vec3A; 3] {
        let [x, y, z] = self.axes;
        [0, 1, 2].map(|corner| Vec3A::new(x[corner], y[corner], z[corner]))
    }

    /// Where the line of a ray that [meets](Self::meet) it does so, in multiples of the direction: on its plane.
    ///
    /// A triangle that looks too thin for f64 to tell is met at the place of its edges nearest to the line. So is one that the
    /// line passes beside, by less than the rounding of f32: the plane of one that is seen edge on lies anywhere.
    pub(super) fn depth(&self, origin: DVec3, direction: DVec3) -> f64 {
        let corners = self.corners().map(|corner| Vec3::from(corner).as_dvec3());
        let [a, b, c] = corners.map(|corner| corner - origin);
        let edges = [(a, b), (b, c), (c, a)];
        let sides = edges.map(|(p, q)| direction.dot(p.cross(q - p)));
        let (ab, ac) = (corners[1] - corners[0], corners[2] - corners[0]);
        let (normal, size) = (ab.cross(ac), ab.length_squared() + ac.length_squared());
        let area = normal.dot(direction);
        let is_within = sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0);
        if is_within && area.abs() > 1e-8 * direction.length() * size {
            return normal.dot(a) / area;
        }
        let along = |place: DVec3| place.dot(direction) / direction.length_squared();
        let nearest = edges.map(|(p, q)| {
            let [start, end] = [p, q].map(|place| place - along(place) * direction);
            let way = end - start;
            let share = (-start.dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            ((start + share * way).length_squared(), along(p.lerp(q, share)))
        });
        let [first, second, third] = nearest;
        let nearer = |a: (f64, f64), b: (f64, f64)| if b.0 < a.0 { b } else { a };
        nearer(nearer(first, second), third).1
    }

    /// [`meet`](Self::meet), whatever the direction of the ray.
    pub(super) fn any_meet(ray: &Ray) -> impl Fn(&Self, &Ray) -> f32 + use<> {
        let (deep, x, y, z) = (ray.direction.abs().max_position(), View::new(ray), View::new(ray), View::new(ray));
        move |triangle, ray| match deep {
            0 => triangle.meet::<0>(ray, &x),
            1 => triangle.meet::<1>(ray, &y),
            _ => triangle.meet::<2>(ray, &z),
        }
    }

    /// Where a ray meets it, in multiples of the ray's direction within its ends; infinity if nowhere.
    #[inline(always)]
    pub(super) fn meet<const DEEP: usize>(&self, ray: &Ray, view: &View<DEEP>) -> f32 {
        let from = |axis: usize| self.axes[axis] - ray.origin[axis];
        let ([across, up], depth) = (View::<DEEP>::ACROSS, from(DEEP));
        let x = from(across) - depth * view.lean[0];
        let y = from(up) - depth * view.lean[1];
        // Of the edge across from each corner.
        let [x1, x2] = [rotated(x), rotated(rotated(x))];
        let [y1, y2] = [rotated(y), rotated(rotated(y))];
        let edges = x1 * y2 - y1 * x2;
        let (below, above) = (edges.cmplt(Vec3A::ZERO).bitmask(), edges.cmpgt(Vec3A::ZERO).bitmask());
        if below != 0 && above != 0 {
            return f32::INFINITY;
        }
        let edges = if below | above == ALL { Some(edges) } else { exact(x, y) };
        let Some(edges) = edges else { return f32::INFINITY };
        let t = self.at(ray, depth, ray.direction[DEEP], edges);
        if t >= ray.tmin && t <= ray.tmax { t } else { f32::INFINITY }
    }

    /// Where a ray that meets it does so: on its plane, and no nearer and no farther than its corners.
    #[inline(always)]
    fn at(&self, ray: &Ray, depth: Vec3A, along: f32, edges: Vec3A) -> f32 {
        let [x, y, z] = self.axes;
        let corner = Vec3A::new(x[0], y[0], z[0]) - ray.origin;
        let t = self.normal.dot(corner) / self.normal.dot(ray.direction);
        let of_a_metre = 1.0 / along;
        let ends = [depth.min_element() * of_a_metre, depth.max_element() * of_a_metre];
        if (ends[0].min(ends[1])..=ends[0].max(ends[1])).contains(&t) {
            return t;
        }
        // The plane of a sliver may be turned by rounding: the corners, weighted, are not.
        let weighted = edges.dot(depth) / edges.element_sum() * of_a_metre;
        if weighted.is_finite() { weighted.clamp(ends[0].min(ends[1]), ends[0].max(ends[1])) } else { ends[0] }
    }
}

/// A bit for each edge.
const ALL: u32 = 0b111;

#[inline(always)]
fn rotated(v: Vec3A) -> Vec3A {
    use glam::Vec3Swizzles;
    v.yzx()
}

/// The edge functions of these corners, exact but for their last digits, where the origin lies in the triangle, its edges
/// included, and that has an area.
#[cold]
#[inline(never)]
fn exact(x: Vec3A, y: Vec3A) -> Option<Vec3A> {
    let (x, y) = (x.to_array().map(f64::from), y.to_array().map(f64::from));
    let edge = |i: usize, j: usize| x[i] * y[j] - y[i] * x[j];
    let edges = [edge(1, 2), edge(2, 0), edge(0, 1)];
    let (below, above) = (edges.iter().any(|&e| e < 0.0), edges.iter().any(|&e| e > 0.0));
    // As shares of the area, so that none underflows.
    (below != above).then(|| Vec3A::from_array(edges.map(|e| (e / edges.iter().sum::<f64>()) as f32)))
}
