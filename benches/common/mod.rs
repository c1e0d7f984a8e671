//! What the benches share: scenes, and quantities for criterion other than wall time.
#![allow(dead_code, reason = "each bench is a program of its own and uses a part of this")]

use citylights::base::statistics::Moments;
use citylights::measure::clock::Cpu;
use citylights::measure::engine::{Block, Done, Engine, Meter};
use citylights::scene::recipe::{self, Overrides};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Bencher, BenchmarkGroup, Criterion, SamplingMode, Throughput};
use std::hint::black_box;
use std::ops::RangeInclusive;
use std::path::Path;
use std::time::Duration;

/// A scene of `scenes/`, made ready as the program does it.
pub(crate) fn stage(name: &str) -> Stage {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml");
    let scene = recipe::load(&file, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    Stage::new(scene, LeaveOut::Yes, Offset::SCALED)
}

/// A quantity that a benchmark works out itself, by `iter_custom`; the formatter gives it its unit.
///
/// Criterion calls every quantity `time` in its output; the unit says what it is.
pub(crate) struct Reported(&'static dyn ValueFormatter);

/// Thread CPU time: what else runs on the machine counts for less than on the wall's clock.
pub(crate) const CPU_TIME: Reported = Reported(&Nanoseconds);
/// Mean squared error over the squared truth.
pub(crate) const RELATIVE_ERROR: Reported = Reported(&Plain("relMSE"));
/// One time over another.
pub(crate) const RATIO: Reported = Reported(&Plain("times"));

impl Measurement for Reported {
    type Intermediate = ();
    type Value = f64;

    fn start(&self) {}

    fn end(&self, (): ()) -> f64 {
        panic!("this quantity is not a clock: use `iter_custom`")
    }

    fn add(&self, a: &f64, b: &f64) -> f64 {
        a + b
    }

    fn zero(&self) -> f64 {
        0.0
    }

    fn to_f64(&self, value: &f64) -> f64 {
        *value
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        self.0
    }
}

/// Formats nanoseconds as criterion does.
struct Nanoseconds;

impl ValueFormatter for Nanoseconds {
    fn scale_values(&self, typical: f64, values: &mut [f64]) -> &'static str {
        WallTime.formatter().scale_values(typical, values)
    }

    fn scale_throughputs(&self, typical: f64, throughput: &Throughput, values: &mut [f64]) -> &'static str {
        WallTime.formatter().scale_throughputs(typical, throughput, values)
    }

    fn scale_for_machines(&self, values: &mut [f64]) -> &'static str {
        WallTime.formatter().scale_for_machines(values)
    }
}

/// Formats a number without a scale; the word stands where units do.
struct Plain(&'static str);

impl ValueFormatter for Plain {
    fn scale_values(&self, _: f64, _: &mut [f64]) -> &'static str {
        self.0
    }

    fn scale_throughputs(&self, _: f64, _: &Throughput, _: &mut [f64]) -> &'static str {
        self.0
    }

    fn scale_for_machines(&self, _: &mut [f64]) -> &'static str {
        self.0
    }
}

/// Criterion for a quantity. No plots: gnuplot or not, they take longer than these benches.
pub(crate) fn criterion(quantity: Reported) -> Criterion<Reported> {
    Criterion::default()
        .with_measurement(quantity)
        .without_plots()
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(400))
        .sample_size(20)
        // Of the bootstrap; criterion's 100,000 take longer than the measurement.
        .nresamples(20_000)
        .configure_from_args()
}

/// A group whose samples all have the same number of iterations.
pub(crate) fn flat<'a>(criterion: &'a mut Criterion<Reported>, name: &str) -> BenchmarkGroup<'a, Reported> {
    let mut group = criterion.benchmark_group(name);
    group.sampling_mode(SamplingMode::Flat);
    group
}

