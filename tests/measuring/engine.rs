//! One engine times everything, plans do not follow the machine, and whatever a unit starts is on its clock.
#![cfg(feature = "measure")]

use crate::common::alone::Alone;
use crate::common::{sixteen, stage};
use citylights::base::random::RunKey;
use citylights::measure::clock::{Clock, Cpu, Spent};
use citylights::measure::compare::{Compared, ComparisonOptions, compare};
use citylights::measure::engine::{Block, Engine};
use citylights::measure::image_store::ImageStore;
use citylights::measure::observer::Unobserved;
use citylights::measure::plan::Budget;
use citylights::record::store::RowWriter;
use citylights::record::{Row, SceneRecord};
use citylights::strategy::Registry;
use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// A clock on which the n-th reading is as far from the one before as n says, times a factor.
struct Scripted {
    factor: f64,
    readings: [AtomicU64; 3],
    seconds: Mutex<[f64; 3]>,
}

impl Scripted {
    fn new(factor: f64) -> Self {
        Self { factor, readings: Default::default(), seconds: Mutex::default() }
    }

    fn read(&self, which: usize) -> f64 {
        let n = self.readings[which].fetch_add(1, Ordering::SeqCst);
        let mut seconds = self.seconds.lock().expect("nobody panicked");
        seconds[which] += self.factor * 1e-3 * (1.0 + (n % 7) as f64);
        seconds[which]
    }
}

impl Clock for Scripted {
    fn thread_s(&self) -> f64 {
        self.read(0)
    }

    fn process_s(&self) -> f64 {
        // As slow as the thread's: nothing is found to be off the clock.
        self.seconds.lock().expect("nobody panicked")[0]
    }

    fn wall_s(&self) -> f64 {
        self.read(2)
    }
}

fn compared(clock: &dyn Clock, seed: u64, workers: usize) -> (SceneRecord, Vec<Row>) {
    let stage = stage(sixteen());
    let folder = tempfile::tempdir().expect("a folder");
    let strategies =
        Registry::standard().parse_list("all,uniform,power,intensity,light-tree,resampled,influence").expect("a list");
    let engine = Engine { clock, workers, seed };
    let films = ImageStore::of(folder.path(), "engine");
    let options = ComparisonOptions {
        typed: "made.toml",
        strategies: &strategies,
        budget: Budget { usual_passes: 16, most_passes: 64, work_s: 0.05 },
        repeats: 4,
        seed,
        engine: &engine,
        reference_work_s: 10.0,
        cache: folder.path(),
        films: &films,
    };
    let mut writer = RowWriter::create(folder.path()).expect("begun");
    let Compared { scene, mut rows, .. } =
        compare(&stage, "made", &options, &[], &mut writer, &Unobserved).expect("compared");
    rows.sort_by(|a, b| (&a.strategy, a.passes, a.run).cmp(&(&b.strategy, b.passes, b.run)));
    (scene, rows)
}

/// A row without what a clock says.
fn timeless(row: &Row) -> Row {
    Row { setup_cpu_s: 0.0, cpu_s: 0.0, wall_s: 0.0, ..row.clone() }
}

#[test]
fn a_slower_machine_gives_the_same_rows_in_the_same_order() {
    let (scene, rows) = compared(&Scripted::new(1.0), 1, 1);
    assert!(rows.len() > 50 && scene.summaries.iter().all(|s| s.error.is_none()), "{:?}", scene.summaries);
    for factor in [1.14, 3.0] {
        let (slower, slow_rows) = compared(&Scripted::new(factor), 1, 1);
        assert_eq!(
            rows.iter().map(timeless).collect::<Vec<_>>(),
            slow_rows.iter().map(timeless).collect::<Vec<_>>(),
            "rows follow the clock"
        );
        for (row, slow) in rows.iter().zip(&slow_rows) {
            for (time, slow) in [(row.setup_cpu_s, slow.setup_cpu_s), (row.cpu_s, slow.cpu_s)] {
                assert!((slow / time / factor - 1.0).abs() < 1e-6, "{time} became {slow} at {factor}");
            }
        }
        let ranks = |scene: &SceneRecord| {
            scene.summaries.iter().map(|s| (s.strategy.clone(), s.rank, s.letters.clone())).collect::<Vec<_>>()
        };
        assert_eq!(ranks(&scene), ranks(&slower));
    }
}

