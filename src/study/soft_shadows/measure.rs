//! How far off are samplers, one beside the other, and what does a sample of each take?

use super::super::Session;
use crate::base::error::{Error, Result};
use crate::base::random::RunKey;
use crate::base::statistics::Moments;
use crate::measure::clock::timed;
use crate::measure::errors::Truth;
use crate::record::Interval;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::erased::AnySampler;
use crate::visibility::stage::Stage;
use rayon::prelude::*;

/// A sampler in a scene, and how many passes of it make an image.
pub(super) struct Contender<'a> {
    pub(super) stage: &'a Stage,
    pub(super) sampler: &'a dyn AnySampler,
    pub(super) passes: u32,
}

/// What independent runs of a contender left.
pub(super) struct Measured {
    /// Mean squared error in (cd/m^2)^2.
    pub(super) mse: Interval,
    pub(super) rel_mse: Interval,
    /// CPU seconds of all passes at a receiver: the median over runs.
    pub(super) cpu_s: f64,
    /// Shadow rays of all passes at a receiver.
    pub(super) rays: f64,
}

const CONFIDENCE: f64 = 0.95;

/// Measures contenders at the same receivers in independent runs, all of them in each run, each run on a thread of its
/// own.
pub(super) fn measure(
    session: &Session<'_>,
    what: &str,
    contenders: &[Contender<'_>],
    receivers: &[Receiver],
    truth: &Truth,
) -> Result<Vec<Measured>> {
    let watch = session.watch;
    watch.begin(what, u64::from(session.options.repeats));
    let once = |run: u32| -> Result<Vec<(f64, f64, f64)>> {
        let key = RunKey { seed: session.options.seed, run };
        // Each run begins with another contender: none always runs first, into cold caches.
        let mut found = vec![(0.0, 0.0, 0.0); contenders.len()];
        for i in (0..contenders.len()).map(|i| (i + run as usize) % contenders.len()) {
            let contender = &contenders[i];
            watch.check()?;
            let plan = Plan { stage: contender.stage, receivers, sampler: contender.sampler, key };
            let mut film = Film::new(receivers.len());
            let ((), spent) = timed(|| plan.run(contender.passes, &mut film));
            let errors = truth.errors(&film.image());
            found[i] = (errors.mse, errors.rel_mse, spent.cpu);
        }
        watch.advance(1);
        Ok(found)
    };
    let runs: Vec<Vec<(f64, f64, f64)>> =
        (0..session.options.repeats).into_par_iter().map(once).collect::<Result<_>>()?;
    watch.end();
    let interval = |values: Vec<f64>| {
        let moments = Moments::of(values);
        Interval { mean: moments.mean, half_width: moments.half_width(CONFIDENCE) }
    };
    let summary = |(i, contender): (usize, &Contender<'_>)| {
        let of = |pick: fn(&(f64, f64, f64)) -> f64| runs.iter().map(|run| pick(&run[i])).collect::<Vec<f64>>();
        let mut times = of(|run| run.2);
        times.sort_by(f64::total_cmp);
        let plan = Plan {
            stage: contender.stage,
            receivers,
            sampler: contender.sampler,
            key: RunKey { seed: session.options.seed, run: 0 },
        };
        let counts = plan.run_counting(contender.passes, &mut Film::new(receivers.len()));
        Measured {
            mse: interval(of(|run| run.0)),
            rel_mse: interval(of(|run| run.1)),
            cpu_s: times.get(times.len() / 2).copied().unwrap_or(f64::NAN) / receivers.len() as f64,
            rays: counts.shadow_rays as f64 / receivers.len() as f64,
        }
    };
    if receivers.is_empty() {
        return Err(Error::Invalid("nothing that the camera sees is lit: there is nothing to measure".into()));
    }
    Ok(contenders.iter().enumerate().map(summary).collect())
}
