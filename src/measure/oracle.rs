//! How far is each choice from the best one?
//!
//! The oracle casts every light's shadow ray before it chooses one. So it runs off the clock, at some of the measured
//! receivers, and the error of every other strategy at those same receivers is divided by its own. Both are errors per
//! sample: relMSE times passes, after as many passes where that is affordable, since spread numbers make it fall.
//!
//! What it weighs at a receiver depends on the receiver alone: that is done once for all runs, and there are as many
//! receivers as the counted work allows.

use super::errors::{Errors, Truth};
use super::experiment::Runs;
use super::figure::Figure;
use super::observer::Observer;
use super::options::ComparisonOptions;
use super::plan::PASSES;
use super::summary::blank;
use super::target::{self, Target};
use super::work::nominal_s;
use crate::base::claim::Claim;
use crate::base::counts::Counts;
use crate::base::draws::{Points, Sequence};
use crate::base::error::Result;
use crate::base::interval::Tail;
use crate::base::random::RunKey;
use crate::record::{Interval, Summary};
use crate::render::exact::shadowed;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, BuildContext, Configured, Pick, Source};
use crate::visibility::stage::Stage;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::any::Any;

/// Most receivers that an oracle is run on.
const MOST_RECEIVERS: usize = 16_384;

/// Fewest receivers that say anything of the image.
const FEWEST_RECEIVERS: usize = 64;

/// Independent runs of an oracle.
const RUNS: u32 = 96;

/// Counts is counted at so many receivers.
const COUNTED: usize = 16;

/// Most work of an oracle on one scene, in nominal CPU seconds.
const ORACLE_S: f64 = 12.0;

/// Whether a strategy is run here and not against the clock.
pub(super) fn is_oracle(strategy: &Configured) -> bool {
    strategy.info().claim == Claim::Oracle
}

/// Runs the oracles among the strategies, and gives every summary its ratio to the first of them.
pub(super) fn settle(
    target: &Target<'_>,
    truth: &Truth,
    options: &ComparisonOptions<'_>,
    runs: &[Runs],
    summaries: &mut [Summary],
    watch: &dyn Observer,
) -> Result<()> {
    if target.stage.visits().moves() {
        // It would weigh every light with a ray of its own at each of them.
        let oracles = options.strategies.iter().zip(summaries).filter(|(strategy, _)| is_oracle(strategy));
        oracles.for_each(|(_, summary)| summary.skipped = Some("skipped: run only where receivers stay".into()));
        return Ok(());
    }
    let compared = |s: &Summary| s.chooses && s.runs > 0 && s.error.is_none();
    let mut rungs: Vec<u32> = summaries.iter().filter(|s| compared(s)).map(|s| s.passes).collect();
    rungs.retain(|&passes| passes <= options.budget.usual_passes);
    rungs.sort_unstable();
    rungs.dedup();
    let ground = Ground { target, truth, rungs: &rungs, seed: options.seed };
    let mut floor: Option<Floor> = None;
    for (strategy, summary) in options.strategies.iter().zip(&mut *summaries).filter(|(one, _)| is_oracle(one)) {
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
        let samples = f64::from(summary.passes) / f64::from(rungs[rung]);
        let at = |image: &Vec<Vec3>| floor.truth.errors(&floor.places.iter().map(|&i| image[i]).collect::<Vec<Vec3>>());
        let own = figure(&runs.images.iter().map(at).collect::<Vec<Errors>>());
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
    receivers: Vec<Receiver>,
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
        let Some(source) = sampler.source() else {
            let skipped = "skipped: an oracle chooses at one receiver, without state of a pass or a view of the frame";
            return Ok((Summary { skipped: Some(skipped.into()), ..blank }, None));
        };
        let measured = self.target.measured();
        let work = self.count(&*sampler, &measured);
        let cost = Cost::of_few(source, &measured);
        let affordable = (ORACLE_S / cost.of(RUNS * passes)) as usize;
        if affordable < FEWEST_RECEIVERS.min(measured.len()) {
            let least = cost.of(RUNS * passes) * FEWEST_RECEIVERS as f64;
            let skipped = format!(
                "skipped: {FEWEST_RECEIVERS} receivers are {least:.0} s of counted work, {ORACLE_S:.0} s at most"
            );
            return Ok((Summary { skipped: Some(skipped), ..blank }, None));
        }
        let places: Vec<usize> = target::places(measured.len(), affordable.min(MOST_RECEIVERS)).collect();
        let receivers: Vec<Receiver> = places.iter().map(|&i| measured[i]).collect();
        let truth = self.truth.only(&places);
        let chooser = Chooser { source, points: strategy.points(), receivers: &receivers, rungs: self.rungs };
        let keys: Vec<RunKey> = (0..RUNS).map(|run| RunKey { seed: self.seed, run }).collect();
        watch.begin("oracle", receivers.len() as u64);
        let runs = chooser.errors(self.target.stage, &truth, &keys, watch)?;
        watch.end();
        let floor = Floor { places, receivers, truth, runs };
        let summary = Summary {
            runs: floor.runs.len() as u32,
            passes,
            receivers: Some(floor.receivers.len() as u64),
            rel_mse: floor.figure(self.rungs.len() - 1).interval(),
            heap_bytes: sampler.heap_bytes() as u64,
            counts: work,
            ..blank
        };
        Ok((summary, Some(floor)))
    }

    /// Counts at a few receivers, over as many passes as every strategy's is counted.
    fn count(&self, sampler: &dyn AnySampler, measured: &[Receiver]) -> Counts {
        let few = target::spread(measured, COUNTED);
        let key = RunKey { seed: !self.seed, run: 0 };
        Plan { stage: self.target.stage, receivers: &few, sampler, key }.run_counting(PASSES, &mut Film::new(few.len()))
    }
}

