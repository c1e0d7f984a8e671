//! The exact image, within a bound of work, computed once and kept.
//!
//! Why exact to a hundredth of the best row's error: errors are means of `(x - first half)(x - second half)`, which the
//! reference's own noise biases nowhere; it only widens them, and at a hundredth by nothing that can be seen.
//!
//! Where a scene asks for more work than the bound, fewer receivers are measured, as exactly; only where even
//! [`FEWEST`] are too many is the image less exact, and its own relMSE says so.

use super::errors::Truth;
use super::observer::Observer;
use super::target::{Target, Visited};
use super::tiles::{self, TileFile};
use crate::base::error::{Error, Result};
use crate::base::random::hash;
use crate::base::rel_mse::RelMse;
use crate::render::exact::Exact;
use crate::render::refined::{FALL, Price, refined};
use crate::scene::Scene;
use crate::scene::light::Kind;
use crate::verify::halves;
use crate::visibility::stage::Stage;
use cpu_time::ThreadTime;
use glam::DVec3;
use rayon::prelude::*;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// An exact image and how it came to be.
pub(crate) struct Reference {
    /// The truth at the target's measured receivers.
    pub truth: Truth,
    /// Whether it is a sum without noise.
    pub exact_sum: bool,
    /// Receivers of a measured place: 1 where they stay, those of all passes where they move.
    pub visits: f64,
    /// Shadow rays cast, those included that said how many are needed.
    pub rays: u64,
    /// Counted work of all that, in nominal CPU seconds: see [`RAY_S`].
    pub work_s: f64,
    /// CPU seconds spent now; 0 where all came from the cache.
    pub cpu_s: f64,
    /// Whether all of it came from the cache.
    pub cached: bool,
}

/// How exact an image must be, and what that may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wanted {
    /// Its own relMSE, at most.
    pub own_rel_mse: f64,
    /// Most counted work, in nominal CPU seconds: see [`RAY_S`].
    pub work_s: f64,
    /// Receivers that are measured even where that makes the image less exact.
    pub fewest: usize,
}

impl Wanted {
    /// This exact, within [`WORK_S`], at [`FEWEST`] receivers at least.
    pub(crate) fn new(own_rel_mse: f64) -> Self {
        Self { own_rel_mse, work_s: WORK_S, fewest: FEWEST }
    }
}

/// Nominal CPU seconds of a shadow ray to a point of a light, all around it included: 170 ns were seen on first-night (2
/// cores of a busy AMD EPYC), 100 ns in a street of 34 lights.
pub(crate) const RAY_S: f64 = 170e-9;

/// Nominal CPU seconds of coming past a light at a receiver, whether or not it is sampled: 13 to 30 ns were seen on
/// stadium and downtown.
pub(crate) const LIGHT_S: f64 = 20e-9;

/// Work of a reference where nobody says otherwise, in nominal CPU seconds: a minute of two cores.
pub(crate) const WORK_S: f64 = 120.0;

/// Places that are always measured, where there are so many and receivers stay.
pub(crate) const FEWEST: usize = 256;

/// Places that are always measured, where there are so many and each has receivers of many passes.
const FEWEST_MOVING: usize = 64;

/// The most passes whose visits the work of a reference allows at the fewest places, one ray a light at each; any number
/// where receivers stay. Four at least: a comparison needs some.
pub(crate) fn most_passes(target: &Target<'_>, work_s: f64) -> u32 {
    if !target.stage.visits().moves() {
        return u32::MAX;
    }
    let lights = target.stage.scene().lights().len().max(1) as f64;
    let a_pass = FEWEST_MOVING.min(target.places.len()).max(1) as f64 * lights * (RAY_S + LIGHT_S);
    ((work_s / a_pass) as u32).max(4)
}

fn fewest(target: &Target<'_>) -> usize {
    if target.stage.visits().moves() { FEWEST_MOVING } else { FEWEST }
}

