//! Samplers of any type behind one call for a tile of receivers and a block of passes.
//!
//! The one virtual call is made once a tile, so that it costs nothing; shading then runs over the picks, compiled for
//! what the scene needs and not once more for each strategy.
//!
//! A [`LightSampler`] serves any passes. A [`FrameSampler`] draws state anew for each pass or looks at the whole frame,
//! and makes a sampler for each pass.

use super::buffer::PickBuffer;
use super::frame::{Frame, FrameSampler};
use super::pick::Picks;
use super::sampler::LightSampler;
use super::source::Source;
use super::tally::{Tally, Uncounted};
use crate::base::counts::Counts;
use crate::base::draws::{Points, Sequence};
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;
use std::ops::Range;

/// A sampler of any type: implemented by every [`LightSampler`] and, through [`PerPass`], every [`FrameSampler`].
///
/// ```
/// use citylights::prelude::*;
/// use citylights::visibility::{offset::Offset, stage::{LeaveOut, Stage}};
///
/// let stage = Stage::new(Scene::new(citylights::sources::small::sixteen())?, LeaveOut::Yes, Offset::SCALED);
/// let sampler = Registry::standard().parse("power:picks=3")?.build(BuildContext { stage: &stage, seed: 1 })?;
/// let mut counts = vec![0.0; stage.scene().lights().len()];
/// assert!(sampler.expected_counts(&stage.receivers()[0], &mut counts), "they can be told");
/// assert!((counts.iter().sum::<f32>() - 3.0).abs() < 1e-5, "three picks, among all lights");
/// # Ok::<(), Error>(())
/// ```
pub trait AnySampler: Send + Sync {
    /// Most passes that can be begun together: 1 where there is state of one pass.
    fn most_passes(&self) -> u32 {
        u32::MAX
    }
    /// Begins a block of passes of a frame; at most [`most_passes`](Self::most_passes) of them.
    fn begin<'a>(&'a self, frame: Frame<'a>, passes: Range<u32>) -> Box<dyn Block + 'a>;
    /// As [`LightSampler::expected_counts`].
    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool;
    /// As [`LightSampler::heap_bytes`].
    fn heap_bytes(&self) -> usize;
    /// As a source of picks for another sampler, if it needs no frame.
    fn source(&self) -> Option<&dyn Source> {
        None
    }
}

/// Passes in blocks that a sampler can begin together.
pub fn blocks(sampler: &dyn AnySampler, passes: Range<u32>) -> impl Iterator<Item = Range<u32>> + use<> {
    let (mut next, end, most) = (passes.start, passes.end, sampler.most_passes());
    std::iter::from_fn(move || {
        let block = next..end.min(next.saturating_add(most));
        next = block.end;
        (!block.is_empty()).then_some(block)
    })
}

/// A sampler in a block of passes.
///
/// ```
/// use citylights::base::random::RunKey;
/// use citylights::prelude::*;
/// use citylights::strategy::{Frame, PickBuffer};
/// use citylights::visibility::{offset::Offset, stage::{LeaveOut, Stage}};
///
/// let stage = Stage::new(Scene::new(citylights::sources::small::sixteen())?, LeaveOut::Yes, Offset::SCALED);
/// let sampler = Registry::standard().parse("power:picks=2")?.build(BuildContext { stage: &stage, seed: 1 })?;
/// let block = sampler.begin(Frame::new(stage.receivers(), RunKey { seed: 1, run: 0 }), 0..8);
/// let mut picks = PickBuffer::default();
/// block.worker(false).fill(&stage.receivers()[..5], 0..8, true, &mut picks);
/// assert_eq!(picks.calls().count(), 5 * 8, "one call for each receiver and pass");
/// assert!(picks.calls().all(|call| call.len() == 2), "two lights in each");
/// # Ok::<(), Error>(())
/// ```
pub trait Block: Send + Sync {
    /// A worker with its own scratch, one a thread, that counts its work or does not.
    fn worker(&self, counting: bool) -> Box<dyn Worker + '_>;
}

