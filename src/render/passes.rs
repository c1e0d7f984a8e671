//! Running passes over all receivers: on one thread for a clock, on all of them for a picture.

use super::film::Film;
use super::kernel::{Kernel, kernel};
use super::visit::Visit;
use crate::base::counts::Counts;
use crate::base::random::RunKey;
use crate::scene::light::Kind;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, Block, Frame, PickBuffer, Worker, blocks};
use crate::visibility::stage::Stage;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// At most this many (receiver, pass) pairs are sampled at once: where lists are short and suddenly long, a buffer
/// stays within CALLS times the longest.
const CALLS: usize = 512;

/// What passes are run with.
#[derive(Clone, Copy)]
pub struct Plan<'a> {
    /// The scene made ready.
    pub stage: &'a Stage,
    /// The receivers to sample: all of the stage's, or some. Where the stage's receivers
    /// [move](crate::visibility::visits::Receivers::moves) they stand for their pixels, and the film is of these.
    pub receivers: &'a [Receiver],
    /// Who chooses the lights.
    pub sampler: &'a dyn AnySampler,
    /// Names the random numbers.
    pub key: RunKey,
}

/// At most this many receivers are sampled at once.
const TILE: usize = 64;

/// A call aims at no more picks than this: 256 KiB of them, so that they stay in the second-level cache.
const PICKS: usize = 16_384;

impl<'p> Plan<'p> {
    /// Adds `passes` more passes to `film`, on this thread.
    pub fn run(&self, passes: u32, film: &mut Film) {
        self.visits(passes, film).for_each(|visit| self.run_visit(&visit, film));
    }

    /// As [`run`](Self::run), counting.
    pub fn run_counting(&self, passes: u32, film: &mut Film) -> Counts {
        self.visits(passes, film).fold(Counts::default(), |mut counts, visit| {
            counts += self.one_thread(true, &visit, film);
            counts
        })
    }

    /// As [`run`](Self::run), on all threads of the current pool: the same bytes.
    pub fn run_parallel(&self, passes: u32, film: &mut Film) {
        let kernel = kernel(self.stage.needs(), false);
        for visit in self.visits(passes, film) {
            visit.onto(film, |sums| {
                for passes in blocks(self.sampler, visit.passes.clone()) {
                    let block = self.sampler.begin(self.frame(&visit), passes.clone());
                    visit.receivers.par_chunks(TILE).zip(sums.par_chunks_mut(TILE)).for_each_init(
                        || Tiles::new(&*block, false),
                        |tiles, (receivers, sums)| tiles.run(self, kernel, receivers, &passes, sums),
                    );
                }
            });
        }
    }

    /// The next `passes` passes of a film: all of them at once or, where receivers move, one by one. What a visit finds,
    /// it finds when it is asked for.
    pub(crate) fn visits<'v>(&'v self, passes: u32, film: &mut Film) -> impl Iterator<Item = Visit<'v>> + use<'v, 'p> {
        let first = film.next;
        film.next = first + passes;
        Visit::all(self.stage, self.receivers, first..film.next)
    }

    /// Adds the passes of a visit to `film`, on this thread.
    pub(crate) fn run_visit(&self, visit: &Visit<'_>, film: &mut Film) {
        self.one_thread(false, visit, film);
    }

    fn one_thread(&self, counting: bool, visit: &Visit<'_>, film: &mut Film) -> Counts {
        let kernel = kernel(self.stage.needs(), counting);
        let mut counts = Counts::default();
        visit.onto(film, |sums| {
            for passes in blocks(self.sampler, visit.passes.clone()) {
                let block = self.sampler.begin(self.frame(visit), passes.clone());
                let mut tiles = Tiles::new(&*block, counting);
                tiles.run(self, kernel, &visit.receivers, &passes, sums);
                tiles.counts += tiles.worker.work();
                counts += tiles.counts;
            }
        });
        counts
    }

    fn frame<'v>(&self, visit: &'v Visit<'_>) -> Frame<'v> {
        Frame::new(&visit.receivers, self.key)
    }
}

/// One thread's worker and buffer.
struct Tiles<'a> {
    worker: Box<dyn Worker + 'a>,
    picks: PickBuffer,
    counts: Counts,
    /// Receivers and passes of the next call, from the picks of the last.
    size: (usize, u32),
}

impl<'a> Tiles<'a> {
    fn new(block: &'a dyn Block, counting: bool) -> Self {
        let counts = Counts::default();
        Self { worker: block.worker(counting), picks: PickBuffer::default(), counts, size: (1, 1) }
    }

    fn run(&mut self, plan: &Plan<'_>, kernel: Kernel, receivers: &[Receiver], block: &Range<u32>, sums: &mut [DVec3]) {
        let extended = plan.stage.needs().has(Kind::Triangle);
        let mut done = 0;
        while done < receivers.len() {
            let tile = done..(done + self.size.0).min(receivers.len());
            let mut pass = block.start;
            while pass < block.end {
                let passes = pass..(pass + self.size.1).min(block.end);
                let count = (passes.end - passes.start) as usize;
                let (receivers, sums) = (&receivers[tile.clone()], &mut sums[tile.clone()]);
                self.worker.fill(receivers, passes.clone(), extended, &mut self.picks);
                kernel(plan.stage, receivers, count, &self.picks, sums, &mut self.counts);
                // A sampler that takes thousands of lights gets one receiver and few passes at a time.
                let a_call = (self.picks.len() / (receivers.len() * count)).max(1);
                let calls = (PICKS / a_call).clamp(1, CALLS);
                self.size.1 = calls as u32;
                pass = passes.end;
                if pass == block.end {
                    self.size.0 = (calls / block.len()).clamp(1, TILE);
                }
            }
            done = tile.end;
        }
    }
}