/// Part of the hash: to be raised whenever `render::refined` gives other numbers, or `visibility::visits` other receivers.
const VERSION: u32 = 3;

/// Names the reference's random numbers; never a run's.
const SEED: u64 = 0x7265_6665_7265_6e63;

impl Reference {
    /// The exact image of a target, from `cache` where it is there, until its own relMSE is at most `own_rel_mse`,
    /// however long that takes.
    ///
    /// # Errors
    /// As [`bounded`](Self::bounded).
    pub(crate) fn compute(target: &Target<'_>, own_rel_mse: f64, cache: &Path, watch: &dyn Observer) -> Result<Self> {
        let wanted = Wanted { work_s: f64::INFINITY, ..Wanted::new(own_rel_mse) };
        Ok(Self::bounded(target, wanted, cache, watch)?.1)
    }

    /// The exact image of a target, or of as many of its measured receivers as the work allows, and which those are.
    ///
    /// Few receivers say which price of a ray leads to the relMSE, and what a receiver then takes; how many can be
    /// measured follows. Work is counted, not timed: every machine comes to the same receivers.
    ///
    /// # Errors
    /// A cache that cannot be read or written; halves of the image that are not independent; the user's wish to stop.
    pub(crate) fn bounded<'a>(
        target: &Target<'a>,
        wanted: Wanted,
        cache: &Path,
        watch: &dyn Observer,
    ) -> Result<(Target<'a>, Self)> {
        let every = target.places.len();
        let few = target.thinned(fewest(target));
        let fewest = wanted.fewest.clamp(few.places.len(), every);
        let mut measured = few.clone();
        let mut step = Step { halvings: 0, relative: RelMse::default() };
        let mut earlier = None;
        loop {
            let reference = Self::level(&measured, step, cache, watch)?;
            let count = measured.places.len();
            // Of no receivers, nothing follows.
            let each = reference.work_s / count.max(1) as f64;
            let reference = reference.after(earlier);
            let left = wanted.work_s - reference.work_s;
            // Few receivers say only about what all will come to.
            let room = if count < every { ROOM } else { 1.0 };
            let missing = reference.truth.own_rel_mse() / (room * wanted.own_rel_mse);
            if missing > 1.0 {
                let finer = step.finer(missing, wanted.own_rel_mse, &reference);
                let on_trial = count == few.places.len();
                let receivers = if on_trial { fewest } else { count };
                let halvings = finer.halvings.min(step.affordable(left / (receivers as f64 * each)));
                // Many receivers are not sampled anew for a part of what is missing.
                let enough = halvings == finer.halvings || on_trial;
                if halvings > step.halvings && enough {
                    (step, earlier) = (Step { halvings, ..finer }, Some(reference));
                    continue;
                }
                // Fewer of them are, where all are too noisy.
                let fewer = (left / (each * step.dearer(finer))) as usize;
                if !enough && reference.truth.own_rel_mse() > wanted.own_rel_mse && fewer >= fewest {
                    (measured, step, earlier) = (target.thinned(fewer.min(count)), finer, Some(reference));
                    continue;
                }
            }
            let affordable = ((left / each) as usize).clamp(fewest, every);
            if affordable <= count || missing > 1.0 && fewest <= count {
                return Ok((measured, reference));
            }
            (measured, earlier) = (target.thinned(affordable), Some(reference));
        }
    }

    /// What a reader must know of it: whether the bound of work had a say, and in what; and how many visits meet nothing.
    pub(crate) fn notes(&self, target: &Target<'_>, wanted: Wanted) -> Vec<String> {
        let Target { places, frame, .. } = target;
        let bound = format!("{:.0} nominal CPU s (--reference-work)", wanted.work_s);
        let mut notes = Vec::new();
        if target.is_subset() {
            let (some, all) = (places.len(), frame.len());
            notes.push(format!(
                "errors are taken at {some} of {all} receivers, spread over the image: with more, the reference would take more than {bound}"
            ));
        }
        if let Some(&most) = target.budgets().last() {
            let none = 1.0 - self.visits / f64::from(most);
            notes.push(format!(
                "{:.1} % of the visits of these pixels in {most} passes meet no surface: they add no light, and no error",
                100.0 * none
            ));
        }
        let own = self.truth.own_rel_mse();
        if own > wanted.own_rel_mse {
            notes.push(format!(
                "the reference's own relMSE is {own:.1e} where {:.1e} was wanted: less would take more than {bound}",
                wanted.own_rel_mse
            ));
        }
        if self.work_s > wanted.work_s {
            notes.push(format!("the reference took {:.0} nominal CPU s: one ray a light is its least", self.work_s));
        }
        notes
    }

    /// The image at one price of a ray.
    fn level(target: &Target<'_>, step: Step, cache: &Path, watch: &dyn Observer) -> Result<Self> {
        let (stage, measured) = (target.stage, target.visited());
        let n = measured.len();
        let (file, mut tiles) = TileFile::open(cache, &name(stage, &measured, step), n)?;
        let missing: Vec<usize> = (0..tiles.len()).filter(|&tile| tiles[tile].is_none()).collect();
        let spent = AtomicU64::new(0);
        if !missing.is_empty() {
            watch.begin("reference", missing.iter().map(|&tile| tiles::range(tile, n).len() as u64).sum());
            let file = Mutex::new(file);
            let one = |Visited { at, pass, .. }: &Visited| {
                watch.check()?;
                let clock = ThreadTime::now();
                let seed = pass.map_or(SEED, |pass| hash(&[SEED, u64::from(pass)]));
                let value = refined(stage, at, step.price(), seed);
                spent.fetch_add(clock.elapsed().as_nanos() as u64, Ordering::Relaxed);
                watch.advance(1);
                Ok(value)
            };
            let done = missing.par_iter().map(|&tile| {
                let values = measured[tiles::range(tile, n)].par_iter().map(one).collect::<Result<Vec<Exact>>>()?;
                file.lock().map_err(|_| Error::Interrupted)?.append(tile, &values)?;
                Ok((tile, values))
            });
            let done: Result<Vec<(usize, Vec<Exact>)>> = done.collect();
            watch.end();
            done?.into_iter().for_each(|(tile, values)| tiles[tile] = Some(values));
        }
        let values: Vec<Exact> = tiles.into_iter().flatten().flatten().collect();
        let check = halves(&values);
        if !check.passed {
            return Err(Error::Invalid(format!("the reference's halves are not independent: {check}")));
        }
        let rays = values.iter().map(|v| v.rays).sum();
        let lights = stage.scene().lights();
        Ok(Self {
            truth: truth(target, &measured, &values),
            visits: n as f64 / target.places.len().max(1) as f64,
            exact_sum: !lights.iter().any(|light| light.kind() == Kind::Triangle),
            rays,
            work_s: rays as f64 * RAY_S + (n * lights.len()) as f64 * LIGHT_S,
            cpu_s: spent.into_inner() as f64 * 1e-9,
            cached: missing.is_empty(),
        })
    }

    /// The same with what earlier levels took.
    fn after(self, earlier: Option<Self>) -> Self {
        let Some(earlier) = earlier else { return self };
        Self {
            rays: self.rays + earlier.rays,
            work_s: self.work_s + earlier.work_s,
            cpu_s: self.cpu_s + earlier.cpu_s,
            cached: self.cached && earlier.cached,
            ..self
        }
    }
}

