//! No ray passes between triangles that share an edge or a corner, from either side, and none is stopped beside them.

use crate::promises::common::ground;
use citylights::base::random::Stream;
use citylights::render::exact::exact;
use citylights::scene::{Parts, Scene, Surface};
use citylights::sources::{Overrides, recipe};
use citylights::visibility::occluders::Occluders;
use citylights::visibility::offset::{Offset, Segment};
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Rays at each mesh, in all some ten million.
const RAYS: u64 = 42_000;
/// Meshes of either kind.
const MESHES: u64 = 120;

/// A mesh: its corners, and its triangles by their numbers.
struct Mesh {
    corners: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
}

impl Mesh {
    fn occluders(&self) -> Occluders {
        let surface = |of: &[usize; 3]| Surface { corners: of.map(|i| self.corners[i]), material: 0 };
        let surfaces = self.triangles.iter().map(surface).collect();
        let parts = Parts { surfaces, ..ground(1.0, Vec::new()) };
        Occluders::new(&Scene::new(parts).expect("a scene"))
    }

    /// A corner, a point of an edge or a point of a triangle of those allowed, in f64.
    fn place(&self, stream: &mut Stream, is_allowed: impl Fn(&[usize; 3]) -> bool) -> DVec3 {
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
fn closed(stream: &mut Stream) -> Mesh {
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

#[test]
fn nothing_leaks_out_of_a_closed_surface() {
    let leaks: u64 = (0..MESHES)
        .into_par_iter()
        .map(|nth| {
            let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"closed\0\0")]);
            let mesh = closed(&mut stream);
            let occluders = mesh.occluders();
            let size = mesh.corners.iter().map(|corner| corner.length()).fold(0.0, f32::max);
            let mut leaks = 0;
            for _ in 0..RAYS {
                let start = [0.0, 0.0, 0.2][stream.below(3)] * size;
                let origin = Vec3::new(stream.uniform() - 0.5, stream.uniform() - 0.5, stream.uniform() - 0.5) * start;
                let along = mesh.place(&mut stream, |_| true) - origin.as_dvec3();
                // In units of the scene, not all of length 1, and past the surface.
                let far = along.as_vec3() * 4.0;
                leaks += u64::from(occluders.first(origin, along.normalize()).is_none());
                leaks += u64::from(occluders.visible(&Segment::bare(origin, far, 0.0, 1.0)));
                leaks += u64::from(occluders.visible(&Segment::bare(origin + far, -far, 0.0, 1.0)));
            }
            leaks
        })
        .sum();
    assert_eq!(leaks, 0, "of {} rays", 3 * RAYS * MESHES);
}

/// A sheet over the square of half-width 1, scaled, tilted and moved; how many corners a side, and how rough it is.
fn sheet(stream: &mut Stream) -> (Mesh, usize, f64) {
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

#[test]
fn nothing_passes_through_a_sheet_and_everything_beside_it() {
    let wrong: u64 = (0..MESHES)
        .into_par_iter()
        .map(|nth| {
            let mut stream = Stream::keyed(&[nth, u64::from_le_bytes(*b"sheet\0\0\0")]);
            let (mesh, n, rough) = sheet(&mut stream);
            let occluders = mesh.occluders();
            let is_inner = |i: usize| (1..n - 1).contains(&(i / n)) && (1..n - 1).contains(&(i % n));
            let [low, across, up] = [0, n * (n - 1), n - 1].map(|i| mesh.corners[i].as_dvec3());
            let (across, up) = (across - low, up - low);
            let over = across.cross(up).normalize() * across.length();
            let mut wrong = 0;
            for _ in 0..RAYS {
                // From above or below, not too flat; through the inside, or beside the rim: by a thousandth of the side, and by as
                // much as the rim is rough.
                let target = mesh.place(&mut stream, |of| of.iter().all(|&i| is_inner(i)));
                let side = [over, -over][stream.below(2)];
                let lean = across * (stream.uniform64() - 0.5) + up * (stream.uniform64() - 0.5);
                let from = (target + side + [DVec3::ZERO, lean][stream.below(2)]).as_vec3();
                let way = target - from.as_dvec3();
                wrong += u64::from(occluders.first(from, way.normalize()).is_none());
                wrong += u64::from(occluders.visible(&Segment::bare(from, way.as_vec3() * 2.0, 0.0, 1.0)));
                let beside = low + up * stream.uniform64() - across * (2e-3 + rough);
                let start = (beside + side).as_vec3();
                let past = (beside - start.as_dvec3()) * 2.0;
                wrong += u64::from(!occluders.visible(&Segment::bare(start, past.as_vec3(), 0.0, 1.0)));
            }
            wrong
        })
        .sum();
    assert_eq!(wrong, 0, "of {} rays", 3 * RAYS * MESHES);
}

#[test]
fn a_roof_of_two_triangles_has_no_gap_along_its_diagonal() {
    let text = include_str!("../data/diagonal.toml");
    let scene = recipe::parse(text, "diagonal.toml".as_ref(), &Overrides::default()).expect("a scene");
    for (name, policy) in Offset::NAMED {
        let stage = Stage::new(scene.clone(), LeaveOut::Yes, policy);
        assert_eq!(stage.receivers().len(), 16 * 12, "{name}: the camera looks at the ground, below the roof");
        let lit = stage.receivers().iter().filter(|at| exact(&stage, at, 1, 1).mean() != DVec3::ZERO).count();
        assert_eq!(lit, 0, "{name}: pixels in the umbra are lit");
    }
}
