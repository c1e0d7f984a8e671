//! Meshes at random whose triangles share corners: closed ones, and sheets.

use crate::promises::common::ground;
use citylights::base::random::Stream;
use citylights::scene::{Parts, Scene, Surface};
use citylights::visibility::occluders::Occluders;
use glam::{DVec3, Vec3};

/// A mesh: its corners, and its triangles by their numbers.
pub(super) struct Mesh {
    pub(super) corners: Vec<Vec3>,
    pub(super) triangles: Vec<[usize; 3]>,
}

impl Mesh {
    pub(super) fn surfaces(&self) -> Vec<Surface> {
        self.triangles.iter().map(|of| Surface { corners: of.map(|i| self.corners[i]), material: 0 }).collect()
    }

    pub(super) fn occluders(&self) -> Occluders {
        let parts = Parts { surfaces: self.surfaces(), ..ground(1.0, Vec::new()) };
        Occluders::new(&Scene::new(parts).expect("a scene"))
    }

    /// How far its farthest corner is from the origin.
    pub(super) fn size(&self) -> f32 {
        self.corners.iter().map(|corner| corner.length()).fold(0.0, f32::max)
    }

    /// A corner, a point of an edge or a point of a triangle of those allowed, in f64.
    pub(super) fn place(&self, stream: &mut Stream, is_allowed: impl Fn(&[usize; 3]) -> bool) -> DVec3 {
        let [a, b, c] = loop {
            let triangle = &self.triangles[stream.below(self.triangles.len())];
            if is_allowed(triangle) {
                break triangle.map(|i| self.corners[i].as_dvec3());
            }
        };
        match stream.below(4) {
            0 => a,
            1 => a.midpoint(b),
            2 => b.lerp(c, stream.uniform64()),
            _ => a.lerp(b, stream.uniform64()).lerp(c, stream.uniform64()),
        }
    }
}

/// From 1e-3 to 1e6 m.
fn scale(stream: &mut Stream) -> f32 {
    10f64.powf(-3.0 + 9.0 * stream.uniform64()) as f32
}

/// Some round, some nearly so: then many corners and edges lie exactly on an axis or a diagonal.
fn wobble(stream: &mut Stream) -> f32 {
    [0.0, 0.0, 1e-6, 0.05, 0.3][stream.below(5)]
}

/// A closed surface around the origin.
pub(super) fn closed(stream: &mut Stream) -> Mesh {
    let (scale, wobble, n) = (scale(stream), wobble(stream), 2 + stream.below(7));
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    // A cube of n x n squares a side, each corner once.
    let mut known = std::collections::HashMap::new();
    let mut corner = |x: [usize; 3], stream: &mut Stream| {
        *known.entry(x).or_insert_with(|| {
            let at = Vec3::from(x.map(|i| 2.0 * i as f32 / n as f32 - 1.0));
            corners.push(at * scale * (1.0 + wobble * (stream.uniform() - 0.5)));
            corners.len() - 1
        })
    };
    for axis in 0..3 {
        for side in [0, n] {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut at = |i: usize, j: usize| {
                    let mut x = [0; 3];
                    (x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]) = (side, i, j);
                    corner(x, stream)
                };
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangles.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
            }
        }
    }
    // Some triangles face the other way: neighbours then run along their edge in the same direction.
    triangles.iter_mut().step_by(3).for_each(|triangle: &mut [usize; 3]| triangle.swap(0, 1));
    Mesh { corners, triangles }
}

/// A sheet over the square of half-width 1, scaled, tilted and moved; how many corners a side, and how rough it is.
pub(super) fn sheet(stream: &mut Stream) -> (Mesh, usize, f64) {
    let (scale, wobble, n) = (scale(stream), wobble(stream), 4 + stream.below(8));
    let level = stream.below(2) == 0;
    let turn = glam::Quat::from_rotation_x(if level { 0.0 } else { stream.uniform() * 3.0 });
    let shift = Vec3::new(stream.uniform(), stream.uniform(), stream.uniform()) * [0.0, 3.0][stream.below(2)];
    let mut corners = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [x, y] = [i, j].map(|i| 2.0 * i as f32 / (n - 1) as f32 - 1.0);
        let height = wobble * (stream.uniform() - 0.5);
        corners.push((turn * Vec3::new(x, y, height) + shift) * scale);
    }
    let mut triangles = Vec::new();
    for (i, j) in (0..n - 1).flat_map(|i| (0..n - 1).map(move |j| (i, j))) {
        let [a, b, c, d] = [i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1];
        triangles.extend(if stream.below(2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [d, b, c]] });
    }
    (Mesh { corners, triangles }, n, f64::from(wobble))
}
