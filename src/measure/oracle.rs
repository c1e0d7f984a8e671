//! How far is each choice from the best one?
//!
//! The oracle casts every light's shadow ray before it chooses one. So it runs off the clock, at some of the measured
//! receivers, and the error of every other strategy at those same receivers is divided by its own. Both are errors per
//! sample: relMSE times passes, after as many passes where that is affordable, since spread numbers make it fall.
//!
//! Receivers and runs are as many as the counted work allows, until the interval of the oracle's own error is narrow.

use super::compare::Options;
use super::errors::{Errors, Truth};
use super::experiment::Runs;
use super::figure::Figure;
use super::observer::Observer;
use super::plan::PASSES;
use super::summary::{blank, counts};
use super::target::{self, Target};
use crate::base::error::Result;
use crate::base::interval::Tail;
use crate::base::random::RunKey;
use crate::record::{Interval, Summary};
use crate::render::counts::Counts;
use crate::render::exact::shadowed;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::erased::{AnySampler, Frame, PickBuffer, blocks};
use crate::strategy::registry::Configured;
use crate::strategy::{BuildContext, Role};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Most receivers that an oracle is run on.
const MOST_RECEIVERS: usize = 4_096;

/// Fewest receivers that say anything of the image.
const FEWEST_RECEIVERS: usize = 64;

/// Independent runs are done so many at a time.
const ROUND: u32 = 8;

/// Most rounds.
const ROUNDS: u32 = 8;

/// Half the interval of its error, as a share of it, that is narrow enough.
const NARROW: f64 = 0.08;

/// Work is counted at so many receivers.
const COUNTED: usize = 16;

/// Most lights that it weighs on one scene, shadow rays and all: some fifteen CPU seconds.
const DEAREST: f64 = 6e7;

/// Whether a strategy is run here and not against the clock.
pub(super) fn is_oracle(strategy: &Configured) -> bool {
    strategy.info().role == Role::Oracle
}

/// Runs the oracles among the strategies, and gives every summary its ratio to the first of them.
pub(super) fn settle(
    target: &Target<'_>,
    truth: &Truth,
    options: &Options<'_>,
    runs: &[Runs],
    summaries: &mut [Summary],
    watch: &dyn Observer,
) -> Result<()> {
    let compared = |s: &Summary| s.chooses && s.runs > 0 && s.error.is_none();
    let mut rungs: Vec<u32> = summaries.iter().filter(|s| compared(s)).map(|s| s.passes).collect();
    rungs.retain(|&passes| passes <= options.budget.usual_passes);
    rungs.sort_unstable();
    rungs.dedup();
    let mut floor: Option<Floor> = None;
    for (strategy, summary) in options.strategies.iter().zip(&mut *summaries).filter(|(one, _)| is_oracle(one)) {
        let ground = Ground { target, truth, rungs: &rungs, seed: options.seed };
        let found;
        (*summary, found) = ground.summary(strategy, watch)?;
        floor = floor.or(found);
    }
    let Some(floor) = floor else { return Ok(()) };
    for ((strategy, summary), runs) in options.strategies.iter().zip(&mut *summaries).zip(runs) {
        if is_oracle(strategy) && summary.runs > 0 {
            summary.times_oracle = Some(Interval::certain(1.0));
        }
        if !compared(summary) || is_oracle(strategy) {
            continue;
        }
        let Some(rung) = rungs.iter().rposition(|&rung| rung <= summary.passes) else { continue };
        let at = |image: &Vec<Vec3>| floor.truth.errors(&floor.places.iter().map(|&i| image[i]).collect::<Vec<Vec3>>());
        let own = figure(&runs.images.iter().map(at).collect::<Vec<Errors>>());
        let samples = f64::from(summary.passes) / f64::from(rungs[rung]);
        // An exact oracle has no multiple, an error below the reference's own noise none that means anything, and one whose
        // own tail is too heavy to say none that could be told.
        let floor = floor.figure(rung);
        let told = floor.interval().is_bounded();
        summary.times_oracle = own.over(floor).filter(|_| told).map(|ratio| ratio.interval().times(samples));
    }
    Ok(())
}

/// What an oracle came to.
struct Floor {
    /// Where it was run, as places among the measured receivers.
    places: Vec<usize>,
    /// The truth there.
    truth: Truth,
    /// Errors of each run after each number of passes.
    runs: Vec<Vec<Errors>>,
}

impl Floor {
    /// relMSE after a number of passes.
    fn figure(&self, rung: usize) -> Figure {
        figure(&self.runs.iter().map(|errors| errors[rung]).collect::<Vec<Errors>>())
    }
}

/// The mean relMSE of runs with these errors.
fn figure(errors: &[Errors]) -> Figure {
    let values: Vec<f64> = errors.iter().map(|errors| errors.rel_mse).collect();
    let largest: Vec<_> = errors.iter().map(|errors| errors.largest).collect();
    let tail = Tail::of(&values, &largest);
    Figure::error(values, tail)
}

