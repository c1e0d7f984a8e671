//! Which scenes show soft shadows?

use crate::base::error::Result;
use crate::scene::camera::Camera;
use crate::scene::light::Shape;
use crate::scene::{Material, Parts, Scene, Surface};
use crate::sources::small::{cuboid, ground, panel};
use crate::study::session::Session;
use glam::Vec3;

/// Sizes of the one light: what the lecture calls them, and the side of a square in m.
pub(super) const SIZES: [(&str, f32); 4] = [("very small", 0.05), ("small", 0.3), ("medium", 1.0), ("large", 3.0)];

/// Intensity of the one light along its normal, in cd, whatever its size.
const CANDELA: f32 = 400.0;

/// Pixels across and down of a picture, where nothing else is asked for.
const RESOLUTION: (u32, u32) = (192, 128);

/// Exposure value of the pictures.
const EV100: f32 = 3.2;

/// A square of side `side` around `centre` that shines towards `to`, of that intensity along its normal in cd.
fn square(centre: Vec3, to: Vec3, [across, up]: [f32; 2], candela: f32) -> [Shape; 2] {
    let axis = (to - centre).normalize();
    let right = axis.cross(Vec3::Z).normalize_or(Vec3::X);
    let (edge1, edge2) = (right * across, axis.cross(right) * up);
    // The front is the side of `edge1 x edge2`.
    let edges = if edge1.cross(edge2).dot(axis) > 0.0 { (edge1, edge2) } else { (edge2, edge1) };
    panel(centre - 0.5 * (edge1 + edge2), edges.0, edges.1, candela / (across * up))
}

/// Height of the one light in m.
pub(super) const HEIGHT: f32 = 4.0;

/// A post on a plain, lit by one square light of side `side` at a height, both in m.
pub(super) fn one_light(session: &Session<'_>, side: f32, height: f32) -> Result<Scene> {
    let mut parts = ground(30.0, square(Vec3::new(-3.0, -1.5, height), Vec3::ZERO, [side; 2], CANDELA).to_vec());
    parts.surfaces.extend(cuboid(Vec3::new(-0.4, -0.4, 0.0), Vec3::new(0.4, 0.4, 1.6)));
    seen(session, parts, format!("one-light-{side}-at-{height}"), Vec3::new(3.4, -4.6, 3.6), Vec3::new(0.9, 0.3, 0.3))
}

/// Posts and walls, dark and bright, under six lights from a lamp to a sign, near and far, open and hidden.
pub(super) fn several_lights(session: &Session<'_>) -> Result<Scene> {
    let floor = Vec3::ZERO;
    let lights = [
        square(Vec3::new(-3.0, -1.5, 4.0), floor, [1.0, 1.0], 300.0),
        square(Vec3::new(2.5, 2.0, 2.6), Vec3::new(1.5, 1.0, 0.0), [0.1, 0.1], 120.0),
        square(Vec3::new(0.0, 11.0, 4.0), floor, [4.0, 2.0], 1500.0),
        square(Vec3::new(3.2, -1.5, 2.8), Vec3::new(1.0, 0.0, 0.0), [3.0, 0.1], 200.0),
        square(Vec3::new(-2.2, 3.2, 0.9), Vec3::new(-1.0, 0.0, 0.4), [1.2, 0.8], 150.0),
        square(Vec3::new(0.7, 0.7, 0.5), Vec3::new(3.0, 3.0, 0.0), [0.4, 0.4], 60.0),
    ];
    let mut parts = ground(30.0, lights.concat());
    let mut stand = |low: [f32; 3], high: [f32; 3], material: u32| {
        let boxes = cuboid(low.into(), high.into()).into_iter();
        parts.surfaces.extend(boxes.map(|surface| Surface { material, ..surface }));
    };
    stand([-0.4, -0.4, 0.0], [0.4, 0.4, 1.6], 0);
    stand([1.6, -0.8, 0.0], [1.9, 1.4, 0.9], 1);
    stand([-3.0, 4.0, 0.0], [3.0, 4.3, 2.6], 2);
    let material = |name: &str, albedo| Material { name: name.into(), albedo: Vec3::splat(albedo), street: false };
    parts.materials.extend([material("dark", 0.06), material("bright", 0.75)]);
    seen(session, parts, "several-lights".into(), Vec3::new(4.2, -6.4, 5.2), Vec3::new(0.4, 0.8, 0.4))
}

fn seen(session: &Session<'_>, parts: Parts, name: String, from: Vec3, to: Vec3) -> Result<Scene> {
    let (width, height) = session.options.overrides.resolution.unwrap_or(RESOLUTION);
    let camera = Camera::new(from, to, 42.0, width, height)?;
    Scene::new(Parts { name, camera, ev100: Some(EV100), ..parts })
}
