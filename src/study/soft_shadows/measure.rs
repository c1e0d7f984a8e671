//! How far off are samplers, one beside the other, and what does a sample of each take?
//!
//! Every contender looks at each receiver alone, so that receivers from all over a frame stand for it.

use crate::base::error::{Error, Result};
use crate::base::interval::Tail;
use crate::base::random::RunKey;
use crate::measure::engine::sample;
use crate::measure::errors::{Errors, Truth};
use crate::measure::figure::Figure;
use crate::record::Interval;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::AnySampler;
use crate::study::session::Session;
use crate::visibility::stage::Stage;

/// Receivers that contenders are measured at.
pub(super) const PIXELS: usize = 512;

/// A sampler in a scene, and how many passes of it make an image.
pub(super) struct Contender<'a> {
    pub(super) stage: &'a Stage,
    pub(super) sampler: &'a dyn AnySampler,
    pub(super) passes: u32,
}

/// What independent runs of a contender left.
pub(super) struct Measured {
    /// Errors of each run, and CPU seconds of all its passes at a receiver.
    runs: Vec<(Errors, f64)>,
    /// The means of the latter.
    pub(super) rel_mse: Interval,
    pub(super) cpu_s: Interval,
    /// Shadow rays of all passes at a receiver.
    pub(super) rays: f64,
}

impl Measured {
    fn of(runs: Vec<(Errors, f64)>, rays: f64) -> Self {
        let mean = |value: fn(&(Errors, f64)) -> f64| Figure::mean(runs.iter().map(value).collect()).interval();
        Self { rel_mse: Self::error(&runs, |errors| errors.rel_mse).interval(), cpu_s: mean(|run| run.1), rays, runs }
    }

    /// Mean squared error in (cd/m^2)^2.
    pub(super) fn mse(&self) -> Interval {
        self.mse_figure().interval()
    }

    /// That over another's.
    pub(super) fn mse_over(&self, other: &Self) -> Option<Interval> {
        if std::ptr::eq(self, other) {
            return Some(Interval::certain(1.0));
        }
        self.mse_figure().over(other.mse_figure()).map(|ratio| ratio.interval())
    }

    fn mse_figure(&self) -> Figure {
        Self::error(&self.runs, |errors| errors.mse)
    }

    /// A mean error, with the tail of relMSE in its unit.
    fn error(runs: &[(Errors, f64)], of: fn(&Errors) -> f64) -> Figure {
        let values: Vec<f64> = runs.iter().map(|(errors, _)| of(errors)).collect();
        let scale = values.iter().sum::<f64>() / runs.iter().map(|(errors, _)| errors.rel_mse).sum::<f64>();
        Figure::error(values, Self::tail(runs).times(scale))
    }

    fn tail(runs: &[(Errors, f64)]) -> Tail {
        let (errors, largest): (Vec<f64>, Vec<_>) = runs.iter().map(|(e, _)| (e.rel_mse, e.largest)).unzip();
        Tail::of(&errors, &largest)
    }

    /// relMSE x CPU seconds at a receiver.
    pub(super) fn cost_s(&self) -> Interval {
        let seconds = Figure::mean(self.runs.iter().map(|(_, seconds)| *seconds).collect());
        let parts = vec![Self::error(&self.runs, |errors| errors.rel_mse), seconds];
        Figure::of(parts, |parts| parts[0] * parts[1]).interval()
    }
}

/// Measures contenders at the same receivers in independent runs.
pub(super) fn measure(
    session: &Session<'_>,
    what: &str,
    contenders: &[Contender<'_>],
    receivers: &[Receiver],
    truth: &Truth,
) -> Result<Vec<Measured>> {
    if receivers.is_empty() {
        return Err(Error::Invalid("nothing that the camera sees is lit: there is nothing to measure".into()));
    }
    let plan = |i: usize, run| {
        let key = RunKey { seed: session.options.seed, run };
        Plan { stage: contenders[i].stage, receivers, sampler: contenders[i].sampler, key }
    };
    let units: Vec<(usize, u32)> =
        (0..contenders.len()).flat_map(|i| (0..session.options.repeats).map(move |run| (i, run))).collect();
    let mut runs: Vec<Vec<(u32, (Errors, f64))>> = contenders.iter().map(|_| Vec::new()).collect();
    session.engine().run(
        what,
        &units,
        session.watch,
        |&(i, run), meter| {
            let (image, spent) = sample(&plan(i, run), contenders[i].passes, meter);
            Ok((truth.errors(&image), spent.cpu / receivers.len() as f64))
        },
        |&(i, run), found| {
            runs[i].push((run, found));
            Ok(())
        },
    )?;
    let measured = runs.into_iter().enumerate().map(|(i, mut runs)| {
        runs.sort_by_key(|(run, _)| *run);
        let counts = plan(i, 0).run_counting(contenders[i].passes, &mut Film::new(receivers.len()));
        let rays = counts.shadow_rays as f64 / receivers.len() as f64;
        Measured::of(runs.into_iter().map(|(_, found)| found).collect(), rays)
    });
    Ok(measured.collect())
}
