//! One engine times everything, and plans do not follow the machine.
use crate::promises::alone::Alone;
use crate::promises::common::{sixteen, stage};
use citylights::measure::clock::{Clock, Cpu};
use citylights::measure::compare::{Compared, ComparisonOptions, compare};
use citylights::measure::engine::Engine;
use citylights::measure::image_store::ImageStore;
use citylights::measure::observer::Unobserved;
use citylights::measure::plan::Budget;
use citylights::record::store::RowWriter;
use citylights::record::{Row, SceneRecord};
use citylights::strategy::Registry;
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
        scenes: 1,
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