/// What oracles are run on.
struct Ground<'a> {
    target: &'a Target<'a>,
    truth: &'a Truth,
    /// Numbers of passes, ascending.
    rungs: &'a [u32],
    seed: u64,
}

impl Ground<'_> {
    /// Its summary, and its errors if it could be run.
    fn summary(&self, strategy: &Configured, watch: &dyn Observer) -> Result<(Summary, Option<Floor>)> {
        let blank = blank(strategy);
        let Some(&passes) = self.rungs.last() else {
            return Ok((Summary { skipped: Some("skipped: nothing to compare it with".into()), ..blank }, None));
        };
        let sampler = match strategy.build(BuildContext { stage: self.target.stage, seed: self.seed }) {
            Ok(sampler) => sampler,
            Err(error) => return Ok((Summary { error: Some(error.to_string()), ..blank }, None)),
        };
        let measured = self.target.measured();
        let work = self.count(&*sampler, &measured);
        let an_arrival = (work.work.weighed as f64 / COUNTED.min(measured.len()).max(1) as f64).max(1.0);
        let affordable = (DEAREST / (f64::from(ROUND) * an_arrival)) as usize;
        if affordable < FEWEST_RECEIVERS.min(measured.len()) {
            let all = an_arrival * f64::from(ROUND) * FEWEST_RECEIVERS as f64;
            let skipped = Some(format!("skipped: it would weigh lights {all:.0e} times, {DEAREST:.0e} at most"));
            return Ok((Summary { skipped, ..blank }, None));
        }
        let places: Vec<usize> = target::places(measured.len(), affordable.min(MOST_RECEIVERS)).collect();
        let receivers: Vec<Receiver> = places.iter().map(|&i| measured[i]).collect();
        let rounds = (affordable / receivers.len().max(1)).clamp(1, ROUNDS as usize) as u32;
        watch.begin("oracle", u64::from(rounds * ROUND));
        let mut floor = Floor { truth: self.truth.only(&places), places, runs: Vec::new() };
        loop {
            let first = floor.runs.len() as u32;
            let more = (first..first + ROUND).into_par_iter().map(|run| {
                watch.check()?;
                let errors = self.errors(&*sampler, &receivers, &floor.truth, run);
                watch.advance(1);
                Ok(errors)
            });
            let more = more.collect::<Result<Vec<_>>>()?;
            floor.runs.extend(more);
            let narrow = |rung| {
                let found = floor.figure(rung).interval();
                found.half_width() <= NARROW * found.mean.abs()
            };
            if (0..self.rungs.len()).all(narrow) || floor.runs.len() as u32 >= rounds * ROUND {
                break;
            }
        }
        watch.end();
        let summary = Summary {
            runs: floor.runs.len() as u32,
            passes,
            receivers: Some(receivers.len() as u64),
            rel_mse: floor.figure(self.rungs.len() - 1).interval(),
            heap_bytes: sampler.heap_bytes() as u64,
            counts: counts(work),
            ..blank
        };
        Ok((summary, Some(floor)))
    }

    /// Work of a few arrivals, over as many passes as every strategy's is counted.
    fn count(&self, sampler: &dyn AnySampler, measured: &[Receiver]) -> Counts {
        let few: Vec<Receiver> = target::places(measured.len(), COUNTED).map(|i| measured[i]).collect();
        let key = RunKey { seed: !self.seed, run: 0 };
        Plan { stage: self.target.stage, receivers: &few, sampler, key }.run_counting(PASSES, &mut Film::new(few.len()))
    }

    /// Errors of a run after each number of passes. Each receiver is arrived at once, and its passes shaded one by one.
    fn errors(&self, sampler: &dyn AnySampler, receivers: &[Receiver], truth: &Truth, run: u32) -> Vec<Errors> {
        let stage = self.target.stage;
        let key = RunKey { seed: self.seed, run };
        let most = self.rungs.last().copied().unwrap_or(0);
        let mut images = vec![vec![Vec3::ZERO; receivers.len()]; self.rungs.len()];
        let mut sums = vec![DVec3::ZERO; receivers.len()];
        let (mut picks, mut rays) = (PickBuffer::default(), 0);
        for block in blocks(sampler, 0..most) {
            let begun = sampler.begin(Frame::new(receivers, key), block.clone());
            let mut worker = begun.worker(false);
            for (i, at) in receivers.iter().enumerate() {
                worker.fill(std::slice::from_ref(at), block.clone(), true, &mut picks);
                for (pass, call) in (block.start + 1..).zip(picks.calls()) {
                    for pick in call {
                        let light = &stage.scene().lights()[pick.light as usize];
                        sums[i] += shadowed(stage, stage.light_sampling(), at, light, pick.uv, &mut rays)
                            * f64::from(pick.weight);
                    }
                    if let Some(rung) = self.rungs.iter().position(|&rung| rung == pass) {
                        images[rung][i] = (sums[i] / f64::from(pass)).as_vec3();
                    }
                }
            }
        }
        images.iter().map(|image| truth.errors(image)).collect()
    }
}