/// Does `work` as the engine does a unit: in a pool of one thread, whose clock sees all that is started there.
pub(crate) fn alone<T: Send>(work: impl FnOnce(Meter<'_>) -> T + Send) -> T {
    Engine { clock: &Cpu::new(), workers: 1, seed: 0 }.alone(work).unwrap_or_else(|error| panic!("{error}"))
}

/// CPU time of `work`, which does `elements` alike things, for one of them; in ns.
pub(crate) fn per_element<T>(bencher: &mut Bencher<'_, Reported>, elements: usize, mut work: impl FnMut() -> T + Send) {
    bencher.iter_custom(|iterations| {
        let all = || (0..iterations).for_each(|_| drop(black_box(work())));
        alone(|meter| meter.time(all).1.cpu) * 1e9 / elements as f64
    });
}

/// CPU time of a part of a block from nothing, as `compare` takes it, for one of `elements` alike things; in ns.
pub(crate) fn part_of(bencher: &mut Bencher<'_, Reported>, block: Block<'_>, elements: usize, part: fn(&Done) -> f64) {
    bencher.iter_custom(|iterations| part_s(block, iterations, part) * 1e9 / elements as f64);
}

/// CPU seconds of a part of so many blocks, each from nothing.
pub(crate) fn part_s(block: Block<'_>, iterations: u64, part: fn(&Done) -> f64) -> f64 {
    let one =
        |meter: Meter<'_>| part(&block.run(meter).unwrap_or_else(|error| panic!("{}: {error}", block.strategy.name())));
    alone(|meter| (0..iterations).map(|_| one(meter)).sum())
}

/// CPU time of one thing over that of another, taken in turns within one run.
pub(crate) struct Duel<A, B> {
    ours: A,
    other: B,
    samples: Vec<f64>,
}

impl<T, U, A: FnMut() -> T + Send, B: FnMut() -> U + Send> Duel<A, B> {
    /// Two ways to do the same work.
    pub(crate) fn new(ours: A, other: B) -> Self {
        Self { ours, other, samples: Vec::new() }
    }

    /// Runs it as a benchmark, two turns an iteration. A sample is one sum of CPU times over the other, from turns
    /// whose order alternates: what slows the machine down slows both.
    pub(crate) fn bench(&mut self, group: &mut BenchmarkGroup<'_, Reported>, name: &str) {
        group.bench_function(name, |bencher| {
            bencher.iter_custom(|iterations| {
                let ratio = self.sample(2 * iterations);
                self.samples.push(ratio);
                // Criterion divides by the iterations; a ratio does not add up over them.
                ratio * iterations as f64
            });
        });
    }

    /// Says on stderr whether the mean ratio lies within `wanted`.
    pub(crate) fn judge(&self, name: &str, wanted: &RangeInclusive<f64>) {
        // The first sample warms up. One alone is `cargo bench -- --test`, none a benchmark filtered out.
        let Some((_, samples)) = self.samples.split_first().filter(|(_, rest)| rest.len() > 1) else { return };
        let moments = Moments::of(samples.iter().copied());
        let verdict = if wanted.contains(&moments.mean) { "kept" } else { "MISSED" };
        let (low, high) = (wanted.start(), wanted.end());
        let half_width = moments.half_width(0.95);
        eprintln!("{name}: {:.4} ± {half_width:.4} (95 %); wanted {low} to {high}: {verdict}\n", moments.mean);
    }

    fn sample(&mut self, turns: u64) -> f64 {
        alone(|meter| {
            let (mut ours, mut other) = (0.0, 0.0);
            for turn in 0..turns {
                if turn % 2 == 0 {
                    ours += cpu(meter, &mut self.ours);
                    other += cpu(meter, &mut self.other);
                } else {
                    other += cpu(meter, &mut self.other);
                    ours += cpu(meter, &mut self.ours);
                }
            }
            ours / other
        })
    }
}

/// CPU seconds of `work`.
fn cpu<T>(meter: Meter<'_>, work: &mut impl FnMut() -> T) -> f64 {
    meter.time(|| black_box(work())).1.cpu
}
