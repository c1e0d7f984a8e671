//! Promise: whatever a unit of work starts and waits for is on its clock, and what it leaves to others is found.

use super::{spin, to_itself};
use crate::promises::common::{sixteen, stage};
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::base::random::RunKey;
use citylights::measure::clock::{Cpu, Spent};
use citylights::measure::engine::{Block, Engine, Meter};
use citylights::measure::observer::Unobserved;
use citylights::scene::Scene;
use citylights::scene::receiver::Receiver;
use citylights::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Registry, Strategy, Tally};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use citylights::visibility::visits::Receivers;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// CPU seconds of a quarter of a unit's work.
const QUARTER: f64 = 2.5e-3;

#[test]
fn what_a_unit_starts_and_waits_for_is_on_its_clock() {
    let Some(_alone) = to_itself() else { return };
    let engine = Engine { clock: &Cpu::new(), workers: 2, seed: 1 };
    let plain = || (0..4).for_each(|_| spin(QUARTER));
    let scope = || rayon::scope(|scope| (0..4).for_each(|_| scope.spawn(|_| spin(QUARTER))));
    let join = || {
        rayon::join(|| spin(2.0 * QUARTER), || spin(2.0 * QUARTER));
    };
    let iterator = || (0..4).into_par_iter().for_each(|_| spin(QUARTER));
    let spawn = || {
        static DONE: AtomicU64 = AtomicU64::new(0);
        DONE.store(0, Ordering::SeqCst);
        for _ in 0..4 {
            rayon::spawn(|| {
                spin(QUARTER);
                DONE.fetch_add(1, Ordering::SeqCst);
            });
        }
        while DONE.load(Ordering::SeqCst) < 4 {
            rayon::yield_now();
        }
    };
    let ways: [(&str, &(dyn Fn() + Sync)); 5] =
        [("plain", &plain), ("scope", &scope), ("join", &join), ("par_iter", &iterator), ("spawn", &spawn)];
    let mut times = vec![Vec::new(); ways.len()];
    // A way with a static of its own must not run beside itself.
    let one = Engine { workers: 1, ..engine };
    let units: Vec<usize> = (0..9 * ways.len()).map(|unit| unit % ways.len()).collect();
    one.run(
        "ways",
        &units,
        &Unobserved,
        |&way, meter| Ok(meter.time(ways[way].1).1),
        |&way, spent: Spent| {
            times[way].push(spent.cpu);
            Ok(())
        },
    )
    .expect("done");
    let median = |times: &[f64]| {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    };
    for ((name, _), times) in ways.iter().zip(&times) {
        let share = median(times) / (4.0 * QUARTER);
        println!("{name} is charged {share:.3} of its work");
        assert!((0.9..=1.1).contains(&share), "{name} is charged {share:.3} of its work");
    }
}

#[test]
fn a_thread_of_its_own_is_found_by_the_clock_of_the_process() {
    let Some(_alone) = to_itself() else { return };
    let stray = |work: fn()| {
        let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
        let unit = |(): &(), _: Meter<'_>| {
            work();
            Ok(())
        };
        let account = engine.run("stray", &[(), ()], &Unobserved, unit, |(), ()| Ok(())).expect("done");
        println!("{account:?}");
        account.stray_share()
    };
    let own = stray(|| std::thread::spawn(|| spin(20.0 * QUARTER)).join().expect("done"));
    let none = stray(|| spin(20.0 * QUARTER));
    assert!(own > 0.8 && none < 0.1, "{own} of a thread of its own, {none} without");
}

/// CPU seconds of an arrival of [`Arriving`].
const ARRIVAL: f64 = 2e-5;

/// How often [`Arriving`] came to a receiver, and chose there.
static ARRIVED: AtomicU64 = AtomicU64::new(0);
static SAMPLED: AtomicU64 = AtomicU64::new(0);

/// The first light, and a count of what it was asked.
struct Arriving;

impl Strategy for Arriving {
    const INFO: Info =
        Info { name: "arriving", summary: "counts what it is asked", source: "this test", claim: Claim::Unbiased };
    type Sampler = Self;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, _context: BuildContext<'_>) -> Result<Self> {
        Ok(Self)
    }
}

impl LightSampler for Arriving {
    type Scratch = ();

    fn arrive<T: Tally>(&self, _at: &Receiver, (): &mut (), _tally: &mut T) {
        ARRIVED.fetch_add(1, Ordering::Relaxed);
        spin(ARRIVAL);
    }

    fn sample<T: Tally>(&self, _at: &Receiver, _draws: &mut Draws, (): &mut (), out: &mut Picks<'_, T>) {
        SAMPLED.fetch_add(1, Ordering::Relaxed);
        out.push(0, 1.0);
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

#[test]
fn a_block_pays_for_arrival_once() {
    let Some(_alone) = to_itself() else { return };
    let stage = stage(sixteen());
    let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
    let strategy = Registry::empty().with::<Arriving>().parse("arriving").expect("a strategy");
    let receivers = stage.receivers().len() as u64;
    for passes in [4, 16] {
        let before = [&ARRIVED, &SAMPLED].map(|count| count.load(Ordering::Relaxed));
        let key = RunKey { seed: 1, run: 0 };
        let block = Block { stage: &stage, receivers: stage.receivers(), strategy: &strategy, key, passes };
        engine.alone(|meter| block.run(meter).map(drop)).expect("a pool").expect("an image");
        let [arrived, sampled] = [&ARRIVED, &SAMPLED].map(|count| count.load(Ordering::Relaxed));
        // At the first receiver twice: its first pass stands alone, and says how many calls are made together.
        assert_eq!((arrived - before[0], sampled - before[1]), (receivers + 1, receivers * u64::from(passes)));
    }
}

#[test]
fn where_receivers_move_every_pass_pays_for_its_own_arrivals() {
    let Some(_alone) = to_itself() else { return };
    let strategy = Registry::empty().with::<Arriving>().parse("arriving").expect("a strategy");
    let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
    for receivers in [Receivers::Spread, Receivers::Bounce] {
        let scene = Scene::new(sixteen()).expect("a scene");
        let stage = Stage::visiting(scene, LeaveOut::Yes, Offset::SCALED, receivers);
        for passes in [1, 3] {
            let visited = |pass| stage.receivers().iter().filter(|at| stage.visited(at, pass).is_some()).count() as u64;
            let visits: u64 = (0..passes).map(visited).sum();
            let before = [&ARRIVED, &SAMPLED].map(|count| count.load(Ordering::Relaxed));
            let key = RunKey { seed: 1, run: 0 };
            let block = Block { stage: &stage, receivers: stage.receivers(), strategy: &strategy, key, passes };
            let done = engine.alone(|meter| block.run(meter)).expect("a pool").expect("an image");
            let [arrived, sampled] = [&ARRIVED, &SAMPLED].map(|count| count.load(Ordering::Relaxed));
            assert_eq!((arrived - before[0], sampled - before[1]), (visits, visits), "{} {passes}", receivers.name());
            // Finding the receivers is charged to nobody.
            let share = done.sampling.cpu / (visits as f64 * ARRIVAL);
            println!("{}: {passes} passes are charged {share:.3} of their arrivals", receivers.name());
            assert!((0.9..=1.3).contains(&share), "{}: {share:.3} of {passes} passes", receivers.name());
        }
    }
}