/// Nominal seconds at one receiver.
struct Cost {
    arrival_s: f64,
    pass_s: f64,
}

impl Cost {
    /// As counted at a few of these receivers.
    fn of_few(source: &dyn Source, receivers: &[Receiver]) -> Self {
        let few = target::spread(receivers, COUNTED);
        let (mut arrivals, mut passes) = (Counts::default(), Counts::default());
        let (mut scratch, mut picks) = (source.scratch(), Vec::new());
        for at in &few {
            source.arrive(at, &mut *scratch, Some(&mut arrivals));
            let sequence = Sequence::new(RunKey { seed: 0, run: 0 }, at.pixel, Points::Random);
            for pass in 0..PASSES {
                source.sample(at, &mut sequence.pass(pass), &mut *scratch, Some(&mut passes), &mut picks);
            }
        }
        let (samples, picks) = (few.len() as u64 * u64::from(PASSES), picks.len() as u64);
        let passes = Counts { samples, picks, shadow_rays: picks, ..passes };
        let share = |counts: &Counts, of: u64| nominal_s(counts) / of.max(1) as f64;
        Self { arrival_s: share(&arrivals, few.len() as u64), pass_s: share(&passes, samples) }
    }

    /// Of one arrival and so many passes.
    fn of(&self, passes: u32) -> f64 {
        self.arrival_s + f64::from(passes) * self.pass_s
    }
}

/// What chooses lights at one receiver after the other, and where.
struct Chooser<'a> {
    source: &'a dyn Source,
    points: Points,
    receivers: &'a [Receiver],
    /// Numbers of passes, ascending.
    rungs: &'a [u32],
}

