//! Where do offsets fail: what stands in the scenes, and where are receivers?

use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::camera::Camera;
use crate::scene::light::Shape;
use crate::scene::receiver::Receiver;
use crate::scene::{Material, Parts, Scene, Surface};
use crate::sources::small::{self, ALBEDO, cuboid, panel, point};
use glam::{DVec3, Vec3};

/// What a scene tries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Geometry {
    /// A slope of many triangles under lamps, panels and the moon, with a box in the air.
    Flat,
    /// The same slope and kerbs on it, with lamps and panels 3 to 80 cm high.
    Grazing,
    /// A corner of thin walls, a floor, a lean-to at 15 degrees and stairs; lamps and panels stand inside, and outside
    /// from 2 cm behind the walls on.
    Concave,
}

impl Geometry {
    pub(super) const ALL: [Self; 3] = [Self::Flat, Self::Grazing, Self::Concave];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Grazing => "grazing",
            Self::Concave => "concave",
        }
    }

    /// The scene with `far` metres added to all its coordinates, then rounded: none is less than `far`.
    pub(super) fn baked(self, far: f64) -> Result<Scene> {
        let (surfaces, lights) = match self {
            Self::Flat => flat(),
            Self::Grazing => grazing(),
            Self::Concave => concave(),
        };
        let parts = Parts {
            name: self.name().into(),
            seed: 0,
            origin: DVec3::ZERO,
            lights,
            groups: Vec::new(),
            surfaces,
            materials: vec![Material { name: "grey".into(), albedo: Vec3::splat(ALBEDO), street: false }],
            camera: Camera::new(Vec3::splat(40.0), Vec3::ZERO, 60.0, 1, 1)?,
            ev100: None,
            notes: Vec::new(),
        };
        Scene::new(parts.baked(far))
    }
}

/// A point of any surface, on either side of it, half of them near its edges; rounded as a camera's rays round it.
pub(super) fn receiver(scene: &Scene, stream: &mut Stream, number: usize) -> Receiver {
    let index = stream.below(scene.surfaces().len());
    let [a, b, c] = scene.surfaces()[index].corners.map(Vec3::as_dvec3);
    let [mut u, mut v] = [stream.uniform64(), stream.uniform64()];
    if number.is_multiple_of(2) {
        // Within a few per cent of one side, seldom of a corner.
        u = u.powi(4);
    }
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let weights = match stream.below(3) {
        0 => [u, v, 1.0 - u - v],
        1 => [1.0 - u - v, u, v],
        _ => [v, 1.0 - u - v, u],
    };
    let place = a * weights[0] + b * weights[1] + c * weights[2];
    let front = (b - a).cross(c - a).normalize();
    let normal = if stream.below(2) == 0 { front } else { -front }.as_vec3();
    Receiver {
        position: place.as_vec3(),
        normal,
        view: normal,
        albedo: Vec3::splat(ALBEDO),
        pixel: number as u32,
        surface: index as u32,
    }
}

type Things = (Vec<Surface>, Vec<Shape>);

/// Side of the slope in m.
const SIDE: f32 = 24.0;
/// Squares along a side.
const SQUARES: u32 = 4;

/// Height of the slope.
fn height(x: f32, y: f32) -> f32 {
    2.0 + 0.11 * x + 0.07 * y
}

fn slope() -> Vec<Surface> {
    let step = SIDE / SQUARES as f32;
    let corner = |i: u32, j: u32| {
        let (x, y) = (i as f32 * step, j as f32 * step);
        Vec3::new(x, y, height(x, y))
    };
    let square = |n: u32| {
        let (i, j) = (n % SQUARES, n / SQUARES);
        quad([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)])
    };
    (0..SQUARES * SQUARES).flat_map(square).collect()
}

fn quad([a, b, c, d]: [Vec3; 4]) -> [Surface; 2] {
    [[a, b, c], [a, c, d]].map(|corners| Surface { corners, material: 0 })
}

fn flat() -> Things {
    let mut surfaces = slope();
    surfaces.extend(cuboid(Vec3::new(9.0, 8.0, 6.0), Vec3::new(14.0, 13.0, 6.3)));
    let lamps = [(3.0, 4.0, 9.0), (11.0, 10.0, 8.0), (12.0, 11.0, 7.0), (20.0, 5.0, 12.0), (7.0, 21.0, 10.0)];
    let mut lights: Vec<Shape> = lamps.map(|(x, y, z)| point(Vec3::new(x, y, z), 100.0)).into();
    lights.extend(panel(Vec3::new(5.0, 12.0, 9.0), Vec3::Y * 1.5, Vec3::X * 2.0, 100.0));
    lights.extend(panel(Vec3::new(15.0, 9.0, 7.0), Vec3::new(0.3, 2.0, 0.2), Vec3::new(1.0, -0.2, 0.6), 100.0));
    lights.push(small::moon(Vec3::new(0.4, -0.3, 0.6), 1.0));
    (surfaces, lights)
}

