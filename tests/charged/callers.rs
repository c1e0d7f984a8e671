//! Promise: whatever a strategy starts and waits for is charged to it, and by every caller alike.
use super::{spin, to_itself};
use crate::promises::common::{sixteen, stage};
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::base::random::RunKey;
use citylights::measure::clock::Cpu;
use citylights::measure::engine::{Block, Engine, Meter, build_seed, part_s};
use citylights::measure::errors::Truth;
use citylights::measure::experiment::{Experiment, Nowhere};
use citylights::measure::observer::Unobserved;
use citylights::measure::plan::Budget;
use citylights::measure::target::{Target, spread};
use citylights::record::Row;
use citylights::scene::light::LightId;
use citylights::scene::receiver::Receiver;
use citylights::sources::{Overrides, open};
use citylights::strategy::{
    Arguments, BuildContext, Claim, Configured, Info, LightSampler, Picks, Registry, Strategy, Tally,
};
use citylights::study::trial::{Budgets, Trial};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use cpu_time::ThreadTime;
use glam::Vec3;
use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// CPU seconds of a build, and of an arrival.
const BUILD: f64 = 8e-3;
const ARRIVAL: f64 = 1.5e-3;
/// Receivers that are arrived at.
const RECEIVERS: usize = 24;

/// Does `work` as the engine does a unit.
fn alone<T: Send>(work: impl FnOnce(Meter<'_>) -> T + Send) -> T {
    Engine { clock: &Cpu::new(), workers: 1, seed: 0 }.alone(work).expect("a thread")
}

/// A shipped scene.
fn scene_stage(name: &str) -> Stage {
    let file = Path::new("scenes").join(name).with_extension("toml");
    Stage::new(open(&file, &Overrides::default()).expect(name), LeaveOut::Yes, Offset::SCALED)
}

const TOGETHER: u8 = 0;
const OWN_THREAD: u8 = 1;

/// A strategy that works in ways that other threads could serve.
struct Busy<const HOW: u8>;

/// Does so many CPU seconds of work and waits for it.
fn work<const HOW: u8>(seconds: f64) {
    if HOW == OWN_THREAD {
        std::thread::spawn(move || spin(seconds)).join().expect("it only spins");
        return;
    }
    let third = seconds / 3.0;
    rayon::scope(|scope| (0..4).for_each(|_| scope.spawn(|_| spin(third / 4.0))));
    (0..4).into_par_iter().for_each(|_| spin(third / 4.0));
    let done = std::sync::Arc::new(AtomicBool::new(false));
    let told = std::sync::Arc::clone(&done);
    rayon::spawn(move || {
        spin(third);
        told.store(true, Ordering::Release);
    });
    while !done.load(Ordering::Acquire) {
        rayon::yield_now();
    }
}

impl<const HOW: u8> Strategy for Busy<HOW> {
    const INFO: Info = Info {
        name: if HOW == OWN_THREAD { "own-thread" } else { "together" },
        summary: "does known work before it chooses at random",
        source: "this test",
        claim: Claim::Unbiased,
    };
    type Sampler = Uniform<HOW>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        work::<HOW>(BUILD);
        Ok(Uniform { lights: context.stage.scene().lights().len() })
    }
}

struct Uniform<const HOW: u8> {
    lights: usize,
}

impl<const HOW: u8> LightSampler for Uniform<HOW> {
    type Scratch = ();

