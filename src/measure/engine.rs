//! What does somebody pay who asks for so many passes at once?
//!
//! The only place that reads a clock for a strategy. Work comes as units, one (scene, strategy, run, budget) each; they are
//! done in seeded random order, so that no strategy meets the machine at its slowest throughout. Each worker owns a pool
//! of one thread, and a unit runs in it: whatever a strategy starts there and waits for (`rayon::scope`, `join`, a parallel
//! iterator, `rayon::spawn` awaited by `yield_now`) runs on that thread and is charged to it by the thread's CPU clock.
//!
//! Threads of a strategy's own, and work left running behind a call, are on nobody's clock. They break the contract, and the
//! process's clock finds them: [`Meter::audit`] for a unit that runs alone, [`Engine::run`] for all units together.
//!
//! A call that blocks until a job of the pool is done (a channel's `recv` after `rayon::spawn`) waits for ever, as it does in
//! any pool of one thread.

#[cfg(any(test, feature = "bench"))]
use super::clock::Cpu;
use super::clock::{Clock, Spent};
use super::observer::Observer;
use crate::base::error::{Error, Result};
use crate::base::random::Stream;
use crate::record::Row;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::{BuildContext, Configured};
use crate::visibility::stage::Stage;
use glam::Vec3;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use crate::base::random::RunKey;

/// Does units of work on workers with a clock each.
pub(crate) struct Engine<'a> {
    /// The clock.
    pub clock: &'a dyn Clock,
    /// Units side by side.
    pub workers: usize,
    /// Decides the order.
    pub seed: u64,
}

/// What a unit is timed with.
#[derive(Clone, Copy)]
pub(crate) struct Meter<'a>(&'a dyn Clock);

/// CPU seconds of all units of a call together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Account {
    /// Of the threads that did the units and of the one that took in what they gave.
    pub threads_s: f64,
    /// Of the whole process meanwhile.
    pub process_s: f64,
}

impl Account {
    /// CPU seconds that nobody was charged for, as a share of what the process spent.
    pub(crate) fn stray_share(&self) -> f64 {
        if self.process_s > 0.0 { ((self.process_s - self.threads_s) / self.process_s).max(0.0) } else { 0.0 }
    }
}

impl Meter<'_> {
    /// Does `work` and says what it took on this thread.
    pub(crate) fn time<T>(&self, work: impl FnOnce() -> T) -> (T, Spent) {
        let (cpu, wall) = (self.0.thread_s(), self.0.wall_s());
        let result = work();
        let spent = Spent { cpu: self.0.thread_s() - cpu, wall: self.0.wall_s() - wall };
        (result, spent)
    }

    /// Does `work` and says what this thread took and what the process did: the same, if nothing else is running.
    pub(crate) fn audit<T>(&self, work: impl FnOnce() -> T) -> (T, Account) {
        let (thread, process) = (self.0.thread_s(), self.0.process_s());
        let result = work();
        let account = Account { threads_s: self.0.thread_s() - thread, process_s: self.0.process_s() - process };
        (result, account)
    }
}

impl Engine<'_> {
    /// Does `work` in a pool of one thread, as a unit is done, while nothing else of this engine runs.
    ///
    /// # Errors
    /// No thread to run on.
    pub(crate) fn alone<T: Send>(&self, work: impl FnOnce(Meter<'_>) -> T + Send) -> Result<T> {
        let pool = pool()?;
        Ok(pool.install(|| work(Meter(self.clock))))
    }

    /// Does all `units`, each on one worker alone, and hands what they give to `sink` on this thread as it comes.
    ///
    /// # Errors
    /// The first error, of a unit or of `sink`, or the user's wish to stop: all stops there. No thread to run on.
    pub(crate) fn run<U: Sync, T: Send>(
        &self,
        what: &str,
        units: &[U],
        watch: &dyn Observer,
        work: impl Fn(&U, Meter<'_>) -> Result<T> + Sync,
        mut sink: impl FnMut(&U, T) -> Result<()>,
    ) -> Result<Account> {
        let order = order(units.len(), self.seed);
        let pools = (0..self.workers.clamp(1, units.len().max(1))).map(|_| pool()).collect::<Result<Vec<_>>>()?;
        let next = AtomicUsize::new(0);
        let (send, receive) = mpsc::channel();
        let turn = |send: mpsc::Sender<(usize, Result<T>)>| {
            let begun = self.clock.thread_s();
            while let Some(&unit) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                let found = watch.check().and_then(|()| work(&units[unit], Meter(self.clock)));
                let failed = found.is_err();
                // Nobody listens any more where the other end has failed first.
                if send.send((unit, found)).is_err() || failed {
                    break;
                }
            }
            self.clock.thread_s() - begun
        };
        watch.begin(what, units.len() as u64);
        let (process, own) = (self.clock.process_s(), self.clock.thread_s());
        let (outcome, workers_s) = std::thread::scope(|scope| {
            let workers: Vec<_> = pools
                .iter()
                .map(|pool| {
                    let (send, turn) = (send.clone(), &turn);
                    scope.spawn(move || pool.install(|| turn(send)))
                })
                .collect();
            drop(send);
            let mut outcome = Ok(());
            for (unit, found) in receive {
                if outcome.is_ok() {
                    outcome = found.and_then(|found| sink(&units[unit], found));
                    watch.advance(1);
                }
                if outcome.is_err() {
                    next.store(units.len(), Ordering::Relaxed);
                }
            }
            let join = |worker: std::thread::ScopedJoinHandle<'_, f64>| {
                worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            (outcome, workers.into_iter().map(join).sum::<f64>())
        });
        watch.end();
        outcome?;
        let threads_s = workers_s + self.clock.thread_s() - own;
        Ok(Account { threads_s, process_s: self.clock.process_s() - process })
    }
}