/// The radiance of each measured place: of its receiver, or the mean over those of the first passes of each budget.
fn truth(target: &Target<'_>, measured: &[Visited], values: &[Exact]) -> Truth {
    let half = |i: usize, passes: u32| {
        let mut sums = vec![DVec3::ZERO; target.places.len()];
        for (visited, value) in
            measured.iter().zip(values).filter(|(visited, _)| visited.pass.is_none_or(|p| p < passes))
        {
            sums[visited.place] += (value.sum + value.halves[i]) / f64::from(passes);
        }
        sums.into_iter().map(DVec3::as_vec3).collect()
    };
    if !target.stage.visits().moves() {
        return Truth::new([half(0, 1), half(1, 1)]);
    }
    Truth::of_budgets(target.budgets().iter().map(|&passes| (passes, [half(0, passes), half(1, passes)])).collect())
}

/// A price of a ray, in powers of two: exact on every machine, and met again by the next comparison of the scene.
#[derive(Clone, Copy)]
struct Step {
    /// relMSE that a ray must take away, as a power of 1/2.
    halvings: u32,
    relative: RelMse,
}

/// The share of the wanted relMSE that few receivers must reach before more are sampled.
const ROOM: f64 = 0.8;

/// The relMSE of the first step that has an epsilon: it costs little, and what follows it need not guess.
const EASY: f64 = 1e-4;