    fn arrive<T: Tally>(&self, _at: &Receiver, (): &mut (), _tally: &mut T) {
        work::<HOW>(ARRIVAL);
    }

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, (): &mut (), out: &mut Picks<'_, T>) {
        let light = (draws.choice(0, 1) * self.lights as f64) as LightId;
        out.push(light.min(self.lights as LightId - 1), self.lights as f32);
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        counts.iter_mut().for_each(|count| *count += 1.0 / self.lights as f32);
        true
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

fn busy(name: &str) -> Configured {
    let registry = Registry::empty().with::<Busy<TOGETHER>>().with::<Busy<OWN_THREAD>>();
    registry.parse(name).expect("a name of this test")
}

const KEY: RunKey = RunKey { seed: 1, run: 0 };

/// CPU seconds of set-up and of sampling that a caller finds for one block of one pass.
type Caller = fn(&Target<'_>, &Truth, &Configured) -> [f64; 2];

/// Those that time strategies, by what they answer to.
const CALLERS: [(&str, Caller); 3] = [("compare", by_compare), ("study", by_study), ("bench", by_bench)];

fn by_compare(target: &Target<'_>, truth: &Truth, strategy: &Configured) -> [f64; 2] {
    let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
    let (strategies, ladders) = ([strategy], [vec![1]]);
    let experiment =
        Experiment { engine: &engine, target, truth, strategies: &strategies, ladders: &ladders, runs: 1, seed: 1 };
    let (runs, _) = experiment.run(&mut Nowhere, &Unobserved).expect("nobody stops it");
    let Row { setup_cpu_s, cpu_s, error, .. } = &runs[0].rows[0];
    assert_eq!(*error, None, "{}", strategy.name());
    [*setup_cpu_s, *cpu_s]
}

fn by_study(target: &Target<'_>, truth: &Truth, strategy: &Configured) -> [f64; 2] {
    let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
    let trial = Trial { engine: &engine, target, truth, budget: Budget::up_to(1, 1e3), runs: 1, seed: 1 };
    let tried = trial.run(&[strategy], Budgets::Largest, &Unobserved).expect("nobody stops it");
    let summary = &tried[0].summary;
    assert_eq!((&summary.error, &summary.skipped), (&None, &None), "{}", strategy.name());
    [summary.setup_cpu_s.mean, summary.cpu_s.mean]
}

fn by_bench(target: &Target<'_>, _: &Truth, strategy: &Configured) -> [f64; 2] {
    let block = Block { stage: target.stage, receivers: &target.frame, strategy, key: KEY, passes: 1 };
    [part_s(block, 1, |done| done.setup.cpu), part_s(block, 1, |done| done.sampling.cpu)]
        .map(|spent| spent.expect("it serves"))
}

/// A frame of a few receivers, and its truth.
fn few(stage: &Stage, count: usize) -> (Target<'_>, Truth) {
    let target = Target::of(stage, spread(stage.receivers(), count));
    // Nothing here looks at errors.
    let image = vec![Vec3::ONE; target.frame.len()];
    (target, Truth::new([image.clone(), image]))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn a_strategy_of_known_work_is_charged_for_it_by_every_caller() {
    let Some(_alone) = to_itself() else { return };
    let stage = stage(sixteen());
    let (target, truth) = few(&stage, RECEIVERS);
    let strategy = busy("together");
    let known = [BUILD, ARRIVAL * RECEIVERS as f64];
    let mut shares = vec![[Vec::new(), Vec::new()]; CALLERS.len()];
    for _ in 0..7 {
        for ((_, caller), shares) in CALLERS.iter().zip(&mut shares) {
            let charged = caller(&target, &truth, &strategy);
            (0..2).for_each(|part| shares[part].push(charged[part] / known[part]));
        }
    }
    for ((name, _), shares) in CALLERS.iter().zip(shares) {
        for (part, shares) in ["set-up", "sampling"].iter().zip(shares) {
            let share = median(shares);
            println!("{name} charges {share:.3} of the known work of {part}");
            assert!((0.9..=1.1).contains(&share), "{name} charges {share:.3} of the known work of {part}");
        }
    }
}

#[test]
fn work_on_a_thread_of_its_own_is_found() {
    let Some(_alone) = to_itself() else { return };
    let stage = stage(sixteen());
    let context = BuildContext { stage: &stage, seed: build_seed(KEY) };
    for (name, wanted) in [("together", 0.0..0.1), ("own-thread", 0.8..1.0)] {
        let strategy = busy(name);
        let account = alone(|meter| meter.audit(|| strategy.build(context).map(drop)).1);
        assert!(wanted.contains(&account.stray_share()), "{name}: {account:?}");
    }
}

/// Callers on a scene of `scenes/` against a clock around the build in a pool of one thread; lines of a table, and the
/// greatest ratio of those that take long enough to be told, if any does.
fn setups(scene: &str, rounds: usize) -> Option<f64> {
    let stage = scene_stage(scene);
    let (target, truth) = few(&stage, 8);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let direct = |strategy: &Configured| {
        let context = BuildContext { stage: &stage, seed: build_seed(KEY) };
        pool.install(|| {
            let clock = ThreadTime::now();
            let sampler = strategy.build(context);
            let spent = clock.elapsed().as_secs_f64();
            drop(sampler);
            spent
        })
    };
    let mut worst: Option<f64> = None;
    println!("{scene}: set-up in ms, and over that: {}", CALLERS.map(|(name, _)| name).join(", "));
    for info in Registry::standard().infos() {
        let strategy = Registry::standard().parse(info.name).expect("a name of the registry");
        let mut times = vec![Vec::new(); 1 + CALLERS.len()];
        for _ in 0..rounds {
            times[0].push(direct(&strategy));
            for ((_, caller), times) in CALLERS.iter().zip(&mut times[1..]) {
                times.push(caller(&target, &truth, &strategy)[0]);
            }
        }
        // What else a machine does only adds.
        let least: Vec<f64> = times.into_iter().map(|times| times.into_iter().fold(f64::INFINITY, f64::min)).collect();
        let ratios: Vec<f64> = least[1..].iter().map(|caller| caller / least[0]).collect();
        println!(
            "{:<22}{:>9.4}{}",
            strategy.name(),
            1e3 * least[0],
            ratios.iter().map(|r| format!("{r:>8.3}")).collect::<String>()
        );
        // Below a fifth of a millisecond it is the clock, the allocator and its page faults that are timed.
        if least[0] > 2e-4 {
            worst = Some(ratios.iter().fold(worst.unwrap_or(1.0), |worst, ratio| worst.max(*ratio).max(1.0 / ratio)));
        }
    }
    worst
}

/// As the project promises: `CITYLIGHTS_CHARGED_ALONE=1 cargo test --release --lib every_caller_finds -- --ignored --nocapture`.
#[test]
#[ignore = "a minute, and only on a machine that does nothing else"]
fn every_caller_finds_the_same_set_up() {
    let Some(_alone) = to_itself() else { return };
    for scene in ["downtown", "metropolis"] {
        let worst = setups(scene, 9).expect("a set-up that takes long enough");
        assert!(worst <= 1.15, "{scene}: a caller is {worst:.3} off the others");
    }
}
