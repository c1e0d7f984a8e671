//! A plane of equal lamps with a facade in its midst: the city whose loss by a cut-off has a closed form.

use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::camera::Camera;
use crate::scene::light::Shape;
use crate::scene::receiver::Receiver;
use crate::scene::{Material, Parts, Scene, Surface};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Distance between lamps in m, about: one in each square of this side.
const PITCH: f64 = 20.0;
/// Range of a lamp at the lecture's cut-off of half a step, in m: that of a street lamp on a bright facade.
const RANGE: f64 = 60.0;
/// Height of the lamps and of the receivers in m.
const HEIGHT: f64 = 6.0;
/// Albedo of all there is.
const ALBEDO: f32 = 0.3;

/// A disc of lamps, one at a random place in each square of a grid, and receivers in the middle square at the lamps'
/// height, which look evenly in all directions.
pub(super) struct Plane {
    /// The lamps over a level ground; exposure is 1.
    pub(super) scene: Scene,
    /// Points of facades.
    pub(super) receivers: Vec<Receiver>,
    /// Radius of the disc in m.
    pub(super) radius: f64,
}

/// About `lights` lamps and exactly `receivers` receivers.
pub(super) fn plane(lights: u64, receivers: usize, seed: u64) -> Result<Plane> {
    let radius = PITCH * (lights as f64 / PI).sqrt();
    // Half a display step, of light that meets a facing surface: I albedo / (pi r^2) = 0.5 / 255.
    let candela = (RANGE * RANGE * PI * 0.5 / 255.0 / f64::from(ALBEDO)) as f32;
    let mut stream = Stream::keyed(&[seed, u64::from_le_bytes(*b"plane\0\0\0"), lights]);
    let cells = (radius / PITCH).ceil() as i64;
    let mut lamps = Vec::new();
    for x in -cells..=cells {
        for y in -cells..=cells {
            let [u, v] = [stream.uniform64(), stream.uniform64()];
            let at = DVec3::new((x as f64 + u - 0.5) * PITCH, (y as f64 + v - 0.5) * PITCH, HEIGHT);
            if at.truncate().length() < radius {
                lamps.push(Shape::Point { position: at.as_vec3(), intensity: Vec3::splat(candela) });
            }
        }
    }
    let receiver = |i: usize| {
        let (sin, cos) = (i as f64 / receivers as f64 * 2.0 * PI).sin_cos();
        let normal = Vec3::new(cos as f32, sin as f32, 0.0);
        let [u, v] = [stream.uniform64(), stream.uniform64()];
        let position = DVec3::new((u - 0.5) * PITCH, (v - 0.5) * PITCH, HEIGHT).as_vec3();
        Receiver { position, normal, view: normal, albedo: Vec3::splat(ALBEDO), pixel: i as u32, surface: 0 }
    };
    let receivers = (0..receivers).map(receiver).collect();
    let half = (radius + PITCH) as f32;
    let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, 0.0);
    let (a, b, c, d) = (corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0));
    let scene = Scene::new(Parts {
        name: format!("plane-{lights}"),
        seed,
        origin: DVec3::ZERO,
        lights: lamps,
        groups: Vec::new(),
        surfaces: vec![Surface { corners: [a, b, c], material: 0 }, Surface { corners: [a, c, d], material: 0 }],
        materials: vec![Material { name: "paving".into(), albedo: Vec3::splat(ALBEDO), street: true }],
        camera: Camera::new(Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.0, 1.0, 1.0), 60.0, 1, 1)?,
        ev100: None,
        notes: Vec::new(),
    })?;
    Ok(Plane { scene, receivers, radius })
}

/// Displayed value that lamps of an endless density out of a range lose, mean over the directions in which a facade
/// looks.
///
/// `2 n_c eps ln(R / r_c)` of a receiver that faces all lamps at once, with n_c lamps within the range r_c, the
/// displayed value `eps` at which it ends, and R the radius of the disc; a facade sees half of them at a mean clamped
/// cosine of 1/pi over the whole circle. n_c eps does not depend on the range: the loss grows as ln(R / r_c), whatever
/// the threshold.
pub(super) fn closed_form(range: f64, threshold: f64, radius: f64) -> f64 {
    let inside = PI * range * range / (PITCH * PITCH);
    2.0 * inside * threshold * (radius / range).max(1.0).ln() / PI
}
