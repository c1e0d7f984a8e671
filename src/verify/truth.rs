//! What does each light really add at a receiver?

use crate::base::colour::luminance;
use crate::base::random::Stream;
use crate::base::statistics::Moments;
use crate::base::triangle::nearest_squared;
use crate::render::exact::{grid_side, shadowed, stratified};
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::visibility::stage::Stage;
use glam::DVec3;
use std::f64::consts::PI;

/// Independent repetitions of the stratified points on triangles.
pub(super) const REPEATS: usize = 8;

/// The radiance that each light of a scene adds at one receiver, as luminance in cd/m^2.
pub(crate) struct Truth {
    /// Of the triangles that add anything: few of a city's do.
    triangles: Vec<(u32, [f64; REPEATS])>,
    mean: Vec<f64>,
    total: f64,
    /// What could arrive with nothing in between, about.
    open: f64,
    /// The least that is more than rounding.
    least: f64,
}

/// A surface that a light just grazes gets what rounding leaves of it, as a share of what it would get facing the light.
const GRAZING: f64 = 1e-7;

impl Truth {
    /// Evaluates every light of the scene, whatever the stage leaves out, with `points` points shared out among
    /// triangles in each of 8 repetitions, on top of one a light.
    pub(crate) fn new(stage: &Stage, at: &Receiver, points: u32, seed: u64) -> Self {
        let lights = stage.scene().lights();
        let mut rays = 0;
        let all = || lights.iter().zip(0u32..).filter(|(light, _)| light.kind() == Kind::Triangle);
        let weigh = |light: &Light| f64::from(importance(light, at));
        let total: f64 = all().map(|(light, _)| weigh(light)).sum();
        let open = lights.iter().map(weigh).sum::<f64>() * f64::from(luminance(at.albedo)) / PI;
        let mut mean = vec![0.0; lights.len()];
        for (value, light) in mean.iter_mut().zip(lights).filter(|(_, light)| light.kind() != Kind::Triangle) {
            *value = grey(shadowed(stage, stage.light_sampling(), at, light, [0.0; 2], &mut rays));
        }
        let mut triangles = Vec::new();
        for (light, id) in all() {
            let share = weigh(light) / total.max(f64::MIN_POSITIVE);
            let side = grid_side(points, share);
            let mut rng = Stream::keyed(&[seed, u64::from(at.pixel), u64::from(id), u64::from_le_bytes(*b"thetruth")]);
            let values: [f64; REPEATS] =
                std::array::from_fn(|_| grey(stratified(stage, at, light, side, &mut rng, &mut rays)));
            mean[id as usize] = values.iter().sum::<f64>() / REPEATS as f64;
            if mean[id as usize] > 0.0 {
                triangles.push((id, values));
            }
        }
        let total = mean.iter().sum();
        // What is hidden, or turned away, is exactly 0.
        let most: f64 =
            lights.iter().zip(&mean).filter(|(_, mean)| **mean > 0.0).map(|(light, _)| facing(light, at)).sum();
        // Below its least normal number f32 loses digits.
        let least = (GRAZING * most).max(lights.len() as f64 * f64::from(f32::MIN_POSITIVE));
        Self { triangles, mean, total, open, least }
    }

    /// What each light adds.
    pub(crate) fn lights(&self) -> &[f64] {
        &self.mean
    }

    /// What all lights add.
    pub(crate) fn total(&self) -> f64 {
        self.total
    }

    /// Whether some light arrives, but no more than rounding may make.
    pub(super) fn dim(&self) -> bool {
        self.total > 0.0 && self.total < self.least
    }

    /// How much arrives of what could, about: the rest is in shadow.
    pub(super) fn lit(&self) -> f64 {
        if self.open > 0.0 { self.total / self.open } else { 0.0 }
    }

    /// Whether a light adds anything that f32 can tell from nothing beside the rest.
    pub(crate) fn adds(&self, light: usize) -> bool {
        self.mean[light] > 1e-8 * self.total
    }

    /// What a light without extent adds; `None` for a triangle, where it depends on the point.
    pub(super) fn of_delta(&self, light: u32, kind: Kind) -> Option<f64> {
        (kind != Kind::Triangle).then(|| self.mean[light as usize])
    }

    /// Sum over the lights that are `wanted`, from each of the repetitions.
    pub(super) fn sum(&self, wanted: impl Fn(usize) -> bool) -> Moments {
        let all: f64 = self.mean.iter().enumerate().filter(|(i, _)| wanted(*i)).map(|(_, value)| value).sum();
        let mut repeats = [all; REPEATS];
        for (id, values) in self.triangles.iter().filter(|(id, _)| wanted(*id as usize)) {
            repeats.iter_mut().zip(values).for_each(|(sum, value)| *sum += value - self.mean[*id as usize]);
        }
        Moments::of(repeats)
    }
}

/// The radiance that would come of a light at most if the surface faced it, with nothing in between.
pub(super) fn facing(light: &Light, at: &Receiver) -> f64 {
    let over = |away2: f32| f64::from(luminance(light.peak_intensity())) / f64::from(away2.max(f32::MIN_POSITIVE));
    let irradiance = match light.kind() {
        Kind::Directional => f64::from(luminance(light.colour)),
        Kind::Point | Kind::Spot => over(light.position.distance_squared(at.position)),
        // One that fills the sky gives pi times its radiance.
        Kind::Triangle => over(nearest_squared(light.position - at.position, light.a, light.b))
            .min(PI * f64::from(luminance(light.colour))),
    };
    irradiance * f64::from(luminance(at.albedo)) / PI
}

/// Luminance in f64. A weight is one number for all channels, so one number tells all.
pub(super) fn grey(rgb: DVec3) -> f64 {
    f64::from(luminance(rgb.as_vec3()))
}
