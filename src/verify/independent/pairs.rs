//! Does a point of a light add as much, and does it arrive?

use super::geometry::{Geometry, Place};
use super::light::{Arriving, unshadowed};
use super::path::Path;
use crate::base::random::Stream;
use crate::scene::light::{Kind, LightId};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::verify::check::Check;
use glam::DVec3;

/// The checks' names.
pub(super) const CONTRIBUTION: &str = "contribution";
pub(super) const VISIBILITY: &str = "visibility";

/// Pairs of a receiver and a light that are looked at.
const PAIRS: usize = 2_000;

/// How many pairs of a kind of light are tried for each that is wanted: of few does anything arrive.
const TRIES: usize = 200;

/// Share of the shadow rays that may pass an edge so closely that rounding decides.
const SILHOUETTES: f64 = 0.01;

/// Below and above this f32 rounds otherwise, or not at all.
const SMALL: f64 = 1e-25;
const LARGE: f64 = 1e30;

/// A receiver, a point of a light, and what the program says of them.
struct Pair {
    at: Receiver,
    light: LightId,
    uv: [f32; 2],
    radiance: DVec3,
    arrives: bool,
}

/// Looks at [`PAIRS`] pairs, as many of each kind of light.
pub(super) fn pairs(geometry: &Geometry<'_>, path: &dyn Path, seed: u64) -> [Check; 2] {
    let pairs = choose(geometry, path, seed);
    let own: Vec<Option<(Place, Arriving)>> = pairs
        .iter()
        .map(|pair| {
            let place = geometry.place(&pair.at)?;
            let light = &geometry.scene.lights()[pair.light as usize];
            Some((place, unshadowed(light, pair.uv.map(f64::from), &place)))
        })
        .collect();
    [contribution(&pairs, &own, seed), visibility(geometry, &pairs, &own, seed)]
}

/// Half of the pairs of a kind with light that arrives, a quarter in shadow and a quarter with nothing to arrive, where
/// there are so many.
fn choose(geometry: &Geometry<'_>, path: &dyn Path, seed: u64) -> Vec<Pair> {
    let (lights, receivers) = (geometry.scene.lights(), path.receivers());
    let of_kind = |kind| (0..lights.len() as LightId).filter(|&id| lights[id as usize].kind() == kind).collect();
    let kinds: Vec<Vec<LightId>> = Kind::ALL.into_iter().map(of_kind).filter(|ids: &Vec<_>| !ids.is_empty()).collect();
    let mut chosen = Vec::new();
    if receivers.is_empty() {
        return chosen;
    }
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"in pairs")]);
    for ids in &kinds {
        let wanted = PAIRS / kinds.len();
        // Arriving, in shadow, nothing to arrive.
        let mut left = [wanted / 2, wanted / 4, wanted - wanted / 2 - wanted / 4];
        for tried in 0.. {
            if left.iter().sum::<usize>() == 0 {
                break;
            }
            let (at, light) = (receivers[rng.below(receivers.len())], ids[rng.below(ids.len())]);
            let uv = rng.uniform2();
            let radiance = path.unshadowed(LightSampling::Area, light, uv, &at);
            let arrives = radiance != DVec3::ZERO && path.visible(light, uv, &at);
            let class = if arrives { 0 } else { 1 + usize::from(radiance == DVec3::ZERO) };
            // What is too rare is made up for by what there is.
            let class = if tried < TRIES * wanted { class } else { left.iter().position(|&n| n > 0).unwrap_or(class) };
            if left[class] > 0 {
                left[class] -= 1;
                chosen.push(Pair { at, light, uv, radiance, arrives });
            }
        }
    }
    chosen
}

/// The greatest difference of a channel, as a multiple of what rounding explains.
fn contribution(pairs: &[Pair], own: &[Option<(Place, Arriving)>], seed: u64) -> Check {
    let mut worst = Check::new(CONTRIBUTION, 0.0, 1.0, String::new());
    for (pair, own) in pairs.iter().zip(own) {
        let off = own.as_ref().map_or(f64::INFINITY, |(_, own)| {
            let channel = |i: usize| {
                let (found, wanted, rounding) = (pair.radiance[i], own.radiance[i], own.rounding[i]);
                let measured = wanted + rounding < LARGE && (found.max(wanted) > SMALL);
                if measured { (found - wanted).abs() / rounding.max(f64::MIN_POSITIVE) } else { 0.0 }
            };
            (0..3).map(channel).fold(0.0, f64::max)
        });
        if off > worst.statistic || off.is_nan() {
            worst = Check::new(CONTRIBUTION, off, 1.0, String::new()).at(Some(pair.at.pixel), Some(pair.light));
        }
    }
    let lit = pairs.iter().filter(|pair| pair.radiance != DVec3::ZERO).count();
    let detail = format!(
        "greatest difference of {} pairs ({lit} not 0) from independent arithmetic, over what rounding explains; seed {seed}",
        pairs.len()
    );
    Check { detail, ..worst }
}

/// The shadow rays with another fate, but for those that pass an edge within a hair's breadth; of these a share may.
fn visibility(geometry: &Geometry<'_>, pairs: &[Pair], own: &[Option<(Place, Arriving)>], seed: u64) -> Check {
    let lit: Vec<_> = (pairs.iter().zip(own))
        .filter_map(|(pair, own)| Some((pair, own.as_ref()?)))
        .filter(|(pair, (_, own))| pair.radiance != DVec3::ZERO && own.radiance != DVec3::ZERO)
        .collect();
    let step = lit.len().div_ceil(geometry.rays().max(1)).max(1);
    let traced: Vec<_> = lit.iter().step_by(step).collect();
    let (mut wrong, mut silhouettes) = (Vec::new(), 0usize);
    for (pair, (place, own)) in &traced {
        if geometry.free(place, own.from) != pair.arrives {
            if geometry.is_silhouette(place, own.from) {
                silhouettes += 1;
            } else {
                wrong.push(pair);
            }
        }
    }
    let tolerated = (SILHOUETTES * traced.len() as f64).ceil() as usize;
    let detail = format!(
        "shadow rays with another fate, of {} through all of {} triangles; {silhouettes} more at edges, {tolerated} tolerated; seed {seed}",
        traced.len(),
        geometry.triangles()
    );
    let first = wrong.first();
    Check::new(VISIBILITY, (wrong.len() + silhouettes.saturating_sub(tolerated)) as f64, 0.0, detail)
        .at(first.map(|pair| pair.at.pixel), first.map(|pair| pair.light))
}
