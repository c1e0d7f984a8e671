//! How good is each strategy at one budget? Independent runs of all of them, interleaved, held in memory.
//!
//! What an experiment needs of a comparison: no ladder of budgets, no rows on disk. Each run has a thread to itself,
//! and a strategy that builds on several threads builds on that one: its clock then sees all of the set-up.

use super::clock::timed;
use super::errors::Truth;
use super::observer::Observer;
use super::once::Once;
use super::plan::{self, Budget, Pilot};
use super::summary::{blank, counts, summarise};
use super::target::Target;
use crate::base::error::{Error, Result};
use crate::base::random::{RunKey, Stream};
use crate::record::{Row, Summary};
use crate::strategy::erased::Frame;
use crate::strategy::registry::Configured;
use crate::strategy::{BuildContext, Role};
use glam::Vec3;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How strategies are tried.
pub struct Trials<'a> {
    /// The receivers.
    pub target: &'a Target<'a>,
    /// What their radiance is.
    pub truth: &'a Truth,
    /// What each strategy may spend in a run.
    pub budget: Budget,
    /// Independent runs.
    pub runs: u32,
    /// The user's seed.
    pub seed: u64,
    /// Runs side by side.
    pub threads: usize,
}

/// What one run left.
struct Done {
    strategy: usize,
    row: Row,
    image: Vec<Vec3>,
}

impl Trials<'_> {
    /// A summary of each strategy at the largest budget that it can afford; one that can afford no pass is skipped.
    pub fn run(&self, strategies: &[&Configured], watch: &dyn Observer) -> Result<Vec<Summary>> {
        let rough = self.truth.thinned(plan::RECEIVERS);
        watch.begin("pilots", strategies.len() as u64);
        let mut pilots = Vec::new();
        for strategy in strategies {
            watch.check()?;
            pilots.push(Pilot::run(self.target, &rough, strategy, self.seed));
            watch.advance(1);
        }
        watch.end();
        let passes = |(strategy, pilot): (&&Configured, &Result<Pilot>)| {
            // Nobody looks at the oracle's time: it may take longer, but not for ever.
            let patience = if strategy.info().role == Role::Oracle { 4.0 } else { 1.0 };
            pilot.as_ref().ok()?.at_once(Budget { seconds: patience * self.budget.seconds, ..self.budget })
        };
        let budgets: Vec<Option<u32>> = strategies.iter().zip(&pilots).map(passes).collect();
        let mut units: Vec<(usize, u32, u32)> = (0..self.runs)
            .flat_map(|run| budgets.iter().enumerate().filter_map(move |(i, passes)| Some((i, run, (*passes)?))))
            .collect();
        shuffle(&mut units, self.seed);
        let mut done = self.units(strategies, &units, watch)?;
        done.sort_by_key(|done| (done.strategy, done.row.run));
        let summary = |(i, strategy): (usize, &&Configured)| match &pilots[i] {
            Err(error) => Summary { error: Some(error.to_string()), ..blank(strategy) },
            Ok(pilot) if budgets[i].is_none() => {
                let skipped = format!("skipped: about {:.2} s a pass", pilot.first_pass_s());
                Summary { skipped: Some(skipped), ..blank(strategy) }
            }
            Ok(pilot) => {
                let mine = || done.iter().filter(|done| done.strategy == i);
                let rows: Vec<&Row> = mine().map(|done| &done.row).collect();
                let images: Vec<&[Vec3]> = mine().map(|done| done.image.as_slice()).collect();
                let blank = Summary { counts: counts(pilot.counts), ..blank(strategy) };
                summarise(blank, self.truth, &rows, &images)
            }
        };
        Ok(strategies.iter().enumerate().map(summary).collect())
    }

    /// CPU seconds of the state that a strategy draws anew for each pass, whatever the number of receivers; 0 of one
    /// that has none.
    ///
    /// A run over few receivers pays for it as often as one over a whole frame.
    pub fn pass_state_s(&self, strategy: &Configured) -> Result<f64> {
        let sampler = strategy.build(BuildContext { stage: self.target.stage, seed: self.seed })?;
        if sampler.most_passes() > 1 {
            return Ok(0.0);
        }
        let frame =
            Frame::new(&self.target.frame[..self.target.frame.len().min(1)], RunKey { seed: self.seed, run: 0 });
        let mut times: Vec<f64> = alone()?
            .install(|| (0..STATES).map(|pass| timed(|| drop(sampler.begin(frame, pass..pass + 1))).1.cpu).collect());
        times.sort_by(f64::total_cmp);
        Ok(times[times.len() / 2])
    }

    /// All runs, on as many threads as are allowed.
    fn units(
        &self,
        strategies: &[&Configured],
        units: &[(usize, u32, u32)],
        watch: &dyn Observer,
    ) -> Result<Vec<Done>> {
        let run = |unit: usize| {
            let (strategy, run, passes) = units[unit];
            let key = RunKey { seed: self.seed, run };
            let once = Once { target: self.target, truth: self.truth, strategy: strategies[strategy], key };
            let mut rows = Vec::new();
            let image = once.through(&[passes], |row| {
                rows.push(row);
                Ok(())
            })?;
            Ok(rows.pop().zip(image).map(|(row, image)| Done { strategy, row, image }))
        };
        Ok(side_by_side(units.len(), self.threads, watch, run)?.into_iter().flatten().collect())
    }
}

/// Does `units` pieces of work on up to `threads` threads, each piece alone on one with its clock to itself; gives what they
/// gave, in order.
pub fn side_by_side<T: Send>(
    units: usize,
    threads: usize,
    watch: &dyn Observer,
    work: impl Fn(usize) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    watch.begin("runs", units as u64);
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let turn = || -> Result<()> {
        loop {
            let unit = next.fetch_add(1, Ordering::Relaxed);
            if unit >= units {
                return Ok(());
            }
            watch.check()?;
            let found = work(unit)?;
            done.lock().map_err(|_| Error::Interrupted)?.push((unit, found));
            watch.advance(1);
        }
    };
    let pools = (0..threads.clamp(1, units.max(1))).map(|_| alone()).collect::<Result<Vec<_>>>()?;
    std::thread::scope(|scope| {
        let workers: Vec<_> = pools.iter().map(|pool| scope.spawn(|| pool.install(turn))).collect();
        let join = |worker: std::thread::ScopedJoinHandle<'_, Result<()>>| {
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        workers.into_iter().try_for_each(join)
    })?;
    watch.end();
    let mut done = done.into_inner().map_err(|_| Error::Interrupted)?;
    done.sort_by_key(|(unit, _)| *unit);
    Ok(done.into_iter().map(|(_, found)| found).collect())
}

/// Passes whose state is timed: the middle of them counts.
const STATES: u32 = 9;

/// A pool of one thread: whatever is built in parallel is then built on the thread whose clock is read.
fn alone() -> Result<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.map_err(|e| Error::Invalid(format!("no thread could be started: {e}")))
}

/// Puts runs in a seeded random order (Fisher and Yates), so that no strategy runs while the machine is at its slowest
/// throughout.
pub(super) fn shuffle<T>(units: &mut [T], seed: u64) {
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"in order")]);
    for i in (1..units.len()).rev() {
        units.swap(i, rng.below(i + 1));
    }
}
