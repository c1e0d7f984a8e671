//! What do set-up and sampling cost, by strategy and number of lights?
//!
//! `setup/SCENE/STRATEGY` is the CPU time of building a sampler; `sample/SCENE/STRATEGY` that of one receiver in one
//! pass: choice, shading and shadow rays. Both are parts of what `compare` measures: a block of [`PASSES`] passes from
//! nothing, what is learned on the way included, alone on one thread. Every strategy of the registry is here. Receivers are
//! squares of neighbours from all over the frame; a strategy that takes many lights gets fewer. A set-up under 1 µs is
//! nothing but the clock's own 0.4 µs and an allocation.
//!
//! To compare a change: `cargo bench --features bench --bench strategies -- --save-baseline before`, change it,
//! `cargo bench --features bench --bench strategies -- --baseline before`. A part of a name as an argument selects: `sample/downtown`.

use super::quantity::{CPU_TIME, Reported, criterion, flat};
use super::scenes::{name, stage};
use super::timing::part_of;
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::measure::engine::{Block, build_seed};
use crate::measure::target::{SQUARE, spread, squares};
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::strategy::{BuildContext, Registry};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};
use std::path::Path;

const PASSES: u32 = 8;
/// Most squares of receivers, and about how many picks a pass at most.
const SQUARES: u64 = 16;
const PICKS: u64 = 32_768;
const KEY: RunKey = RunKey { seed: 1, run: 0 };

/// The groups `setup` and `sample`: all strategies of a registry on the scenes of these files. Options such as
/// `--save-baseline` are taken from the command line.
///
/// # Errors
/// A scene that cannot be read; a strategy that cannot serve one.
pub fn strategies(registry: &Registry, scenes: &[&Path]) -> Result<()> {
    let mut criterion = criterion(CPU_TIME).sample_size(10);
    scenes.iter().try_for_each(|scene| bench(&mut criterion, registry, scene))?;
    criterion.final_summary();
    Ok(())
}

fn bench(criterion: &mut Criterion<Reported>, registry: &Registry, file: &Path) -> Result<()> {
    let (scene, stage) = (name(file), stage(file)?);
    let context = BuildContext { stage: &stage, seed: build_seed(KEY) };
    eprintln!("{scene}: {} lights, {} to choose from", stage.scene().lights().len(), stage.lights().len());
    for strategy in registry.all()?.into_iter().filter(|one| one.info().claim != Claim::Oracle) {
        let name = strategy.name();
        let mut group = flat(criterion, "setup");
        let block = |receivers, passes| Block { stage: &stage, receivers, strategy: &strategy, key: KEY, passes };
        let nothing = block(&[], 0);
        group.bench_function(BenchmarkId::new(&scene, name), |b| part_of(b, nothing, 1, |done| done.setup.cpu));
        group.finish();

        let mut group = criterion.benchmark_group("sample");
        group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(1));
        let sampler = strategy.build(context)?;
        let few = spread(stage.receivers(), 64);
        let plan = Plan { stage: &stage, receivers: &few, sampler: sampler.as_ref(), key: KEY };
        let counts = plan.run_counting(1, &mut Film::new(few.len()));
        let affordable = PICKS * counts.samples / counts.picks.max(1) / SQUARE as u64;
        let receivers = squares(stage.receivers(), affordable.clamp(1, SQUARES) as usize);
        let (block, samples) = (block(&receivers, PASSES), receivers.len() * PASSES as usize);
        group.bench_function(BenchmarkId::new(&scene, name), |b| {
            part_of(b, block, samples, |done| done.sampling.cpu);
        });
        group.finish();
    }
    Ok(())
}