/// One budget of one run of one strategy, from nothing.
#[derive(Clone, Copy)]
pub(crate) struct Block<'a> {
    /// The scene made ready.
    pub stage: &'a Stage,
    /// The frame.
    pub receivers: &'a [Receiver],
    /// Who chooses the lights.
    pub strategy: &'a Configured,
    /// Names the random numbers.
    pub key: RunKey,
    /// How many passes.
    pub passes: u32,
}

/// What a block took and gave.
#[derive(Clone, Debug)]
pub(crate) struct Done {
    /// Building the sampler.
    pub setup: Spent,
    /// Arriving at all receivers, and all passes.
    pub sampling: Spent,
    /// Bytes on the heap after building.
    pub heap_bytes: u64,
    /// Mean radiance of each receiver of the frame, in cd/m^2.
    pub image: Vec<Vec3>,
}

impl Block<'_> {
    /// Builds the strategy and does all passes in one block.
    ///
    /// # Errors
    /// A strategy that cannot serve the scene.
    pub(crate) fn run(&self, meter: Meter<'_>) -> Result<Done> {
        let Self { stage, receivers, strategy, key, passes } = *self;
        let context = BuildContext { stage, seed: build_seed(key) };
        let (sampler, setup) = meter.time(|| strategy.build(context));
        let sampler = sampler?;
        let plan = Plan { stage, receivers, sampler: sampler.as_ref(), key };
        let (image, sampling) = sample(&plan, passes, meter);
        Ok(Done { setup, sampling, heap_bytes: sampler.heap_bytes() as u64, image })
    }
}

/// Does all passes of a sampler that is there already in one block; the image of the plan's receivers, and what arriving
/// and sampling took. Where receivers move, finding those of a pass is on nobody's clock.
pub(crate) fn sample(plan: &Plan<'_>, passes: u32, meter: Meter<'_>) -> (Vec<Vec3>, Spent) {
    let mut film = Film::new(plan.receivers.len());
    let spent = plan.visits(passes, &mut film).fold(Spent::default(), |spent, visit| {
        let ((), more) = meter.time(|| plan.run_visit(&visit, &mut film));
        Spent { cpu: spent.cpu + more.cpu, wall: spent.wall + more.wall }
    });
    (film.image(), spent)
}

impl Done {
    /// What it took, in a row without errors yet.
    pub(crate) fn row(&self, scene: &str, strategy: &str, run: u32, passes: u32) -> Row {
        Row {
            setup_cpu_s: self.setup.cpu,
            cpu_s: self.sampling.cpu,
            wall_s: self.sampling.wall,
            heap_bytes: self.heap_bytes,
            ..Row::blank(scene.to_owned(), strategy.to_owned(), run, passes)
        }
    }
}

/// CPU seconds of a part of so many blocks, each from nothing, alone on one thread.
///
/// # Errors
/// A strategy that cannot serve the scene; no thread to run on.
#[cfg(any(test, feature = "bench"))]
pub(crate) fn part_s(block: Block<'_>, times: u64, part: fn(&Done) -> f64) -> Result<f64> {
    let all = |meter: Meter<'_>| (0..times).map(|_| block.run(meter).map(|done| part(&done))).sum();
    Engine { clock: &Cpu::new(), workers: 1, seed: 0 }.alone(all)?
}

/// The seed that a run's sampler is built with.
pub(crate) fn build_seed(key: RunKey) -> u64 {
    key.stream(u32::MAX, 0).bits()
}

/// The numbers below `count` in a seeded random order (Fisher and Yates).
fn order(count: usize, seed: u64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"in order")]);
    for i in (1..count).rev() {
        order.swap(i, rng.below(i + 1));
    }
    order
}

/// A pool of one thread: whatever is started in it runs on the thread whose clock is read.
fn pool() -> Result<ThreadPool> {
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    pool.map_err(|e| Error::Invalid(format!("no thread could be started: {e}")))
}
