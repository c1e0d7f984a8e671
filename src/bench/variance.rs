//! How large is a strategy's error after one pass?
//!
//! `variance/SCENE/STRATEGY` is the mean squared error of one pass about the strategy's own mean, for an unbiased
//! strategy; `mse/SCENE/STRATEGY` that about the reference, for a biased one. Both are relative: squares over the
//! squared truth, as in relMSE. Absolute squares are those of a few pixels next to a lamp: their mean over 100 passes
//! says nothing yet (of a `uniform` with four times the variance: +57 %, p = 0.63). A strategy that gives the same in
//! every pass is left out: it has no variance, and criterion cannot use a quantity that never varies.
//!
//! A sample is one pass, with the random numbers of the passes 0 to 99 in turn: the same set in every run and on every
//! machine, so that two runs of the same code give the same figure to the last digit. Criterion prints numbers of
//! iterations that follow from time; they decide nothing here.
//!
//! To compare a change: `cargo bench --features bench --bench variance -- --save-baseline before`, change it, `cargo bench --features bench --bench
//! variance -- --baseline before`.

use super::quantity::{RELATIVE_ERROR, Reported, criterion, flat};
use super::scenes::{name, stage};
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::measure::observer::Unobserved;
use crate::measure::reference::Reference;
use crate::measure::target::{Target, spread};
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::strategy::{BuildContext, Registry};
use criterion::{BenchmarkId, Criterion};
use glam::Vec3;
use std::path::Path;
use std::time::Duration;

/// Receivers that stand for the image.
const RECEIVERS: usize = 1024;
/// Samples, and passes that are taken in turn: with both the same, every run sees each pass once.
const CYCLE: u32 = 100;
/// Passes behind a strategy's own mean; its noise adds 1/200 to every figure.
const OWN_MEAN: u32 = 200;
const SEED: u64 = 1;

/// The groups `variance` and `mse`: all strategies of a registry on the scenes of these files, whose references are kept
/// in the folder `cache`. Options such as `--save-baseline` are taken from the command line.
///
/// # Errors
/// A scene that cannot be read; a strategy that cannot serve one; a reference that cannot be written.
pub fn variance(registry: &Registry, scenes: &[&Path], cache: &Path) -> Result<()> {
    let mut criterion = criterion(RELATIVE_ERROR)
        .sample_size(CYCLE as usize)
        .warm_up_time(Duration::from_nanos(1))
        .measurement_time(Duration::from_secs(5));
    scenes.iter().try_for_each(|scene| bench(&mut criterion, registry, scene, cache))?;
    criterion.final_summary();
    Ok(())
}

fn bench(criterion: &mut Criterion<Reported>, registry: &Registry, file: &Path, cache: &Path) -> Result<()> {
    let (scene, stage) = (name(file), stage(file)?);
    let target = Target::of(&stage, spread(stage.receivers(), RECEIVERS));
    let reference = Reference::compute(&target, 1e-3, cache, &Unobserved)?;
    for strategy in registry.all()? {
        let name = strategy.name();
        let sampler = strategy.build(BuildContext { stage: &stage, seed: SEED })?;
        let image = |run, first, passes| {
            let key = RunKey { seed: SEED, run };
            let mut film = Film::starting_at(target.frame.len(), first);
            Plan { stage: &stage, receivers: &target.frame, sampler: sampler.as_ref(), key }
                .run_parallel(passes, &mut film);
            film.image()
        };
        if image(0, 0, 1) == image(0, 1, 1) {
            eprintln!("{scene}/{name}: the same in every pass, left out\n");
            continue;
        }
        let truth = &reference.truth;
        let (quantity, centre) = match strategy.info().claim.bias() {
            None => ("variance", image(1, 0, OWN_MEAN)),
            Some(_) => ("mse", truth.mean().to_vec()),
        };
        let error = |image: &[Vec3]| {
            truth.mean_over(|i| {
                let difference = (image[i] - centre[i]).as_dvec3();
                difference * difference * truth.weight(i)
            })
        };
        let mut pass = 0;
        let mut group = flat(criterion, quantity);
        group.bench_function(BenchmarkId::new(&scene, name), |bencher| {
            bencher.iter_custom(|iterations| {
                let error = error(&image(0, pass % CYCLE, 1));
                pass += 1;
                error * iterations as f64
            });
        });
        group.finish();
    }
    Ok(())
}