impl Chooser<'_> {
    /// Errors of the runs that `keys` name, after each number of passes.
    ///
    /// Each receiver is arrived at once, for all runs: what is done there depends on the receiver alone. So the images
    /// are those that each run would make by itself.
    fn errors(&self, stage: &Stage, truth: &Truth, keys: &[RunKey], watch: &dyn Observer) -> Result<Vec<Vec<Errors>>> {
        let images = self.images(stage, keys, watch)?;
        let each = |of: &[Vec<Vec3>]| of.iter().map(|image| truth.errors(image)).collect();
        Ok(images.par_chunks(self.rungs.len()).map(each).collect())
    }

    /// The images of each run in turn, one for each number of passes.
    fn images(&self, stage: &Stage, keys: &[RunKey], watch: &dyn Observer) -> Result<Vec<Vec<Vec3>>> {
        let visit = |(scratch, picks): &mut (Box<dyn Any + Send>, Vec<Pick>), at: &Receiver| {
            watch.check()?;
            self.source.arrive(at, &mut **scratch, None);
            let values: Vec<Vec3> =
                keys.iter().flat_map(|&key| self.run(stage, at, key, &mut **scratch, picks)).collect();
            watch.advance(1);
            Ok(values)
        };
        let own = || (self.source.scratch(), Vec::new());
        let found = self.receivers.par_iter().map_init(own, visit).collect::<Result<Vec<Vec<Vec3>>>>()?;
        let image = |i: usize| found.iter().map(|values| values[i]).collect();
        Ok((0..keys.len() * self.rungs.len()).map(image).collect())
    }

    /// What a run comes to after each number of passes at the receiver that was arrived at.
    fn run(
        &self,
        stage: &Stage,
        at: &Receiver,
        key: RunKey,
        scratch: &mut dyn Any,
        picks: &mut Vec<Pick>,
    ) -> Vec<Vec3> {
        let sequence = Sequence::new(key, at.pixel, self.points);
        let (mut sum, mut done, mut rays) = (DVec3::ZERO, 0, 0);
        let mut after = |&rung: &u32| {
            for pass in done..rung {
                let mut draws = sequence.pass(pass);
                picks.clear();
                self.source.sample(at, &mut draws, scratch, None, picks);
                for (slot, pick) in (0..).zip(&mut *picks) {
                    pick.settle(slot, &mut draws);
                    let light = &stage.scene().lights()[pick.light as usize];
                    sum +=
                        shadowed(stage, stage.light_sampling(), at, light, pick.uv, &mut rays) * f64::from(pick.weight);
                }
            }
            done = rung;
            (sum / f64::from(rung)).as_vec3()
        };
        self.rungs.iter().map(&mut after).collect()
    }
}

#[cfg(all(test, feature = "recipe"))]
mod tests {
    use super::*;
    use crate::measure::observer::Unobserved;
    use crate::sources::{self, Overrides};
    use crate::strategy::Registry;
    use crate::visibility::offset::Offset;
    use crate::visibility::stage::LeaveOut;
    use std::path::Path;

    #[test]
    fn runs_after_one_arrival_are_those_that_each_makes_by_itself() {
        let small = Overrides { resolution: Some((64, 36)), ..Overrides::default() };
        let scene = sources::open(Path::new("scenes/first-night.toml"), &small).expect("a scene");
        let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
        let receivers = target::spread(stage.receivers(), 50);
        let keys = [0, 1, 5].map(|run| RunKey { seed: 3, run });
        for name in ["oracle", "oracle:points=sobol", "oracle:points=random", "visible", "resampled"] {
            let strategy = Registry::standard().parse(name).expect(name);
            let sampler = strategy.build(BuildContext { stage: &stage, seed: 3 }).expect(name);
            let source = sampler.source().expect(name);
            let chooser = Chooser { source, points: strategy.points(), receivers: &receivers, rungs: &[1, 4, 6] };
            let images = chooser.images(&stage, &keys, &Unobserved).expect(name);
            for (key, images) in keys.into_iter().zip(images.chunks(3)) {
                for (&passes, image) in chooser.rungs.iter().zip(images) {
                    let mut film = Film::new(receivers.len());
                    let plan = Plan { stage: &stage, receivers: &receivers, sampler: &*sampler, key };
                    plan.run(passes, &mut film);
                    assert!(film.image() == *image, "{name}, run {} after {passes} passes", key.run);
                }
            }
        }
    }
}
