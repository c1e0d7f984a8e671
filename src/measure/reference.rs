//! The exact image, computed once and kept.

use super::errors::Truth;
use super::observer::Observer;
use super::target::Target;
use super::tiles::{self, TileFile};
use crate::base::error::{Error, Result};
use crate::render::exact::{Exact, exact};
use crate::scene::Scene;
use crate::scene::light::Kind;
use crate::visibility::stage::Stage;
use cpu_time::ThreadTime;
use rayon::prelude::*;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// An exact image and how it came to be.
pub struct Reference {
    /// The truth at the target's receivers.
    pub truth: Truth,
    /// Whether it is a sum without noise.
    pub exact_sum: bool,
    /// Shadow rays cast.
    pub rays: u64,
    /// CPU seconds spent now; 0 where all came from the cache.
    pub cpu_s: f64,
    /// Whether all of it came from the cache.
    pub cached: bool,
}

/// Points beyond which a stratified reference is not refined.
const MOST_POINTS: u32 = 1 << 18;

/// Points a receiver and half to begin with.
const FIRST_POINTS: u32 = 64;

/// Part of the hash: to be raised whenever `render::exact` gives other numbers.
const VERSION: u32 = 1;

impl Reference {
    /// The exact image of a target, from `cache` where it is there.
    ///
    /// Triangles are sampled until the reference's own relMSE is at most `own_rel_mse`; a pilot on a few receivers says
    /// how many points that takes.
    pub fn compute(target: &Target<'_>, own_rel_mse: f64, cache: &Path, watch: &dyn Observer) -> Result<Self> {
        if !has_triangles(target.stage) {
            return Self::level(target, 0, cache, watch);
        }
        let mut points = FIRST_POINTS;
        loop {
            let pilot = target.thinned(PILOT);
            let own = Self::level(&pilot, points, cache, watch)?.truth.own_rel_mse();
            if own > own_rel_mse && points < MOST_POINTS {
                points = (points * next_factor(own / own_rel_mse)).min(MOST_POINTS);
                continue;
            }
            let reference = Self::level(target, points, cache, watch)?;
            let own = reference.truth.own_rel_mse();
            if own <= own_rel_mse || points >= MOST_POINTS {
                return Ok(reference);
            }
            points = (points * next_factor(own / own_rel_mse)).min(MOST_POINTS);
        }
    }

    fn level(target: &Target<'_>, points: u32, cache: &Path, watch: &dyn Observer) -> Result<Self> {
        let n = target.receivers.len();
        let (file, mut tiles) = TileFile::open(cache, &name(target, points), n)?;
        let missing: Vec<usize> = (0..tiles.len()).filter(|&tile| tiles[tile].is_none()).collect();
        let spent = AtomicU64::new(0);
        if !missing.is_empty() {
            watch.begin("reference", missing.len() as u64);
            let file = Mutex::new(file);
            let done = missing.par_iter().map(|&tile| {
                watch.check()?;
                let clock = ThreadTime::now();
                let receivers = &target.receivers[tiles::range(tile, n)];
                let values: Vec<Exact> = receivers.iter().map(|at| exact(target.stage, at, points, SEED)).collect();
                spent.fetch_add(clock.elapsed().as_nanos() as u64, Ordering::Relaxed);
                file.lock().map_err(|_| Error::Interrupted)?.append(tile, &values)?;
                watch.advance(1);
                Ok((tile, values))
            });
            let done: Result<Vec<(usize, Vec<Exact>)>> = done.collect();
            watch.end();
            done?.into_iter().for_each(|(tile, values)| tiles[tile] = Some(values));
        }
        let values: Vec<Exact> = tiles.into_iter().flatten().flatten().collect();
        let half = |i: usize| values.iter().map(|v| (v.sum + v.halves[i]).as_vec3()).collect();
        Ok(Self {
            truth: Truth::new([half(0), half(1)]),
            exact_sum: !has_triangles(target.stage),
            rays: values.iter().map(|v| v.rays).sum(),
            cpu_s: spent.into_inner() as f64 * 1e-9,
            cached: missing.is_empty(),
        })
    }
}

/// Receivers of the pilot that chooses the number of points.
const PILOT: usize = 512;

/// Names the reference's random numbers; never a run's.
const SEED: u64 = 0x7265_6665_7265_6e63;

/// How many times more points bring the noise down by `excess`. Stratified noise falls faster than 1/n; 1/n is safe.
fn next_factor(excess: f64) -> u32 {
    (excess * 1.3).ceil().clamp(2.0, 64.0) as u32
}

fn has_triangles(stage: &Stage) -> bool {
    stage.scene().lights().iter().any(|light| light.kind() == Kind::Triangle)
}

/// What names a reference: a hash of all that decides it.
fn name(target: &Target<'_>, points: u32) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(scene_hash(target.stage.scene()).as_bytes());
    hasher.update(format!("{VERSION} {:?} {points}", target.stage.offset()).as_bytes());
    target.receivers.iter().for_each(|at| {
        hasher.update(&at.pixel.to_le_bytes());
    });
    hasher.finalize().to_hex().to_string()
}

/// The content hash that names a scene: 32 hexadecimal digits.
pub fn scene_hash(scene: &Scene) -> String {
    let mut hasher = blake3::Hasher::new();
    scene.digest(|bytes| {
        hasher.update(bytes);
    });
    hasher.finalize().to_hex()[..32].to_owned()
}
