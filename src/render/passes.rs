//! Running passes over all receivers: on one thread for a clock, on all of them for a picture.

use super::film::Film;
use super::kernel::{Kernel, kernel};
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
    /// The receivers to sample: all of the stage's, or some.
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

impl Plan<'_> {
    /// Adds `passes` more passes to `film`, on this thread.
    pub fn run(&self, passes: u32, film: &mut Film) {
        self.one_thread(false, passes, film);
    }

    /// As [`run`](Self::run), counting.
    pub fn run_counting(&self, passes: u32, film: &mut Film) -> Counts {
        self.one_thread(true, passes, film)
    }

    /// As [`run`](Self::run), on all threads of the current pool: the same bytes.
    pub fn run_parallel(&self, passes: u32, film: &mut Film) {
        let kernel = kernel(self.stage.needs(), false);
        for passes in self.blocks(passes, film) {
            let block = self.sampler.begin(self.frame(), passes.clone());
            self.receivers.par_chunks(TILE).zip(film.sums.par_chunks_mut(TILE)).for_each_init(
                || Tiles::new(&*block, false),
                |tiles, (receivers, sums)| tiles.run(self, kernel, receivers, &passes, sums),
            );
        }
    }

    fn one_thread(&self, counting: bool, passes: u32, film: &mut Film) -> Counts {
        let kernel = kernel(self.stage.needs(), counting);
        let mut counts = Counts::default();
        for passes in self.blocks(passes, film) {
            let block = self.sampler.begin(self.frame(), passes.clone());
            let mut tiles = Tiles::new(&*block, counting);
            tiles.run(self, kernel, self.receivers, &passes, &mut film.sums);
            tiles.counts += tiles.worker.work();
            counts += tiles.counts;
        }
        counts
    }

    fn frame(&self) -> Frame<'_> {
        Frame::new(self.receivers, self.key)
    }

    /// The next `passes` passes of a film in blocks that the sampler can begin together.
    fn blocks(&self, passes: u32, film: &mut Film) -> impl Iterator<Item = Range<u32>> + use<> {
        let first = film.next;
        film.next = first + passes;
        blocks(self.sampler, first..film.next)
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
