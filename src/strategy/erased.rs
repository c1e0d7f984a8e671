//! Samplers of any type behind one call for a tile of receivers and a block of passes.
//!
//! The one virtual call is made once a tile, so that it costs nothing; shading then runs over the picks, compiled for
//! what the scene needs and not once more for each strategy.
//!
//! A [`LightSampler`] serves any passes. A [`FrameSampler`] draws state anew for each pass or looks at the whole frame,
//! and makes a sampler for each pass.

use super::tally::{Tally, Uncounted, Work};
use super::{BuildContext, Info, LightSampler, Pick, Picks, Strategy};
use crate::base::draws::{Draws, Points, Sequence};
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;
use std::any::Any;
use std::ops::Range;

/// A strategy of any type.
pub trait AnyStrategy: Send + Sync {
    /// As [`Strategy::info`].
    fn info(&self) -> Info;
    /// As [`Strategy::gives_candidates`].
    fn gives_candidates(&self) -> bool;
    /// As [`Strategy::scale_free`].
    fn scale_free(&self) -> bool;
    /// Builds its sampler for a scene.
    fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>>;
}

impl<S: Strategy> AnyStrategy for S {
    fn info(&self) -> Info {
        Strategy::info(self)
    }

    fn gives_candidates(&self) -> bool {
        Strategy::gives_candidates(self)
    }

    fn scale_free(&self) -> bool {
        Strategy::scale_free(self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>> {
        Ok(Box::new(Strategy::build(self, context)?))
    }
}

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

/// A sampler of any type: implemented by every [`LightSampler`] and, through [`PerPass`], every [`FrameSampler`].
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
pub trait Block: Send + Sync {
    /// A worker with its own scratch, one a thread, that counts its work or does not.
    fn worker(&self, counting: bool) -> Box<dyn Worker + '_>;
}

/// What samples a sampler on one thread.
pub trait Worker {
    /// Fills `out` with the picks of receivers of the frame in passes of the block: all passes of one receiver
    /// together.
    ///
    /// `extended` says whether any light has an extent, so that a point on it must be drawn.
    fn fill(&mut self, receivers: &[Receiver], passes: Range<u32>, extended: bool, out: &mut PickBuffer);
    /// The work so far, if it is counted.
    fn work(&self) -> Work;
}

/// Picks of several receivers in several passes.
#[derive(Default)]
pub struct PickBuffer {
    picks: Vec<Pick>,
    ends: Vec<u32>,
}

impl PickBuffer {
    /// Forgets all picks and keeps the storage.
    pub fn clear(&mut self) {
        self.picks.clear();
        self.ends.clear();
    }

    /// The number of picks.
    pub fn len(&self) -> usize {
        self.picks.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.picks.is_empty()
    }

    /// The picks of each (receiver, pass) in the order they were filled.
    pub fn calls(&self) -> impl Iterator<Item = &[Pick]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let call = &self.picks[start..end as usize];
            start = end as usize;
            call
        })
    }
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

impl<L: LightSampler> LightSampler for &L {
    type Scratch = L::Scratch;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut L::Scratch, tally: &mut T) {
        L::arrive(self, at, scratch, tally);
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut L::Scratch, out: &mut Picks<'_, T>) {
        L::sample(self, at, draws, scratch, out);
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        L::expected_counts(self, at, counts)
    }

    fn heap_bytes(&self) -> usize {
        L::heap_bytes(self)
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

/// A sampler whose numbers are spread in a way of its own.
pub(super) struct Spread {
    pub(super) sampler: Box<dyn AnySampler>,
    pub(super) points: Points,
}

impl AnySampler for Spread {
    fn most_passes(&self) -> u32 {
        self.sampler.most_passes()
    }

    fn begin<'a>(&'a self, frame: Frame<'a>, passes: Range<u32>) -> Box<dyn Block + 'a> {
        self.sampler.begin(Frame { points: self.points, ..frame }, passes)
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        self.sampler.expected_counts(at, counts)
    }

    fn heap_bytes(&self) -> usize {
        self.sampler.heap_bytes()
    }

    fn source(&self) -> Option<&dyn Source> {
        self.sampler.source()
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
        if counting { Box::new(Typed::<L, Work>::new(self)) } else { Box::new(Typed::<L, Uncounted>::new(self)) }
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

    fn work(&self) -> Work {
        self.tally.work()
    }
}

/// A sampler of any type, called from within another. `scratch` is what its own [`scratch`](Self::scratch) made.
pub trait Source: Send + Sync {
    /// New scratch.
    fn scratch(&self) -> Box<dyn Any + Send>;
    /// As [`LightSampler::arrive`]; counts where `work` is given.
    fn arrive(&self, at: &Receiver, scratch: &mut dyn Any, work: Option<&mut Work>);
    /// As [`LightSampler::sample`]; appends to `picks`. Points are left to whoever shades.
    fn sample(
        &self,
        at: &Receiver,
        draws: &mut Draws,
        scratch: &mut dyn Any,
        work: Option<&mut Work>,
        picks: &mut Vec<Pick>,
    );
}

impl<L: LightSampler> Source for L {
    fn scratch(&self) -> Box<dyn Any + Send> {
        Box::new(L::Scratch::default())
    }

    fn arrive(&self, at: &Receiver, scratch: &mut dyn Any, work: Option<&mut Work>) {
        let scratch = scratch.downcast_mut().expect("scratch of this sampler");
        match work {
            Some(work) => LightSampler::arrive(self, at, scratch, work),
            None => LightSampler::arrive(self, at, scratch, &mut Uncounted),
        }
    }

    fn sample(
        &self,
        at: &Receiver,
        draws: &mut Draws,
        scratch: &mut dyn Any,
        work: Option<&mut Work>,
        picks: &mut Vec<Pick>,
    ) {
        let scratch = scratch.downcast_mut().expect("scratch of this sampler");
        match work {
            Some(work) => LightSampler::sample(self, at, draws, scratch, &mut Picks::new(picks, work)),
            None => LightSampler::sample(self, at, draws, scratch, &mut Picks::new(picks, &mut Uncounted)),
        }
    }
}
