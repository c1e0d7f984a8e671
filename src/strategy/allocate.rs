//! How many points does each area light get, where a budget of them is shared out among receivers and lights?
//!
//! Every light is taken. Those without extent get one ray a pass; to each triangle a receiver gives `n` points on
//! average, each of weight `1 / n`, in proportion to the light's solid angle times its radiance times the receiver's
//! albedo. One factor for all receivers brings the mean over the image to `rays` points a receiver and pass, so that
//! bright receivers get more.
//!
//! `n` is no whole number. It is rounded up or down at random, by one number for all lights (systematic sampling): so a
//! light too weak for a point of its own is met now and then, with its weight, and nothing is lost.
//!
//! Source: the heuristic: the lecture on area lights that this project follows; the roulette: Arvo and Kirk, SIGGRAPH
//! 1990.

use super::parameters::Arguments;
use super::tally::Tally;
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::colour::luminance;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::triangle::Seen;
use crate::scene::Scene;
use crate::scene::light::{Kind, Light, LightId};
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::visibility::stage::Stage;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// `rays` points on triangles a receiver and pass, on average over the image.
pub struct Allocate {
    rays: f32,
}

impl Strategy for Allocate {
    const INFO: Info = Info {
        name: "allocate",
        summary: "takes every light; shares out points on triangles by solid angle, radiance and albedo",
        source: "the lecture's heuristic, made unbiased by Russian roulette (Arvo and Kirk, SIGGRAPH 1990)",
        claim: Claim::Unbiased,
        role: Role::Choosing,
    };
    type Sampler = Sampler;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        let rays = "points on triangles a receiver and pass, on average over the image";
        Ok(Self { rays: arguments.real("rays", 16.0, 0.015625..=4096.0, rays)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let receivers = context.stage.receivers();
        let most = PAIRS / context.stage.lights().len().max(1);
        let step = receivers.len().div_ceil(most.clamp(16, 4096)).max(1);
        let some: Vec<Receiver> = receivers.iter().copied().step_by(step).collect();
        Ok(Sampler::new(context.stage, &some, Weights::Heuristic, self.rays.into()))
    }
}

/// Receivers times lights that the mean number of points is taken over, about.
const PAIRS: usize = 4_000_000;

/// What points are shared out in proportion to.
pub enum Weights {
    /// Solid angle times radiance times albedo.
    Heuristic,
    /// Weights that are known already: by pixel, one for each triangle in the stage's order.
    Table(HashMap<u32, Vec<f32>>),
}

/// [`Allocate`] for a scene.
pub struct Sampler {
    scene: Arc<Scene>,
    triangles: Vec<LightId>,
    others: Vec<LightId>,
    weights: Weights,
    /// Points for each unit of weight.
    points: f64,
}

impl Sampler {
    /// A sampler that gives `rays` points to a receiver, on average over `receivers`.
    pub fn new(stage: &Stage, receivers: &[Receiver], weights: Weights, rays: f64) -> Self {
        let scene = Arc::clone(stage.scene());
        let extended = |&light: &LightId| scene.lights()[light as usize].kind() == Kind::Triangle;
        let (triangles, others): (Vec<_>, Vec<_>) = stage.lights().iter().copied().partition(extended);
        let mut sampler = Self { scene, triangles, others, weights, points: 0.0 };
        // Collected before it is summed: the sum must not depend on threads.
        let totals: Vec<f64> = receivers.par_iter().map(|at| sampler.weights(at).sum()).collect();
        let total: f64 = totals.iter().sum();
        sampler.points = if total > 0.0 { rays * receivers.len() as f64 / total } else { 0.0 };
        sampler
    }

    /// The weight of each triangle at a receiver.
    fn weights(&self, at: &Receiver) -> impl Iterator<Item = f64> {
        let albedo = f64::from(luminance(at.albedo));
        let row = match &self.weights {
            Weights::Table(rows) => rows.get(&at.pixel),
            Weights::Heuristic => None,
        };
        self.triangles.iter().enumerate().map(move |(i, &id)| {
            let light = &self.scene.lights()[id as usize];
            match &self.weights {
                Weights::Table(_) => row.map_or(0.0, |row| f64::from(row[i])),
                Weights::Heuristic if importance(light, at) <= 0.0 => 0.0,
                Weights::Heuristic => {
                    (solid_angle(light, at) * f64::from(luminance(light.colour)) * albedo).max(f64::MIN_POSITIVE)
                }
            }
        })
    }
}

/// Solid angle of a triangle light in steradians.
fn solid_angle(light: &Light, at: &Receiver) -> f64 {
    let first = light.position.as_dvec3() - at.position.as_dvec3();
    Seen::new([first, first + light.a.as_dvec3(), first + light.b.as_dvec3()]).solid_angle().abs()
}

impl LightSampler for Sampler {
    /// Points of each triangle at the receiver, summed up to it.
    type Scratch = Vec<f64>;

    fn arrive<T: Tally>(&self, at: &Receiver, ends: &mut Vec<f64>, tally: &mut T) {
        tally.weighed(self.triangles.len() as u64);
        ends.clear();
        let mut end = 0.0;
        ends.extend(self.weights(at).map(|weight| {
            end += weight * self.points;
            end
        }));
    }

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, ends: &mut Vec<f64>, out: &mut Picks<'_, T>) {
        for &light in &self.others {
            out.push_at(light, 1.0, [0.0; 2]);
        }
        let total = ends.last().copied().unwrap_or(0.0);
        let mut target = draws.choice(0, 1);
        let mut next = 0;
        while target < total {
            next += ends[next..].partition_point(|&end| end <= target);
            let start = if next == 0 { 0.0 } else { ends[next - 1] };
            let (light, points) = (self.triangles[next], ends[next] - start);
            // All points of one light in all passes are one sequence.
            let (weight, of) = ((1.0 / points).min(f64::from(f32::MAX)) as f32, points.ceil().max(1.0) as u32);
            let mut j = 0;
            while target < ends[next] {
                out.push_at(light, weight, draws.nested(j, of, |draws| draws.point_of(light)));
                target += 1.0;
                j += 1;
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        self.others.iter().for_each(|&light| counts[light as usize] += 1.0);
        for (&light, weight) in self.triangles.iter().zip(self.weights(at)) {
            counts[light as usize] += (weight * self.points) as f32;
        }
        true
    }

    fn heap_bytes(&self) -> usize {
        let table = match &self.weights {
            Weights::Table(rows) => {
                let row = size_of::<(u32, Vec<f32>)>() + self.triangles.len() * size_of::<f32>();
                rows.len() * row
            }
            Weights::Heuristic => 0,
        };
        size_of_val(&self.triangles[..]) + size_of_val(&self.others[..]) + table
    }
}
