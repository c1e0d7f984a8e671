//! What does each pixel of the camera see?

use super::occluders::{Met, Occluders};
use crate::base::error::{Error, Result};
use crate::scene::Scene;
use crate::scene::light::{Kind, Light, LightId};
use crate::scene::receiver::Receiver;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// What a pixel sees through its centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// Nothing.
    Sky,
    /// The front of an emissive triangle.
    Emitter(LightId),
    /// The dark back of an emissive triangle.
    EmitterBack,
    /// A surface: its receiver's index.
    Receiver(u32),
}

/// All that a camera sees.
pub struct View {
    width: u32,
    height: u32,
    receivers: Vec<Receiver>,
    pixels: Vec<Seen>,
}

/// Pixels are walked in squares of this side, so that neighbours in the list see the same part of the scene.
const SQUARE: u32 = 8;

impl View {
    /// Casts one ray through each pixel's centre.
    pub fn new(scene: &Scene, occluders: &Occluders) -> Self {
        let (width, height) = scene.camera().resolution();
        let squares: Vec<(u32, u32)> = (0..height)
            .step_by(SQUARE as usize)
            .flat_map(|y| (0..width).step_by(SQUARE as usize).map(move |x| (x, y)))
            .collect();
        let found: Vec<(u32, Found)> = squares
            .par_iter()
            .flat_map_iter(|&(x0, y0)| {
                let rows = y0..(y0 + SQUARE).min(height);
                rows.flat_map(move |y| (x0..(x0 + SQUARE).min(width)).map(move |x| (x, y)))
            })
            .map(|(x, y)| {
                let (eye, direction, pixel) =
                    (scene.camera().position(), scene.camera().direction(x, y), y * width + x);
                (pixel, look(scene, occluders, eye, direction, pixel))
            })
            .collect();
        let mut receivers = Vec::new();
        let mut pixels = vec![Seen::Sky; found.len()];
        for (pixel, found) in found {
            pixels[pixel as usize] = match found {
                Found::Other(seen) => seen,
                Found::Surface(receiver) => {
                    receivers.push(receiver);
                    Seen::Receiver(receivers.len() as u32 - 1)
                }
            };
        }
        Self { width, height, receivers, pixels }
    }

    /// Pixels across and down.
    pub fn resolution(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The visible points, neighbours together.
    pub fn receivers(&self) -> &[Receiver] {
        &self.receivers
    }

    /// What each pixel sees, row by row from the top.
    pub fn pixels(&self) -> &[Seen] {
        &self.pixels
    }

    /// What the pixel in column `x` and row `y` sees, both from the upper left corner.
    ///
    /// # Errors
    /// A pixel outside the film.
    pub fn seen(&self, x: u32, y: u32) -> Result<Seen> {
        let (width, height) = self.resolution();
        if x >= width || y >= height {
            return Err(Error::Invalid(format!("pixel {x},{y} lies outside the {width} x {height} film")));
        }
        Ok(self.pixels[(y * width + x) as usize])
    }

    /// Shares of the pixels that see the sky and that see an emitter from either side.
    pub(crate) fn shares(&self) -> (f64, f64) {
        let share = |wanted: fn(&Seen) -> bool| {
            self.pixels.iter().filter(|seen| wanted(seen)).count() as f64 / self.pixels.len().max(1) as f64
        };
        (share(|s| *s == Seen::Sky), share(|s| matches!(s, Seen::Emitter(_) | Seen::EmitterBack)))
    }
}

/// What a ray meets.
pub(super) enum Found {
    /// No surface.
    Other(Seen),
    /// A surface, and the point of it.
    Surface(Receiver),
}

/// The emitter that is seen where a ray along `direction` meets emitter `id`, if it shows its front.
///
/// One that shines from both sides is two triangles in one place, next to each other in the table; the ray may meet
/// either.
fn facing(lights: &[Light], id: LightId, direction: DVec3) -> Option<LightId> {
    let front = |light: &Light| light.c.as_dvec3().dot(direction) < 0.0;
    let met = &lights[id as usize];
    let turned = |other: &Light| {
        other.kind() == Kind::Triangle && (other.position, other.a, other.b) == (met.position, met.b, met.a)
    };
    if front(met) {
        return Some(id);
    }
    let mut beside = [id.checked_sub(1), Some(id + 1)].into_iter().flatten();
    beside.find(|&id| lights.get(id as usize).is_some_and(|light| turned(light) && front(light)))
}

/// What a ray of a pixel from `eye` meets, seen from there.
pub(super) fn look(scene: &Scene, occluders: &Occluders, eye: Vec3, direction: DVec3, pixel: u32) -> Found {
    let Some((met, t)) = occluders.first(eye, direction) else { return Found::Other(Seen::Sky) };
    let index = match met {
        Met::Surface(index) => index,
        Met::Light(id) => {
            return Found::Other(facing(scene.lights(), id, direction).map_or(Seen::EmitterBack, Seen::Emitter));
        }
    };
    let surface = &scene.surfaces()[index as usize];
    let [p, q, r] = surface.corners.map(Vec3::as_dvec3);
    let normal = (q - p).cross(r - p).normalize();
    let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
    Found::Surface(Receiver {
        position: (eye.as_dvec3() + direction * t).as_vec3(),
        normal: normal.as_vec3(),
        view: -direction.as_vec3(),
        albedo: scene.materials()[surface.material as usize].albedo,
        pixel,
        surface: index,
    })
}
