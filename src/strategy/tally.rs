//! What does choosing cost, in work rather than time? Counts carry over between machines.
//!
//! Samplers are compiled twice: with [`Work`], which counts, and with [`Uncounted`], which is nothing at all.

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
    fn add(&mut self, work: Work);
    /// The counts, if there are any.
    fn work(&self) -> Work;
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
    fn add(&mut self, _work: Work) {}
    fn work(&self) -> Work {
        Work::default()
    }
}

/// Counted work of choosing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Nodes of a hierarchy visited.
    pub nodes: u64,
    /// Lights or nodes weighed at a receiver.
    pub weighed: u64,
    /// Candidates drawn to choose from.
    pub candidates: u64,
    /// Shadow rays cast to choose, not to shade.
    pub shadow_rays: u64,
}

impl Tally for Work {
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
        self.shadow_rays += count;
    }

    fn add(&mut self, work: Work) {
        self.nodes += work.nodes;
        self.weighed += work.weighed;
        self.candidates += work.candidates;
        self.shadow_rays += work.shadow_rays;
    }

    fn work(&self) -> Work {
        *self
    }
}
