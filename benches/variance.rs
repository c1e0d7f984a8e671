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
//! To compare a change: `cargo bench --bench variance -- --save-baseline before`, change it, `cargo bench --bench
//! variance -- --baseline before`. To see that a worse estimator is found, set `CITYLIGHTS_BENCH_MUTANT=1` for the
//! second: each pick of [`Mutant`]'s strategies is then kept with a chance of 1/4 only, and weighted four times.

mod common;

use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::base::random::RunKey;
use citylights::measure::observer::Unobserved;
use citylights::measure::reference::Reference;
use citylights::measure::target::{Target, spread};
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::receiver::Receiver;
use citylights::strategy::parameters::Arguments;
use citylights::strategy::registry::{Entry, STRATEGIES, parse_from};
use citylights::strategy::tally::Tally;
use citylights::strategy::{BuildContext, Claim, Info, LightSampler, Pick, Picks, Strategy};
use citylights::strategy::{intensity, power, uniform};
use common::{RELATIVE_ERROR, Reported};
use criterion::{BenchmarkId, Criterion};
use glam::Vec3;
use std::path::Path;
use std::time::Duration;

const SCENES: [&str; 2] = ["lamps-only", "first-night"];
/// Receivers that stand for the image.
const RECEIVERS: usize = 1024;
/// Samples, and passes that are taken in turn: with both the same, every run sees each pass once.
const CYCLE: u32 = 100;
/// Passes behind a strategy's own mean; its noise adds 1/200 to every figure.
const OWN_MEAN: u32 = 200;
const SEED: u64 = 1;

fn main() {
    let mut criterion = common::criterion(RELATIVE_ERROR)
        .sample_size(CYCLE as usize)
        .warm_up_time(Duration::from_nanos(1))
        .measurement_time(Duration::from_secs(5));
    let entries = entries(std::env::var_os("CITYLIGHTS_BENCH_MUTANT").is_some());
    SCENES.into_iter().for_each(|scene| bench(&mut criterion, scene, &entries));
    criterion.final_summary();
}

fn bench(criterion: &mut Criterion<Reported>, scene: &str, entries: &[Entry]) {
    let stage = common::stage(scene);
    let target = Target::of(&stage, spread(stage.receivers(), RECEIVERS));
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("references");
    let reference =
        Reference::compute(&target, 1e-3, &cache, &Unobserved).unwrap_or_else(|error| panic!("{scene}: {error}"));
    for entry in entries {
        let name = entry.info().name;
        let strategy = parse_from(entries, name).expect("a name of the registry");
        let sampler = strategy
            .build(BuildContext { stage: &stage, seed: SEED })
            .unwrap_or_else(|error| panic!("{name}: {error}"));
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
        let (quantity, centre) = match entry.info().claim {
            Claim::Unbiased => ("variance", image(1, 0, OWN_MEAN)),
            Claim::Biased(_) => ("mse", truth.mean().to_vec()),
        };
        let error = |image: &[Vec3]| {
            truth.mean_over(|i| {
                let difference = (image[i] - centre[i]).as_dvec3();
                difference * difference * truth.weight(i)
            })
        };
        let mut pass = 0;
        let mut group = common::flat(criterion, quantity);
        group.bench_function(BenchmarkId::new(scene, name), |bencher| {
            bencher.iter_custom(|iterations| {
                let error = error(&image(0, pass % CYCLE, 1));
                pass += 1;
                error * iterations as f64
            });
        });
        group.finish();
    }
}

/// The registry, with mutants in place of some strategies if asked for.
fn entries(mutants: bool) -> Vec<Entry> {
    let mutant = [
        Entry::of::<Mutant<uniform::Uniform>>(),
        Entry::of::<Mutant<power::Power>>(),
        Entry::of::<Mutant<intensity::Intensity>>(),
    ];
    let of = |entry: &Entry| mutant.iter().find(|m| mutants && m.info().name == entry.info().name).copied();
    STRATEGIES.iter().map(|entry| of(entry).unwrap_or(*entry)).collect()
}

/// A strategy made worse: of a variance V about a mean m it makes `4 V + 3 m²`, unbiased as before.
struct Mutant<S>(S);

/// [`Mutant`] for a scene.
struct Thinned<L>(L);

impl<S: Strategy<Sampler: LightSampler>> Strategy for Mutant<S> {
    const INFO: Info = S::INFO;
    type Sampler = Thinned<S::Sampler>;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        Ok(Self(S::configure(arguments)?))
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(Thinned(self.0.build(context)?))
    }
}

impl<L: LightSampler> LightSampler for Thinned<L> {
    type Scratch = (L::Scratch, Vec<Pick>);

    fn arrive<T: Tally>(&self, at: &Receiver, (scratch, _): &mut Self::Scratch, tally: &mut T) {
        self.0.arrive(at, scratch, tally);
    }

    fn sample<T: Tally>(
        &self,
        at: &Receiver,
        draws: &mut Draws,
        (scratch, picks): &mut Self::Scratch,
        out: &mut Picks<'_, T>,
    ) {
        picks.clear();
        self.0.sample(at, draws, scratch, &mut Picks::new(picks, out.tally));
        for pick in picks.iter() {
            if draws.stream().below(4) == 0 {
                out.push(pick.light, 4.0 * pick.weight);
            }
        }
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        self.0.heap_bytes()
    }
}