#[test]
fn every_machine_runs_the_same_budgets() {
    let budgets = |rows: &[Row]| rows.iter().map(timeless).collect::<Vec<_>>();
    let (_, one) = compared(&Alone::new(), 3, 1);
    let (_, two) = compared(&Alone::new(), 3, 2);
    assert_eq!(budgets(&one), budgets(&two));
    let passes: Vec<u32> =
        one.iter().filter(|row| row.strategy == "uniform" && row.run == 0).map(|r| r.passes).collect();
    // Four times what is usual: with fewer a bias of 5 % could go unseen.
    assert_eq!(passes, [1, 4, 16, 64]);
}

#[test]
fn units_come_in_an_order_that_the_seed_decides() {
    let order = |seed| {
        let engine = Engine { clock: &Cpu::new(), workers: 1, seed };
        let units: Vec<usize> = (0..40).collect();
        let mut seen = Vec::new();
        let sink = |_: &usize, found: usize| {
            seen.push(found);
            Ok(())
        };
        engine.run("units", &units, &Unobserved, |&unit, _| Ok(unit), sink).expect("done");
        seen
    };
    let (first, other) = (order(1), order(2));
    assert_eq!(first, order(1));
    assert_ne!(first, other);
    assert_ne!(first, (0..40).collect::<Vec<_>>(), "one strategy after the other");
    let mut sorted = other;
    sorted.sort_unstable();
    assert_eq!(sorted, (0..40).collect::<Vec<_>>());
}

/// Keeps a processor busy; gives something that cannot be left out.
fn spin(rounds: u64) -> u64 {
    (0..rounds).fold(1, |x: u64, i| std::hint::black_box(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(i)))
}

fn work(rounds: u64) {
    std::hint::black_box(spin(rounds));
}

const ROUNDS: u64 = 2_000_000;

#[test]
fn what_a_unit_starts_and_waits_for_is_on_its_clock() {
    let engine = Engine { clock: &Cpu::new(), workers: 2, seed: 1 };
    let plain = || (0..4).for_each(|_| work(ROUNDS));
    let scope = || rayon::scope(|scope| (0..4).for_each(|_| scope.spawn(|_| work(ROUNDS))));
    let join = || {
        rayon::join(|| work(2 * ROUNDS), || work(2 * ROUNDS));
    };
    let iterator = || (0..4).into_par_iter().for_each(|_| work(ROUNDS));
    let spawn = || {
        static DONE: AtomicU64 = AtomicU64::new(0);
        DONE.store(0, Ordering::SeqCst);
        for _ in 0..4 {
            rayon::spawn(|| {
                work(ROUNDS);
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
    let known = median(&times[0]);
    for ((name, _), times) in ways.iter().zip(&times) {
        let share = median(times) / known;
        assert!((0.9..=1.1).contains(&share), "{name} is charged {share:.3} of its work");
    }
}

#[test]
fn a_thread_of_its_own_is_found_by_the_clock_of_the_process() {
    let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
    let stray = || {
        let thread = std::thread::spawn(|| work(20 * ROUNDS));
        thread.join().expect("done");
    };
    let account = engine
        .run(
            "stray",
            &[(), ()],
            &Unobserved,
            |(), _| {
                stray();
                Ok(())
            },
            |(), ()| Ok(()),
        )
        .expect("done");
    assert!(account.stray_share() > 0.8, "{account:?}");
    let account = engine
        .run(
            "own",
            &[(), ()],
            &Unobserved,
            |(), _| {
                work(20 * ROUNDS);
                Ok(())
            },
            |(), ()| Ok(()),
        )
        .expect("done");
    // Other tests of this process run beside this one.
    println!("without: {account:?}");
}

#[test]
fn a_block_pays_for_arrival_once() {
    let stage = stage(sixteen());
    let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
    let strategy = Registry::standard().parse("intensity").expect("a strategy");
    let key = RunKey { seed: 1, run: 0 };
    let image = |passes| {
        let block = Block { stage: &stage, receivers: stage.receivers(), strategy: &strategy, key, passes };
        engine.alone(|meter| block.run(meter)).expect("a pool").expect("an image").image
    };
    let (few, many) = (image(4), image(16));
    assert_ne!(few, many);
    assert_eq!(few, image(4));
}
