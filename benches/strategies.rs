//! What do set-up and sampling cost, by strategy and number of lights?
//!
//! `setup/SCENE/STRATEGY` is the CPU time of building a sampler; `sample/SCENE/STRATEGY` that of one receiver in one
//! pass: choice, shading and shadow rays, on one thread. Every strategy of the registry is here. Receivers are sampled
//! [`PASSES`] passes at a time, which share what a strategy does once a receiver; a strategy that takes many
//! lights gets fewer receivers. A set-up under 1 µs is nothing but the clock's own 0.4 µs and an allocation.
//!
//! To compare a strategy of one's own: add its line to `strategy::registry`, then `cargo bench --bench strategies`.
//! To compare a change: `cargo bench --bench strategies -- --save-baseline before`, change it,
//! `cargo bench --bench strategies -- --baseline before`. A part of a name as an argument selects: `sample/downtown`.

mod common;

use citylights::base::random::RunKey;
use citylights::measure::target::spread;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::strategy::BuildContext;
use citylights::strategy::registry::{STRATEGIES, parse};
use common::{CPU_TIME, Reported};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};

/// Points alone; every kind in a small street; ten thousand lights in canyons.
const SCENES: [&str; 3] = ["lamps-only", "first-night", "downtown"];
const PASSES: u32 = 8;
/// Most receivers, and about how many picks a pass at most.
const RECEIVERS: usize = 1024;
const PICKS: u64 = 32_768;
const KEY: RunKey = RunKey { seed: 1, run: 0 };

fn main() {
    let mut criterion = common::criterion(CPU_TIME).sample_size(10);
    SCENES.into_iter().for_each(|scene| bench(&mut criterion, scene));
    criterion.final_summary();
}

fn bench(criterion: &mut Criterion<Reported>, scene: &str) {
    let stage = common::stage(scene);
    let context = BuildContext { stage: &stage, seed: 1 };
    eprintln!("{scene}: {} lights, {} to choose from", stage.scene().lights().len(), stage.lights().len());
    for entry in STRATEGIES {
        let name = entry.info().name;
        let strategy = parse(name).expect("a name of the registry");
        let mut group = common::flat(criterion, "setup");
        group.bench_function(BenchmarkId::new(scene, name), |b| common::making(b, || strategy.build(context)));
        group.finish();

        let mut group = criterion.benchmark_group("sample");
        group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(1));
        let sampler = strategy.build(context).unwrap_or_else(|error| panic!("{name}: {error}"));
        let plan = |receivers| Plan { stage: &stage, receivers, sampler: sampler.as_ref(), key: KEY };
        let few = spread(stage.receivers(), 64);
        let counts = plan(&few).run_counting(1, &mut Film::new(few.len()));
        let receivers = (PICKS * counts.samples / counts.picks.max(1)).clamp(16, RECEIVERS as u64) as usize;
        let receivers = spread(stage.receivers(), receivers);
        group.bench_function(BenchmarkId::new(scene, name), |b| {
            common::per_element(b, receivers.len() * PASSES as usize, || {
                let mut film = Film::new(receivers.len());
                plan(&receivers).run(PASSES, &mut film);
                film
            });
        });
        group.finish();
    }
}
