//! What is checked, and against what?

use super::calls::calls;
use super::options::VerifyOptions;
use super::truth::Truth;
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, Frame, Pick};
use crate::visibility::stage::Stage;
use std::ops::Range;

/// A sampler and what it is checked against.
pub(super) struct Subject<'v> {
    pub(super) stage: &'v Stage,
    pub(super) options: &'v VerifyOptions,
    /// All that is sampled.
    pub(super) frame: &'v [Receiver],
    /// Where it is looked at, and what each light adds there.
    pub(super) receivers: &'v [Receiver],
    pub(super) truths: &'v [Truth],
    pub(super) sampler: &'v dyn AnySampler,
}

impl Subject<'_> {
    /// Names the numbers of an independent run.
    pub(super) fn key(&self, run: u32) -> RunKey {
        RunKey { seed: self.options.seed, run }
    }

    /// The picks of run 0 at receivers of a frame, by receiver and pass, points on lights drawn.
    pub(super) fn calls(&self, frame: &[Receiver], receivers: &[Receiver], passes: Range<u32>) -> Vec<Vec<Pick>> {
        calls(self.sampler, Frame::new(frame, self.key(0)), receivers, passes, true)
    }
}