/// What samples a sampler on one thread. Nobody needs to write one: implement [`LightSampler`] or [`FrameSampler`].
///
/// ```
/// use citylights::base::random::RunKey;
/// use citylights::prelude::*;
/// use citylights::strategy::{Frame, PickBuffer};
/// use citylights::visibility::{offset::Offset, stage::{LeaveOut, Stage}};
///
/// let stage = Stage::new(Scene::new(citylights::sources::small::sixteen())?, LeaveOut::Yes, Offset::SCALED);
/// let sampler = Registry::standard().parse("intensity")?.build(BuildContext { stage: &stage, seed: 1 })?;
/// let block = sampler.begin(Frame::new(stage.receivers(), RunKey { seed: 1, run: 0 }), 0..8);
/// let mut worker = block.worker(true);
/// worker.fill(&stage.receivers()[..1], 0..8, true, &mut PickBuffer::default());
/// let lights = stage.lights().len() as u64;
/// assert_eq!(worker.work().weighed, lights, "each light is weighed once, on arrival, and not in each pass");
/// # Ok::<(), Error>(())
/// ```
pub trait Worker {
    /// Fills `out` with the picks of receivers of the frame in passes of the block: all passes of one receiver
    /// together.
    ///
    /// `extended` says whether any light has an extent, so that a point on it must be drawn.
    fn fill(&mut self, receivers: &[Receiver], passes: Range<u32>, extended: bool, out: &mut PickBuffer);
    /// The work so far, if it is counted.
    fn work(&self) -> Counts;
}

impl<L: LightSampler> AnySampler for L {
    fn begin<'a>(&'a self, frame: Frame<'a>, _passes: Range<u32>) -> Box<dyn Block + 'a> {
        Box::new(Begun { sampler: self, key: frame.key, points: frame.points })
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        LightSampler::expected_counts(self, at, counts)
    }

    fn heap_bytes(&self) -> usize {
        LightSampler::heap_bytes(self)
    }

    fn source(&self) -> Option<&dyn Source> {
        Some(self)
    }
}

/// A [`FrameSampler`] as one of any type.
pub struct PerPass<F>(pub F);

impl<F: FrameSampler> AnySampler for PerPass<F> {
    fn most_passes(&self) -> u32 {
        1
    }

    fn begin<'a>(&'a self, frame: Frame<'a>, passes: Range<u32>) -> Box<dyn Block + 'a> {
        debug_assert!(passes.len() <= 1, "state of one pass is no state of {passes:?}");
        Box::new(Begun { sampler: self.0.begin(frame, passes.start), key: frame.key, points: frame.points })
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        self.0.expected_counts(at, counts)
    }

    fn heap_bytes(&self) -> usize {
        self.0.heap_bytes()
    }
}

impl AnySampler for Box<dyn AnySampler> {
    fn most_passes(&self) -> u32 {
        (**self).most_passes()
    }

    fn begin<'a>(&'a self, frame: Frame<'a>, passes: Range<u32>) -> Box<dyn Block + 'a> {
        (**self).begin(frame, passes)
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        (**self).expected_counts(at, counts)
    }

    fn heap_bytes(&self) -> usize {
        (**self).heap_bytes()
    }

    fn source(&self) -> Option<&dyn Source> {
        (**self).source()
    }
}

struct Begun<L> {
    sampler: L,
    key: RunKey,
    points: Points,
}

impl<L: LightSampler> Block for Begun<L> {
    fn worker(&self, counting: bool) -> Box<dyn Worker + '_> {
        if counting { Box::new(Typed::<L, Counts>::new(self)) } else { Box::new(Typed::<L, Uncounted>::new(self)) }
    }
}

struct Typed<'a, L: LightSampler, T> {
    begun: &'a Begun<L>,
    scratch: L::Scratch,
    tally: T,
}

impl<'a, L: LightSampler, T: Tally> Typed<'a, L, T> {
    fn new(begun: &'a Begun<L>) -> Self {
        Self { begun, scratch: L::Scratch::default(), tally: T::default() }
    }
}

impl<L: LightSampler, T: Tally> Worker for Typed<'_, L, T> {
    fn fill(&mut self, receivers: &[Receiver], passes: Range<u32>, extended: bool, out: &mut PickBuffer) {
        out.clear();
        let Begun { sampler, key, points } = self.begun;
        for at in receivers {
            let sequence = Sequence::new(*key, at.pixel, *points);
            sampler.arrive(at, &mut self.scratch, &mut self.tally);
            for pass in passes.clone() {
                let mut draws = sequence.pass(pass);
                let first = out.picks.len();
                let mut picks = Picks::new(&mut out.picks, &mut self.tally);
                sampler.sample(at, &mut draws, &mut self.scratch, &mut picks);
                if extended {
                    (0..).zip(&mut out.picks[first..]).for_each(|(slot, pick)| pick.settle(slot, &mut draws));
                }
                out.ends.push(out.picks.len() as u32);
            }
        }
    }

    fn work(&self) -> Counts {
        self.tally.work()
    }
}
