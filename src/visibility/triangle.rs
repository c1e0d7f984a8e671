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

/// How a ray sees corners.
#[derive(Clone, Copy)]
pub(super) struct View {
    /// Two axes across, and the axis of its largest component.
    axes: [usize; 3],
    /// Its start on these axes, in metres.
    origin: [f32; 3],
    /// How far it goes on the two axes across for each metre of depth.
    lean: [f32; 2],
}

impl View {
    /// That of a ray whose direction is not zero.
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        let deep = ray.direction.abs().max_position();
        let axes = [(deep + 1) % 3, (deep + 2) % 3, deep];
        let lean = [ray.direction[axes[0]] / ray.direction[deep], ray.direction[axes[1]] / ray.direction[deep]];
        Self { axes, origin: axes.map(|axis| ray.origin[axis]), lean }
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

    /// Where the line of a ray meets its plane, in multiples of the direction; infinite or no number where it does not.
    pub(super) fn depth(&self, origin: DVec3, direction: DVec3) -> f64 {
        let corner = Vec3::from(self.corners()[0]).as_dvec3();
        let normal = Vec3::from(self.normal).as_dvec3();
        normal.dot(corner - origin) / normal.dot(direction)
    }

    /// Where a ray meets it, in multiples of the ray's direction within its ends; infinity if nowhere.
    #[inline(always)]
    pub(super) fn meet(&self, ray: &Ray, view: &View) -> f32 {
        let [across, up, deep] = view.axes.map(|axis| self.axes[axis]);
        let depth = deep - view.origin[2];
        let x = (across - view.origin[0]) - depth * view.lean[0];
        let y = (up - view.origin[1]) - depth * view.lean[1];
        // Of the edge across from each corner.
        let [x1, x2] = [rotated(x), rotated(rotated(x))];
        let [y1, y2] = [rotated(y), rotated(rotated(y))];
        let edges = x1 * y2 - y1 * x2;
        let (below, above) = (edges.cmplt(Vec3A::ZERO).bitmask(), edges.cmpgt(Vec3A::ZERO).bitmask());
        if below != 0 && above != 0 {
            return f32::INFINITY;
        }
        if below | above != ALL && !holds(x, y) {
            return f32::INFINITY;
        }
        let t = self.at(ray, view, depth, edges);
        if t >= ray.tmin && t <= ray.tmax { t } else { f32::INFINITY }
    }

    /// Where a ray that meets it does so: on its plane, and no nearer and no farther than its corners.
    #[inline(always)]
    fn at(&self, ray: &Ray, view: &View, depth: Vec3A, edges: Vec3A) -> f32 {
        let [x, y, z] = self.axes;
        let corner = Vec3A::new(x[0], y[0], z[0]) - ray.origin;
        let t = self.normal.dot(corner) / self.normal.dot(ray.direction);
        let of_a_metre = 1.0 / ray.direction[view.axes[2]];
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

/// Whether the origin lies in the triangle of these corners, its edges included, and that has an area; exactly.
#[cold]
#[inline(never)]
fn holds(x: Vec3A, y: Vec3A) -> bool {
    let (x, y) = (x.to_array().map(f64::from), y.to_array().map(f64::from));
    let edge = |i: usize, j: usize| x[i] * y[j] - y[i] * x[j];
    let edges = [edge(1, 2), edge(2, 0), edge(0, 1)];
    let (below, above) = (edges.iter().any(|&e| e < 0.0), edges.iter().any(|&e| e > 0.0));
    below != above
}
