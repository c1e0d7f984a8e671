//! How far is each choice from the best one?
//!
//! The oracle casts every light's shadow ray before it chooses one. So it runs off the clock, on a few of the target's
//! receivers, and the error of every other strategy at those same receivers is divided by its own. Both are errors per
//! sample: relMSE times passes, after as many passes where that is affordable, since spread numbers make it fall.

use super::compare::Options;
use super::errors::Truth;
use super::observer::Observer;
use super::plan::PASSES;
use super::summary::{blank, counts, interval};
use super::target::{self, Target};
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::base::statistics::Moments;
use crate::record::Summary;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::erased::AnySampler;
use crate::strategy::registry::Configured;
use crate::strategy::{BuildContext, Role};
use glam::Vec3;
use rayon::prelude::*;

/// Receivers that the oracle is run on.
const RECEIVERS: usize = 256;

/// Its independent runs: with so many receivers four tell its error to a few percent.
const RUNS: u32 = 4;

/// Work is counted at every so many of its receivers.
const COUNTED: usize = 16;

/// Most lights that it weighs on one scene, shadow rays and all: some ten seconds.
const DEAREST: f64 = 1e8;

/// Whether a strategy is run here and not against the clock.
pub(super) fn is_oracle(strategy: &Configured) -> bool {
    strategy.info().role == Role::Oracle
}

/// Runs the oracles among the strategies, and gives every summary its ratio to the first of them. `images` are those of
/// a strategy's runs after its last pass.
pub(super) fn settle<'a>(
    target: &Target<'_>,
    truth: &Truth,
    options: &Options<'_>,
    images: impl Fn(usize) -> Vec<&'a [Vec3]>,
    summaries: &mut [Summary],
    watch: &dyn Observer,
) -> Result<()> {
    let most = options.budget.usual_passes;
    let places: Vec<usize> = target::places(target.places.len(), RECEIVERS).collect();
    let compared = |s: &Summary| s.chooses && s.runs > 0 && s.error.is_none();
    let mut rungs: Vec<u32> = summaries.iter().filter(|s| compared(s)).map(|s| s.passes.min(most)).collect();
    rungs.sort_unstable();
    rungs.dedup();
    let mut floor: Option<Vec<f64>> = None;
    for (strategy, summary) in options.strategies.iter().zip(&mut *summaries).filter(|(one, _)| is_oracle(one)) {
        watch.check()?;
        watch.begin("oracle", 1);
        let run = Run { target, truth, places: &places, rungs: &rungs, seed: options.seed };
        let errors;
        (*summary, errors) = run.summary(strategy);
        floor = floor.or(errors);
        watch.end();
    }
    let Some(floor) = floor else { return Ok(()) };
    for (index, summary) in summaries.iter_mut().enumerate() {
        let error = if is_oracle(&options.strategies[index]) {
            summary.rel_mse.mean
        } else if compared(summary) {
            let images = images(index);
            images.iter().map(|image| at(truth, &places, image)).sum::<f64>() / images.len() as f64
        } else {
            continue;
        };
        let Some(rung) = rungs.iter().rposition(|&rung| rung <= summary.passes) else { continue };
        let ratio = error * f64::from(summary.passes) / (floor[rung] * f64::from(rungs[rung]));
        // An exact oracle has no multiple, and an error below the reference's own noise none that means anything.
        summary.times_oracle = Some(ratio).filter(|ratio| ratio.is_finite() && *ratio > 0.0);
    }
    Ok(())
}

/// relMSE of an image of the whole target at some of its places.
fn at(truth: &Truth, places: &[usize], image: &[Vec3]) -> f64 {
    truth.rel_mse_at(places, places.iter().map(|&i| image[i]))
}

/// The runs of one oracle.
struct Run<'a> {
    target: &'a Target<'a>,
    truth: &'a Truth,
    places: &'a [usize],
    rungs: &'a [u32],
    seed: u64,
}

impl Run<'_> {
    /// Its summary, and its relMSE after each number of passes if it could be run.
    fn summary(&self, strategy: &Configured) -> (Summary, Option<Vec<f64>>) {
        let blank = blank(strategy);
        let Some(&passes) = self.rungs.last() else {
            return (Summary { skipped: Some("skipped: nothing to compare it with".into()), ..blank }, None);
        };
        let sampler = match strategy.build(BuildContext { stage: self.target.stage, seed: self.seed }) {
            Ok(sampler) => sampler,
            Err(error) => return (Summary { error: Some(error.to_string()), ..blank }, None),
        };
        let measured = self.target.measured();
        let receivers: Vec<Receiver> = self.places.iter().map(|&i| measured[i]).collect();
        let few: Vec<Receiver> = receivers.iter().step_by(COUNTED).copied().collect();
        let key = RunKey { seed: self.seed, run: RUNS };
        let plan = Plan { stage: self.target.stage, receivers: &few, sampler: &*sampler, key };
        let work = plan.run_counting(PASSES, &mut Film::new(few.len()));
        let arrivals = receivers.len() as f64 * f64::from(RUNS) * self.rungs.len() as f64;
        let all = work.work.weighed as f64 / few.len().max(1) as f64 * arrivals;
        if all > DEAREST {
            let skipped = Some(format!("skipped: it would weigh lights {all:.0e} times, {DEAREST:.0e} at most"));
            return (Summary { skipped, ..blank }, None);
        }
        let runs: Vec<Vec<f64>> =
            (0..RUNS).into_par_iter().map(|run| self.errors(&*sampler, &receivers, run)).collect();
        let errors = |rung: usize| Moments::of(runs.iter().map(move |errors| errors[rung]));
        let summary = Summary {
            runs: RUNS,
            passes,
            receivers: Some(receivers.len() as u64),
            rel_mse: interval(errors(self.rungs.len() - 1)),
            heap_bytes: sampler.heap_bytes() as u64,
            counts: counts(work),
            ..blank
        };
        (summary, Some((0..self.rungs.len()).map(|rung| errors(rung).mean).collect()))
    }

    /// relMSE after each number of passes.
    fn errors(&self, sampler: &dyn AnySampler, receivers: &[Receiver], run: u32) -> Vec<f64> {
        let key = RunKey { seed: self.seed, run };
        let plan = Plan { stage: self.target.stage, receivers, sampler, key };
        let mut film = Film::new(receivers.len());
        let errors = self.rungs.iter().map(|&passes| {
            plan.run(passes - film.passes(), &mut film);
            self.truth.rel_mse_at(self.places, film.image().into_iter())
        });
        errors.collect()
    }
}
