//! Lights chosen with state that is drawn anew for each pass, or with a view of the whole frame.

use super::sampler::LightSampler;
use crate::base::draws::Points;
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;

/// All that is sampled in a pass, and by which numbers.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// The receivers, neighbours together.
    pub receivers: &'a [Receiver],
    /// Names the random numbers.
    pub key: RunKey,
    /// How they are spread over a pixel's passes; a strategy that was named has its own say.
    pub points: Points,
}

impl<'a> Frame<'a> {
    /// A frame with independent numbers.
    pub fn new(receivers: &'a [Receiver], key: RunKey) -> Self {
        Self { receivers, key, points: Points::Random }
    }
}

/// Lights chosen with state that is drawn anew for each pass, or with a view of the whole frame.
pub trait FrameSampler: Send + Sync {
    /// What samples in one pass.
    type Pass<'a>: LightSampler
    where
        Self: 'a;

    /// Begins a pass: draws its state.
    fn begin<'a>(&'a self, frame: Frame<'a>, pass: u32) -> Self::Pass<'a>;

    /// As [`LightSampler::expected_counts`]; the expectation runs over the state of the pass too.
    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool;

    /// As [`LightSampler::heap_bytes`].
    fn heap_bytes(&self) -> usize;
}
