//! How many points does each area light get, where a budget of them is shared out among receivers and lights?
//!
//! Every light is taken. Those without extent get one ray a pass; to each triangle a receiver gives `n` points on average, in
//! proportion to the light's solid angle times its radiance times the receiver's albedo. One factor for
//! all receivers brings the mean over the image to `rays` points a receiver and pass, so that bright receivers get more.
//!
//! Each point weighs `1 / n`. From 1 on, `n` is rounded to a whole number, which adds no noise; below 1 it is the chance of a
//! point, drawn by one number for all lights (systematic sampling), so that nothing is lost.
//!
//! Source: the heuristic: the lecture on area lights that this project follows; the roulette: Arvo and Kirk, SIGGRAPH 1990.

use crate::base::colour::luminance;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::light::{Kind, LightId};
use crate::scene::receiver::Receiver;
use crate::shading::by_angle::seen;
use crate::shading::importance::importance;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};
use crate::visibility::stage::Stage;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// `rays` points on triangles a receiver and pass, on average over the image.
pub(crate) struct Allocate {
    rays: f32,
}

impl Strategy for Allocate {
    const INFO: Info = Info {
        name: "allocate",
        summary: "takes every light; shares out points on triangles by solid angle, radiance and albedo",
        source: "the lecture's heuristic, made unbiased by Russian roulette (Arvo and Kirk, SIGGRAPH 1990)",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "rays={4,16,64}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let rays = "points on triangles a receiver and pass, on average over the image";
        Ok(Self { rays: arguments.real("rays", 16.0, 0.015625..=4096.0, rays)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let receivers = context.stage.receivers();
        let most = PAIRS / context.stage.lights().len().max(1);
        let step = receivers.len().div_ceil(most.clamp(16, 4096)).max(1);
        let some: Vec<Receiver> = receivers.iter().copied().step_by(step).collect();
        Ok(Sampler::new(context.stage, &some, self.rays.into()))
    }
}

/// Least weight of a light, as a share of the irradiance that it is taken to send.
const LEAST: f64 = 1e-6;

/// Most points on one triangle in one pass.
const MOST: f64 = 16_384.0;

/// A triangle's importance and its solid angle take as long as so many importances alone.
const WEIGHED: u64 = 5;

/// Receivers times lights that the mean number of points is taken over, about.
const PAIRS: usize = 1_000_000;

/// What points are shared out in proportion to.
enum Weights {
    /// Solid angle times radiance times albedo.
    Heuristic,
    /// By pixel, one for each triangle in the stage's order.
    Table(HashMap<u32, Vec<f32>>),
}

/// Points of which there is one or more are whole.
fn whole(points: f64) -> f64 {
    if points < 1.0 { points } else { points.min(MOST).round() }
}

/// [`Allocate`] for a scene.
pub(crate) struct Sampler {
    scene: Arc<Scene>,
    triangles: Vec<LightId>,
    others: Vec<LightId>,
    weights: Weights,
    /// Points for each unit of weight.
    points: f64,
}

impl Sampler {
    /// A sampler that gives `rays` points to a receiver by the heuristic, on average over `receivers`.
    pub(crate) fn new(stage: &Stage, receivers: &[Receiver], rays: f64) -> Self {
        let mut sampler = Self::with(stage, Weights::Heuristic);
        let weights: Vec<Vec<f64>> = receivers.par_iter().map(|at| sampler.weights(at).collect()).collect();
        let total = |scale: f64| weights.iter().flatten().map(|weight| whole(weight * scale)).sum::<f64>();
        let wanted = rays * receivers.len() as f64;
        // The total grows with the scale, in steps: by its logarithm, from one at which nothing is given on.
        let (mut low, mut high) = (-200.0f64, 200.0f64);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if total(middle.exp2()) < wanted { low = middle } else { high = middle }
        }
        sampler.points = high.exp2();
        sampler
    }

    /// A sampler that gives numbers of points that are known already: by pixel, one for each triangle in the stage's order.
    pub(crate) fn by_table(stage: &Stage, points: HashMap<u32, Vec<f32>>) -> Self {
        Self::with(stage, Weights::Table(points))
    }

    fn with(stage: &Stage, weights: Weights) -> Self {
        let scene = Arc::clone(stage.scene());
        let extended = |&light: &LightId| scene.lights()[light as usize].kind() == Kind::Triangle;
        let (triangles, others): (Vec<_>, Vec<_>) = stage.lights().iter().copied().partition(extended);
        Self { scene, triangles, others, weights, points: 1.0 }
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
                Weights::Heuristic => {
                    // None of 0 that could add anything: in its plane but for rounding.
                    let least = LEAST * f64::from(importance(light, at));
                    let arriving = seen(light, at).solid_angle().abs() * f64::from(luminance(light.colour));
                    if least > 0.0 { arriving.max(least) * albedo } else { 0.0 }
                }
            }
        })
    }

    /// How many points each triangle gets at a receiver, on average.
    fn points(&self, at: &Receiver) -> impl Iterator<Item = f64> {
        self.weights(at).map(|weight| whole(weight * self.points))
    }
}

impl LightSampler for Sampler {
    /// Points of each triangle at the receiver, summed up to it.
    type Scratch = Vec<f64>;

    fn arrive<T: Tally>(&self, at: &Receiver, ends: &mut Vec<f64>, tally: &mut T) {
        tally.weighed(WEIGHED * self.triangles.len() as u64);
        ends.clear();
        let mut end = 0.0;
        ends.extend(self.points(at).map(|points| {
            end += points;
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
            let count = (ends[next] - target).ceil().max(1.0);
            let weight = (1.0 / points).min(f64::from(f32::MAX)) as f32;
            // All points of one light in all passes are one sequence.
            let of = points.ceil().max(1.0) as u32;
            for j in 0..count as u32 {
                out.push_at(light, weight, draws.nested(j, of, |draws| draws.point_of(light)));
            }
            target += count;
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        self.others.iter().for_each(|&light| counts[light as usize] += 1.0);
        for (&light, points) in self.triangles.iter().zip(self.points(at)) {
            counts[light as usize] += points as f32;
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
