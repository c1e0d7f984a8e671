//! Scenes small enough to reason about: what `verify` looks at where no scene is named, and what tests are made of.
//!
//! A ground, a few boxes, a camera above, and the light tables on which strategies go wrong: none, one, all the same,
//! all in one place, all behind the horizon, one that outshines the rest by twelve orders of magnitude.

use crate::scene::camera::Camera;
use crate::scene::light::Shape;
use crate::scene::{Material, Parts, Surface};
use glam::{DVec3, Vec3};

/// Albedo of everything in these scenes.
pub const ALBEDO: f32 = 0.3;

/// Every scene that is named here.
pub fn all() -> Vec<Parts> {
    let few = [
        spot(Vec3::new(-3.0, 0.0, 6.0), Vec3::new(0.2, 0.0, -1.0), 300.0),
        moon(Vec3::new(0.2, -0.4, 0.9), 0.25),
        point(Vec3::new(1.0, 2.0, 5.0), 100.0),
    ];
    let named = |name: &str, parts: Parts| Parts { name: name.into(), ..parts };
    let few = |name: &str, n: usize| named(name, ground(12.0, few[..n].to_vec()));
    vec![
        few("no-lights", 0),
        few("one-light", 1),
        few("two-lights", 2),
        few("three-lights", 3),
        named("sixteen", sixteen()),
        named("identical", ground(12.0, vec![point(Vec3::new(1.0, 1.0, 5.0), 100.0); 50])),
        named("one-place", one_place()),
        named("behind-horizon", behind_horizon()),
        named("giant", giant()),
    ]
}

/// Sixteen lights of all four kinds over a ground with boxes: colours, sizes and strengths differ.
pub fn sixteen() -> Parts {
    let mut lights = vec![
        point(Vec3::new(-6.0, 2.0, 4.0), 120.0),
        point(Vec3::new(5.0, -3.0, 3.0), 60.0),
        Shape::Point { position: Vec3::new(1.0, 6.0, 5.0), intensity: Vec3::new(200.0, 90.0, 20.0) },
        point(Vec3::new(-2.0, -7.0, 2.5), 40.0),
        point(Vec3::new(9.0, 9.0, 6.0), 300.0),
        spot(Vec3::new(0.0, 0.0, 7.0), Vec3::new(0.2, 0.1, -1.0), 500.0),
        spot(Vec3::new(7.0, 2.0, 6.0), Vec3::new(-0.6, 0.1, -1.0), 350.0),
        spot(Vec3::new(-7.0, -5.0, 6.0), Vec3::new(0.5, 0.5, -1.0), 350.0),
        spot(Vec3::new(-3.0, 8.0, 8.0), Vec3::new(0.0, -0.3, -1.0), 800.0),
        moon(Vec3::new(0.3, -0.5, 0.8), 2.0),
    ];
    // Windows in the walls of the boxes below, 10 cm in front of them, and a horizontal panel.
    lights.extend(panel(Vec3::new(-4.6, -1.5, 0.8), Vec3::Z * 1.4, Vec3::Y * 1.2, 300.0));
    lights.extend(panel(Vec3::new(2.2, 2.9, 1.0), Vec3::X * 1.5, Vec3::Z * 0.8, 200.0));
    lights.extend(panel(Vec3::new(-1.0, -4.0, 3.5), Vec3::Y * 0.6, Vec3::X * 2.0, 400.0));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-4.5, -2.0, 0.0), Vec3::new(-2.5, 1.0, 3.0)));
    parts.surfaces.extend(cuboid(Vec3::new(1.5, 3.0, 0.0), Vec3::new(5.0, 5.0, 2.5)));
    parts.surfaces.extend(cuboid(Vec3::new(3.0, -6.0, 0.0), Vec3::new(4.0, -5.0, 4.0)));
    parts
}

/// Lights of all kinds that have a place, in one; their strengths differ. And the moon.
fn one_place() -> Parts {
    let place = Vec3::new(-1.0, 2.0, 4.0);
    let mut lights: Vec<Shape> = (0..8).map(|i| point(place, 3f32.powi(i))).collect();
    for (x, intensity) in [(0.0, 500.0), (0.4, 200.0), (-0.4, 2_000.0)] {
        lights.push(spot(place, Vec3::new(x, 0.0, -1.0), intensity));
    }
    for radiance in [100.0, 2_000.0] {
        lights.extend(panel(place, Vec3::Y * 0.5, Vec3::X * 0.5, radiance));
    }
    lights.push(moon(Vec3::new(0.3, -0.5, 0.8), 0.25));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(1.5, 3.0, 0.0), Vec3::new(5.0, 5.0, 2.5)));
    parts
}