fn grazing() -> Things {
    let mut surfaces = slope();
    // Kerbs: on the slope, and a little into it.
    for (x, y) in [(6.5, 3.0), (15.0, 12.5), (19.0, 18.0)] {
        let low = Vec3::new(x, y, height(x, y) - 0.4);
        surfaces.extend(cuboid(low, low + Vec3::new(0.3, 4.0, 1.1)));
    }
    let over = |x: f32, y: f32, up: f32| Vec3::new(x, y, height(x, y) + up);
    let lamps = [(12.0, 12.0, 0.03), (3.0, 20.0, 0.1), (23.0, 1.0, 0.2), (-9.0, 9.0, 0.4), (30.0, 14.0, 0.8)];
    let mut lights: Vec<Shape> = lamps.map(|(x, y, up)| point(over(x, y, up), 100.0)).into();
    // Strips upright on the slope, 5 to 45 cm high, that shine over it.
    lights.extend(panel(over(10.0, 0.2, 0.05), Vec3::Z * 0.4, Vec3::new(4.0, 0.0, 0.44), 100.0));
    lights.extend(panel(over(0.2, 8.0, 0.05), Vec3::new(0.0, 6.0, 0.42), Vec3::Z * 0.4, 100.0));
    // 2 degrees over the slope.
    lights.push(small::moon(Vec3::new(-1.0, 0.2, -0.06), 1.0));
    (surfaces, lights)
}

fn concave() -> Things {
    let mut surfaces = Vec::new();
    // Floor, two walls on its sides, all a little askew so that no coordinate is shared.
    let corner = Vec3::new(4.0, 5.0, 3.0);
    let (east, north, up) = (Vec3::new(7.0, 0.31, 0.12), Vec3::new(-0.27, 6.0, 0.23), Vec3::new(0.11, -0.17, 3.2));
    surfaces.extend(quad([corner, corner + east, corner + east + north, corner + north]));
    surfaces.extend(quad([corner, corner + up, corner + up + east, corner + east]));
    surfaces.extend(quad([corner, corner + north, corner + north + up, corner + up]));
    // A lean-to that rises from the floor's far edge at 15 degrees, over the room.
    let lean = north * -0.6 + up * (0.6 * 6.0 * 0.268 / 3.2);
    let foot = corner + north;
    surfaces.extend(quad([foot, foot + lean, foot + lean + east, foot + east]));
    // Stairs along the second wall.
    for i in 0..4u8 {
        let at = corner + east * 0.55 + up * (0.05 * f32::from(i)) + north * (0.05 * f32::from(i));
        let (tread, riser) = (north * 0.05, up * 0.05);
        surfaces.extend(quad([at, at + riser, at + riser + east * 0.3, at + east * 0.3]));
        let top = at + riser;
        surfaces.extend(quad([top, top + tread, top + tread + east * 0.3, top + east * 0.3]));
    }
    let inside = |a: f32, b: f32, c: f32| corner + east * a + north * b + up * c;
    let lamps = [
        // Inside, one of them high and one under the lean-to.
        inside(0.5, 0.3, 0.8),
        inside(0.3, 0.8, 0.05),
        inside(0.9, 0.15, 0.4),
        // Outside: 3 cm and 30 cm behind the walls, over the lean-to, below the floor.
        inside(0.4, -0.005, 0.5),
        inside(0.6, -0.05, 0.3),
        inside(-0.004, 0.3, 0.3),
        inside(-0.05, 0.1, 0.1),
        inside(0.4, 0.7, 0.5),
        inside(0.5, 0.2, -0.01),
    ];
    let mut lights: Vec<Shape> = lamps.map(|place| point(place, 100.0)).into();
    // Panels 2 cm before the first wall, towards the room, and 2 cm behind it, towards the wall.
    lights.extend(panel(inside(0.2, 0.003_5, 0.4), up * 0.2, east * 0.2, 100.0));
    lights.extend(panel(inside(0.6, -0.003_5, 0.4), up * 0.2, east * 0.2, 100.0));
    (surfaces, lights)
}
