//! Quantities for criterion other than wall time.

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{BenchmarkGroup, Criterion, SamplingMode, Throughput};
use std::time::Duration;

/// A quantity that a benchmark works out itself, by `iter_custom`; the formatter gives it its unit.
///
/// Criterion calls every quantity `time` in its output; the unit says what it is.
pub(super) struct Reported(&'static dyn ValueFormatter);

/// Thread CPU time: what else runs on the machine counts for less than on the wall's clock.
pub(super) const CPU_TIME: Reported = Reported(&Nanoseconds);
/// Mean squared error over the squared truth.
pub(super) const RELATIVE_ERROR: Reported = Reported(&Plain("relMSE"));
/// One time over another.
pub(super) const RATIO: Reported = Reported(&Plain("times"));

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
pub(super) fn criterion(quantity: Reported) -> Criterion<Reported> {
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
pub(super) fn flat<'a>(criterion: &'a mut Criterion<Reported>, name: &str) -> BenchmarkGroup<'a, Reported> {
    let mut group = criterion.benchmark_group(name);
    group.sampling_mode(SamplingMode::Flat);
    group
}
