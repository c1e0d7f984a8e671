//! What do set-up and sampling cost, by strategy and number of lights?
//!
//! `setup/SCENE/STRATEGY` is the CPU time of building a sampler; `sample/SCENE/STRATEGY` that of one receiver in one
//! pass: choice, shading and shadow rays. Both are parts of what `compare` measures: a block of [`PASSES`] passes from
//! nothing, what is learned on the way included, alone on one thread. Every strategy of the registry is here. Receivers are
//! squares of neighbours from all over the frame; a strategy that takes many lights gets fewer. A set-up under 1 µs is
//! nothing but the clock's own 0.4 µs and an allocation.
//!
//! To compare a strategy of one's own: add its line to `strategy::registry`, then `cargo bench --bench strategies`.
//! To compare a change: `cargo bench --bench strategies -- --save-baseline before`, change it,
//! `cargo bench --bench strategies -- --baseline before`. A part of a name as an argument selects: `sample/downtown`.

mod common;

use citylights::base::random::RunKey;
use citylights::measure::engine::{Block, build_seed};
use citylights::measure::target::{SQUARE, spread, squares};
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::strategy::BuildContext;
use citylights::strategy::registry::{STRATEGIES, parse};
use common::{CPU_TIME, Reported};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};

/// Points alone; every kind in a small street; ten thousand lights in canyons.
const SCENES: [&str; 3] = ["lamps-only", "first-night", "downtown"];
const PASSES: u32 = 8;
/// Most squares of receivers, and about how many picks a pass at most.
const SQUARES: u64 = 16;
const PICKS: u64 = 32_768;
const KEY: RunKey = RunKey { seed: 1, run: 0 };

fn main() {
    let mut criterion = common::criterion(CPU_TIME).sample_size(10);
    SCENES.into_iter().for_each(|scene| bench(&mut criterion, scene));
    criterion.final_summary();
}

fn bench(criterion: &mut Criterion<Reported>, scene: &str) {
    let stage = common::stage(scene);
    let context = BuildContext { stage: &stage, seed: build_seed(KEY) };
    eprintln!("{scene}: {} lights, {} to choose from", stage.scene().lights().len(), stage.lights().len());
    for entry in STRATEGIES {
        let name = entry.info().name;
        let strategy = parse(name).expect("a name of the registry");
        let mut group = common::flat(criterion, "setup");
        let block = |receivers, passes| Block { stage: &stage, receivers, strategy: &strategy, key: KEY, passes };
        let nothing = block(&[], 0);
        group.bench_function(BenchmarkId::new(scene, name), |b| common::part_of(b, nothing, 1, |done| done.setup.cpu));
        group.finish();

        let mut group = criterion.benchmark_group("sample");
        group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(1));
        let sampler = strategy.build(context).unwrap_or_else(|error| panic!("{name}: {error}"));
        let few = spread(stage.receivers(), 64);
        let plan = Plan { stage: &stage, receivers: &few, sampler: sampler.as_ref(), key: KEY };
        let counts = plan.run_counting(1, &mut Film::new(few.len()));
        let affordable = PICKS * counts.samples / counts.picks.max(1) / SQUARE as u64;
        let receivers = squares(stage.receivers(), affordable.clamp(1, SQUARES) as usize);
        let (block, samples) = (block(&receivers, PASSES), receivers.len() * PASSES as usize);
        group.bench_function(BenchmarkId::new(scene, name), |b| {
            common::part_of(b, block, samples, |done| done.sampling.cpu);
        });
        group.finish();
    }
}