/// Most halvings in one step: sixteen times the rays.
const STRIDE: u32 = 10;

/// Halvings at which every grid has all the points it may have.
const FINEST: u32 = 64;

impl Step {
    fn price(self) -> Price {
        Price { relative: self.relative, a_ray: 0.5f64.powi(self.halvings as i32) }
    }

    /// The step that takes the relMSE down by `missing`: it falls as the price to the power `FALL / (FALL + 1)`.
    fn finer(self, missing: f64, own_rel_mse: f64, found: &Reference) -> Self {
        if self.halvings == 0 {
            // At any price the image's relMSE is that times the rays of a receiver, over FALL.
            // The mean over the receivers of a place has less noise than one of them, by their number.
            let rays = found.rays as f64 / (found.truth.mean().len() as f64 * found.visits);
            let halvings = (rays / (FALL * own_rel_mse.max(EASY) * found.visits)).log2().ceil();
            return Self { halvings: (halvings as u32).clamp(1, FINEST), relative: found.truth.relative() };
        }
        let halvings = (missing.log2() * (FALL + 1.0) / FALL).ceil();
        Self { halvings: (self.halvings + (halvings as u32).clamp(1, STRIDE)).min(FINEST), ..self }
    }

    /// How many times as much work a receiver takes at another step, at most.
    fn dearer(self, finer: Self) -> f64 {
        (f64::from(finer.halvings.saturating_sub(self.halvings)) / (FALL + 1.0)).exp2()
    }

    /// The most halvings, if a receiver may take so many times as much work as it did: rays grow as the price to the
    /// power `-1 / (FALL + 1)`, at most.
    fn affordable(self, times: f64) -> u32 {
        let halvings = (times.max(0.0).log2() * (FALL + 1.0)).floor();
        // A negative number becomes 0.
        self.halvings + halvings.min(f64::from(FINEST)) as u32
    }
}

/// The file name of a level: a hash of all that decides it.
fn name(stage: &Stage, receivers: &[Visited], step: Step) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(scene_hash(stage.scene()).as_bytes());
    let Price { relative, a_ray } = step.price();
    hasher.update(format!("{VERSION} {:?} {a_ray:e} {}", stage.offset(), relative.epsilon()).as_bytes());
    hasher.update(if stage.visits().moves() { stage.visits().name().as_bytes() } else { b"" });
    receivers.iter().for_each(|Visited { at, pass, .. }| {
        hasher.update(&at.pixel.to_le_bytes());
        pass.iter().for_each(|pass| {
            hasher.update(&pass.to_le_bytes());
        });
    });
    hasher.finalize().to_hex().to_string()
}

/// The content hash that names a scene: 32 hexadecimal digits.
pub(crate) fn scene_hash(scene: &Scene) -> String {
    let mut hasher = blake3::Hasher::new();
    scene.digest(|bytes| {
        hasher.update(bytes);
    });
    hasher.finalize().to_hex()[..32].to_owned()
}