/// Lights below the ground that a camera above it never sees the effect of.
fn behind_horizon() -> Parts {
    let mut lights: Vec<Shape> = (0..20).map(|i| point(Vec3::new(i as f32 - 10.0, 0.0, -1.0), 100.0)).collect();
    lights.push(moon(Vec3::new(0.1, 0.1, -1.0), 5.0));
    lights.push(spot(Vec3::new(2.0, 2.0, -4.0), Vec3::Z, 500.0));
    lights.extend(panel(Vec3::new(-2.0, -2.0, -3.0), Vec3::X, Vec3::Y, 300.0));
    ground(12.0, lights)
}

/// Lamps, one of them 10^12 times as strong as the others, and a wall in whose shadow the others are all there is.
fn giant() -> Parts {
    let mut lights: Vec<Shape> =
        (0..30).map(|i| point(Vec3::new(i as f32 * 0.7 - 10.0, (i * 7 % 13) as f32 - 6.0, 3.0), 50.0)).collect();
    lights.insert(17, point(Vec3::new(0.0, 9.0, 3.0), 50e12));
    lights.push(moon(Vec3::new(0.3, -0.5, 0.8), 0.25));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-6.0, 2.0, 0.0), Vec3::new(6.0, 3.0, 4.0)));
    parts
}

/// Parts with a ground square of half side `half` at height 0 and a camera over it that looks down obliquely.
pub fn ground(half: f32, lights: Vec<Shape>) -> Parts {
    let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, 0.0);
    let (a, b, c, d) = (corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0));
    Parts {
        name: "small".into(),
        seed: 0,
        origin: DVec3::ZERO,
        lights,
        groups: Vec::new(),
        surfaces: vec![Surface { corners: [a, b, c], material: 0 }, Surface { corners: [a, c, d], material: 0 }],
        materials: vec![Material { name: "grey".into(), albedo: Vec3::splat(ALBEDO), street: true }],
        camera: camera(Vec3::new(0.3, -18.0, 14.0), Vec3::new(0.0, 1.0, 0.0)),
        ev100: None,
        notes: Vec::new(),
    }
}

/// A camera of 40 x 30 pixels at `from` that looks at `to`.
///
/// # Panics
/// If either is not finite, or both are in one place.
pub fn camera(from: Vec3, to: Vec3) -> Camera {
    Camera::new(from, to, 60.0, 40, 30).expect("a small film, an ordinary angle and a target away from the camera")
}

/// The twelve triangles of a box, fronts outside.
pub fn cuboid(low: Vec3, high: Vec3) -> Vec<Surface> {
    let corner = |i: usize| {
        let pick = |bit: usize, axis: usize| if i >> bit & 1 == 1 { high[axis] } else { low[axis] };
        Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    // Faces counter-clockwise from outside: -z, +z, -y, +y, -x, +x.
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
        .map(|corners| Surface { corners: corners.map(corner), material: 0 })
        .collect()
}

/// Two triangles of an emissive rectangle whose front is the side of `edge1 x edge2`; radiance in cd/m^2.
pub fn panel(corner: Vec3, edge1: Vec3, edge2: Vec3, radiance: f32) -> [Shape; 2] {
    let radiance = Vec3::splat(radiance);
    let far = corner + edge1 + edge2;
    [
        Shape::Triangle { corners: [corner, corner + edge1, far], radiance },
        Shape::Triangle { corners: [corner, far, corner + edge2], radiance },
    ]
}

/// A white point light; intensity in cd.
pub fn point(position: Vec3, intensity: f32) -> Shape {
    Shape::Point { position, intensity: Vec3::splat(intensity) }
}

/// A white spot light with cones of 26 and 60 degrees; peak intensity in cd.
pub fn spot(position: Vec3, axis: Vec3, intensity: f32) -> Shape {
    Shape::Spot { position, axis: axis.normalize(), intensity: Vec3::splat(intensity), cos_inner: 0.9, cos_outer: 0.5 }
}

/// A white directional light; irradiance in lx.
pub fn moon(towards: Vec3, irradiance: f32) -> Shape {
    Shape::Directional { towards: towards.normalize(), irradiance: Vec3::splat(irradiance) }
}
