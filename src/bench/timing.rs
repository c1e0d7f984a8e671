//! CPU times as the engine takes them, and one beside another.

use super::quantity::Reported;
use crate::base::statistics::Moments;
use crate::measure::clock::Cpu;
use crate::measure::engine::{Block, Done, Engine, Meter, part_s};
use criterion::{Bencher, BenchmarkGroup};
use std::hint::black_box;
use std::ops::RangeInclusive;

/// Does `work` as the engine does a unit: in a pool of one thread, whose clock sees all that is started there.
pub(super) fn alone<T: Send>(work: impl FnOnce(Meter<'_>) -> T + Send) -> T {
    Engine { clock: &Cpu::new(), workers: 1, seed: 0 }.alone(work).unwrap_or_else(|error| panic!("{error}"))
}

/// CPU time of `work`, which does `elements` alike things, for one of them; in ns.
pub(super) fn per_element<T>(bencher: &mut Bencher<'_, Reported>, elements: usize, mut work: impl FnMut() -> T + Send) {
    bencher.iter_custom(|iterations| {
        let all = || (0..iterations).for_each(|_| drop(black_box(work())));
        alone(|meter| meter.time(all).1.cpu) * 1e9 / elements as f64
    });
}

/// CPU time of a part of a block from nothing, as `compare` takes it, for one of `elements` alike things; in ns.
pub(super) fn part_of(bencher: &mut Bencher<'_, Reported>, block: Block<'_>, elements: usize, part: fn(&Done) -> f64) {
    bencher.iter_custom(|iterations| {
        let name = block.strategy.name();
        let spent = part_s(block, iterations, part).unwrap_or_else(|error| panic!("{name}: {error}"));
        spent * 1e9 / elements as f64
    });
}

/// CPU time of one thing over that of another, taken in turns within one run.
pub(super) struct Duel<A, B> {
    ours: A,
    other: B,
    samples: Vec<f64>,
}

impl<T, U, A: FnMut() -> T + Send, B: FnMut() -> U + Send> Duel<A, B> {
    /// Two ways to do the same work.
    pub(super) fn new(ours: A, other: B) -> Self {
        Self { ours, other, samples: Vec::new() }
    }

    /// Runs it as a benchmark, two turns an iteration. A sample is one sum of CPU times over the other, from turns
    /// whose order alternates: what slows the machine down slows both.
    pub(super) fn bench(&mut self, group: &mut BenchmarkGroup<'_, Reported>, name: &str) {
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
    pub(super) fn judge(&self, name: &str, wanted: &RangeInclusive<f64>) {
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
