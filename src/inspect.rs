//! What is in a scene, does it look like a city at night, and what can be left out of it?

use crate::base::colour::luminance;
use crate::base::statistics::quantile;
use crate::base::triangle::CENTROID;
use crate::measure::reference::scene_hash;
use crate::measure::target::spread;
use crate::render::exact::{exact, shadowed};
use crate::scene::cutoff::{Cutoff, Transfer};
use crate::scene::light::{Kind, Light, LightId};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::visibility::influence_tree::InfluenceTree;
use crate::visibility::stage::Stage;
use crate::visibility::view::Seen;
use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;
use std::f32::consts::PI;

/// What is known of a scene without comparing anything.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Inspection {
    /// The scene's name.
    pub name: String,
    /// Content hash.
    pub hash: String,
    /// World position of the coordinate origin, in metres.
    pub origin: [f64; 3],
    /// Size of the box around everything, in metres.
    pub size: [f32; 3],
    /// Columns and rows of the image.
    pub resolution: (u32, u32),
    /// Exposure value at ISO 100, if stated.
    pub ev100: Option<f32>,
    /// Reflecting triangles.
    pub surfaces: u64,
    /// Lights by kind.
    pub kinds: Vec<Part>,
    /// Lights by the part of the recipe that made them.
    pub groups: Vec<Part>,
    /// Lights in range of a visible point, at 0.5/255 of a linear display.
    pub in_range: Listed,
    /// Lights that provably reach no visible point, by facing alone.
    pub unreaching: u64,
    /// Lights whose middle none of the sampled receivers sees: behind the horizon, facing away or hidden.
    pub unseen: u64,
    /// Pixels.
    pub pixels: Pixels,
    /// Bytes.
    pub memory: Memory,
    /// What was left out, and why.
    pub left_out: Vec<String>,
    /// What a reader should know.
    pub notes: Vec<String>,
}

/// Some of the lights.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Part {
    /// What they are.
    pub name: String,
    /// How many.
    pub lights: u64,
    /// Their luminous flux in lm.
    pub flux_lm: f64,
    /// Their share of all flux, within `[0, 1]`.
    pub flux_share: f64,
}

/// Lengths of lists.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Listed {
    /// Mean.
    pub mean: f64,
    /// A twentieth is shorter.
    pub p5: f64,
    /// Half is shorter.
    pub p50: f64,
    /// A twentieth is longer.
    pub p95: f64,
}

/// What the pixels show.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Pixels {
    /// Share that sees the sky.
    pub sky_share: f64,
    /// Share that sees an emitter.
    pub emitter_share: f64,
    /// Share that is clipped in at least one channel at the scene's exposure.
    pub clipped_share: f64,
    /// Mean illuminance of visible street in lx; `None` where no street is seen.
    pub street_lx: Option<f64>,
    /// Share of visible street that is at least one display step (1/255, linear) bright.
    pub street_above_step_share: Option<f64>,
    /// Receivers that these estimates rest on.
    pub receivers_sampled: u64,
}

/// Bytes on the heap.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Memory {
    /// Of the light table, a light.
    pub table_bytes_per_light: f64,
    /// Of the hierarchy over influence volumes, a light.
    pub influence_bytes_per_light: f64,
    /// Of the occluders and their hierarchy.
    pub occluder_bytes: u64,
}

/// Receivers at which light is measured, at most.
const SAMPLES: usize = 2_048;

/// Light evaluations spent on them, about.
const EVALUATIONS: usize = 60_000_000;

/// Looks at a scene made ready.
pub(crate) fn inspect(stage: &Stage) -> Inspection {
    let scene = stage.scene();
    let (low, high) = scene.bounds();
    let every: Vec<LightId> = (0..scene.lights().len() as LightId).collect();
    let tree = InfluenceTree::new(scene, &every, Cutoff::new(scene, 0.5, Transfer::Linear));
    let lights = scene.lights().len().max(1) as f64;
    Inspection {
        name: scene.name().to_owned(),
        hash: scene_hash(scene),
        origin: scene.origin().to_array(),
        size: (high - low).to_array(),
        resolution: stage.view().resolution(),
        ev100: scene.ev100(),
        surfaces: scene.surfaces().len() as u64,
        kinds: kinds(scene.lights(), scene.radius()),
        groups: groups(stage),
        in_range: in_range(&tree, stage.receivers()),
        unreaching: (scene.lights().len() - stage.lights().len()) as u64,
        unseen: unseen(stage),
        pixels: pixels(stage),
        memory: Memory {
            table_bytes_per_light: size_of::<Light>() as f64,
            influence_bytes_per_light: tree.heap_bytes() as f64 / lights,
            occluder_bytes: stage.occluders().heap_bytes() as u64,
        },
        left_out: left_out(stage),
        notes: scene.notes().to_vec(),
    }
}

fn flux(lights: &[Light], radius: f32) -> f64 {
    lights.iter().map(|light| f64::from(luminance(light.flux(radius)))).sum()
}

