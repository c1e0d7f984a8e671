//! What does choosing cost, in work rather than time? Counts carry over between machines.
//!
//! Samplers are compiled twice: with [`Counts`], which counts, and with [`Uncounted`], which is nothing at all.

use crate::base::counts::Counts;

/// Counts the work of choosing.
pub trait Tally: Default + Send {
    /// Whether it counts at all; if not, a sampler within another need not count either.
    const COUNTS: bool;
    /// Nodes of a hierarchy visited.
    fn nodes(&mut self, count: u64);
    /// Lights or nodes weighed at a receiver.
    fn weighed(&mut self, count: u64);
    /// Candidates drawn to choose from.
    fn candidates(&mut self, count: u64);
    /// Shadow rays cast to choose, not to shade.
    fn shadow_rays(&mut self, count: u64);
    /// Adds what another tally counted.
    fn add(&mut self, work: Counts);
    /// The counts, if there are any.
    fn work(&self) -> Counts;
}

/// Counts nothing: for timed runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uncounted;

impl Tally for Uncounted {
    const COUNTS: bool = false;

    #[inline(always)]
    fn nodes(&mut self, _count: u64) {}
    #[inline(always)]
    fn weighed(&mut self, _count: u64) {}
    #[inline(always)]
    fn candidates(&mut self, _count: u64) {}
    #[inline(always)]
    fn shadow_rays(&mut self, _count: u64) {}
    #[inline(always)]
    fn add(&mut self, _work: Counts) {}
    fn work(&self) -> Counts {
        Counts::default()
    }
}

impl Tally for Counts {
    const COUNTS: bool = true;

    fn nodes(&mut self, count: u64) {
        self.nodes += count;
    }

    fn weighed(&mut self, count: u64) {
        self.weighed += count;
    }

    fn candidates(&mut self, count: u64) {
        self.candidates += count;
    }

    fn shadow_rays(&mut self, count: u64) {
        self.choosing_rays += count;
    }

    fn add(&mut self, work: Counts) {
        *self += work;
    }

    fn work(&self) -> Counts {
        *self
    }
}
