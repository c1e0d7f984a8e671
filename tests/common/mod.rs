//! Scenes small enough to reason about, made from parts.

#![allow(dead_code, unreachable_pub, reason = "each test file uses a part of this module")]

use citylights::base::random::{RunKey, Stream};
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::camera::Camera;
use citylights::scene::light::Shape;
use citylights::scene::receiver::Receiver;
use citylights::scene::{Material, Parts, Scene, Surface};
use citylights::strategy::BuildContext;
use citylights::strategy::erased::AnySampler;
use citylights::strategy::registry;
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};

/// Albedo of everything in these scenes.
pub const ALBEDO: f32 = 0.3;

/// Parts with a ground square of half side `half` at height 0 and a camera over it that looks down obliquely.
pub fn ground(half: f32, lights: Vec<Shape>) -> Parts {
    let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, 0.0);
    let (a, b, c, d) = (corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0));
    Parts {
        name: "test".into(),
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

/// A camera of 40 x 30 pixels.
pub fn camera(from: Vec3, to: Vec3) -> Camera {
    Camera::new(from, to, 60.0, 40, 30).expect("a camera")
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

/// Two triangles of an emissive rectangle whose front is the side of `edge1 x edge2`.
pub fn panel(corner: Vec3, edge1: Vec3, edge2: Vec3, radiance: f32) -> [Shape; 2] {
    let radiance = Vec3::splat(radiance);
    let far = corner + edge1 + edge2;
    [
        Shape::Triangle { corners: [corner, corner + edge1, far], radiance },
        Shape::Triangle { corners: [corner, far, corner + edge2], radiance },
    ]
}

pub fn point(position: Vec3, intensity: f32) -> Shape {
    Shape::Point { position, intensity: Vec3::splat(intensity) }
}

pub fn spot(position: Vec3, axis: Vec3, intensity: f32) -> Shape {
    Shape::Spot { position, axis: axis.normalize(), intensity: Vec3::splat(intensity), cos_inner: 0.9, cos_outer: 0.5 }
}

pub fn moon(towards: Vec3, irradiance: f32) -> Shape {
    Shape::Directional { towards: towards.normalize(), irradiance: Vec3::splat(irradiance) }
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
    lights.extend(panel(Vec3::new(-4.6, -1.5, 0.8), Vec3::Y * 1.2, Vec3::Z * 1.4, 300.0).map(flipped));
    lights.extend(panel(Vec3::new(2.2, 2.9, 1.0), Vec3::X * 1.5, Vec3::Z * 0.8, 200.0));
    lights.extend(panel(Vec3::new(-1.0, -4.0, 3.5), Vec3::Y * 0.6, Vec3::X * 2.0, 400.0));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-4.5, -2.0, 0.0), Vec3::new(-2.5, 1.0, 3.0)));
    parts.surfaces.extend(cuboid(Vec3::new(1.5, 3.0, 0.0), Vec3::new(5.0, 5.0, 2.5)));
    parts.surfaces.extend(cuboid(Vec3::new(3.0, -6.0, 0.0), Vec3::new(4.0, -5.0, 4.0)));
    parts
}

fn flipped(shape: Shape) -> Shape {
    match shape {
        Shape::Triangle { corners: [a, b, c], radiance } => Shape::Triangle { corners: [a, c, b], radiance },
        other => other,
    }
}

/// A stage with everything default.
pub fn stage(parts: Parts) -> Stage {
    stage_with(parts, LeaveOut::Yes, Offset::SCALED)
}

pub fn stage_with(parts: Parts, leave_out: LeaveOut, offset: Offset) -> Stage {
    Stage::new(Scene::new(parts).expect("a scene"), leave_out, offset)
}

/// A receiver made by hand.
pub fn receiver(position: Vec3, normal: Vec3) -> Receiver {
    Receiver { position, normal, view: normal, albedo: Vec3::splat(ALBEDO), pixel: 0, surface: 0 }
}

/// A sampler of a registered strategy.
pub fn sampler(strategy: &str, stage: &Stage) -> Box<dyn AnySampler> {
    registry::parse(strategy).expect(strategy).build(BuildContext { stage, seed: 1 }).expect(strategy)
}

/// Expected counts of a registered strategy at a receiver.
pub fn expected(strategy: &str, stage: &Stage, at: &Receiver) -> Vec<f32> {
    let mut counts = vec![0.0; stage.scene().lights().len()];
    assert!(sampler(strategy, stage).expected_counts(at, &mut counts));
    counts
}

/// The image of a registered strategy: mean radiance of each receiver.
pub fn image(strategy: &str, stage: &Stage, passes: u32) -> Vec<Vec3> {
    let sampler = sampler(strategy, stage);
    let mut film = Film::new(stage.receivers().len());
    let key = RunKey { seed: 1, run: 0 };
    Plan { stage, receivers: stage.receivers(), sampler: &*sampler, key }.run_parallel(passes, &mut film);
    film.image()
}

/// A direction uniform over the sphere.
pub fn on_sphere(stream: &mut Stream) -> Vec3 {
    let z = stream.uniform64() * 2.0 - 1.0;
    let (sin, cos) = (stream.uniform64() * std::f64::consts::TAU).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos, r * sin, z).as_vec3()
}

/// Bits of an image, for comparing bytes.
pub fn bits(image: &[Vec3]) -> Vec<[u32; 3]> {
    image.iter().map(|rgb| rgb.to_array().map(f32::to_bits)).collect()
}