fn part(name: &str, lights: &[Light], radius: f32, total: f64) -> Part {
    let flux_lm = flux(lights, radius);
    let flux_share = if total > 0.0 { flux_lm / total } else { 0.0 };
    Part { name: name.to_owned(), lights: lights.len() as u64, flux_lm, flux_share }
}

fn kinds(lights: &[Light], radius: f32) -> Vec<Part> {
    let total = flux(lights, radius);
    let of = |kind: Kind| lights.iter().copied().filter(|light| light.kind() == kind).collect::<Vec<_>>();
    Kind::ALL
        .into_iter()
        .map(|kind| part(kind.name(), &of(kind), radius, total))
        .filter(|part| part.lights > 0)
        .collect()
}

fn groups(stage: &Stage) -> Vec<Part> {
    let (lights, radius) = (stage.scene().lights(), stage.scene().radius());
    let total = flux(lights, radius);
    let of = |range: &std::ops::Range<u32>| &lights[range.start as usize..range.end as usize];
    stage.scene().groups().iter().map(|group| part(&group.name, of(&group.range), radius, total)).collect()
}

fn in_range(tree: &InfluenceTree, receivers: &[Receiver]) -> Listed {
    let mut lengths: Vec<f64> = spread(receivers, 16 * SAMPLES)
        .par_iter()
        .map_init(Vec::new, |list, at| {
            list.clear();
            tree.list(at.position, list);
            list.len() as f64
        })
        .collect();
    lengths.sort_by(f64::total_cmp);
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    let at = |q| if lengths.is_empty() { 0.0 } else { quantile(&lengths, q) };
    Listed { mean, p5: at(0.05), p50: at(0.5), p95: at(0.95) }
}

/// The receivers at which light is measured.
fn sampled(stage: &Stage) -> Vec<Receiver> {
    let count = (EVALUATIONS / stage.scene().lights().len().max(1)).clamp(64, SAMPLES);
    spread(stage.receivers(), count)
}

fn unseen(stage: &Stage) -> u64 {
    let receivers = sampled(stage);
    let seen = |light: &&Light| {
        receivers.iter().any(|at| shadowed(stage, LightSampling::Area, at, light, CENTROID, &mut 0).max_element() > 0.0)
    };
    stage.scene().lights().par_iter().filter(|light| !seen(light)).count() as u64
}

fn pixels(stage: &Stage) -> Pixels {
    let scene = stage.scene();
    let exposure = scene.exposure();
    let sampled = sampled(stage);
    // Illuminance of each: what a white receiver reflects, times pi.
    let lit: Vec<(Receiver, Vec3)> = sampled
        .into_par_iter()
        .map(|at| {
            let white = Receiver { albedo: Vec3::ONE, ..at };
            (at, exact(stage, &white, 64, 0).mean().as_vec3() * PI)
        })
        .collect();
    let share = |n: usize, of: usize| n as f64 / of.max(1) as f64;
    let clipped = |radiance: Vec3| (radiance * exposure).max_element() > 1.0;
    let clipped_receivers = lit.iter().filter(|(at, e)| clipped(*e * at.albedo / PI)).count();
    let all = stage.view().pixels();
    let clipped_emitters = all
        .iter()
        .filter(|seen| matches!(seen, Seen::Emitter(id) if clipped(scene.lights()[*id as usize].colour)))
        .count();
    let is_street = |at: &Receiver| scene.materials()[scene.surfaces()[at.surface as usize].material as usize].street;
    let street: Vec<&(Receiver, Vec3)> = lit.iter().filter(|(at, _)| is_street(at)).collect();
    let seen = |value: f64| (!street.is_empty()).then_some(value);
    let lx = street.iter().map(|(_, e)| f64::from(luminance(*e))).sum::<f64>() / street.len().max(1) as f64;
    let above = street.iter().filter(|(at, e)| luminance(*e * at.albedo / PI) * exposure >= 1.0 / 255.0).count();
    let (sky_share, emitter_share) = stage.view().shares();
    Pixels {
        sky_share,
        emitter_share,
        clipped_share: share(clipped_receivers, lit.len()) * share(stage.receivers().len(), all.len())
            + share(clipped_emitters, all.len()),
        street_lx: seen(lx),
        street_above_step_share: seen(share(above, street.len())),
        receivers_sampled: lit.len() as u64,
    }
}

fn left_out(stage: &Stage) -> Vec<String> {
    let (needs, scene) = (stage.needs(), stage.scene());
    let missing = Kind::ALL.into_iter().filter(|&kind| !needs.has(kind));
    let mut left_out: Vec<String> =
        missing.map(|kind| format!("code for {} lights: the scene has none", kind.name())).collect();
    if !needs.occlusion {
        left_out.push("shadow rays: all lights and surfaces lie on one side of every triangle".into());
    }
    let unreaching = scene.lights().len() - stage.lights().len();
    if unreaching > 0 {
        left_out.push(format!(
            "{unreaching} lights: each faces away from every visible point, or has all of them facing away"
        ));
    }
    left_out
}
