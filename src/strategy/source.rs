//! A sampler of any type, called from within another.

use super::pick::{Pick, Picks};
use super::sampler::LightSampler;
use super::tally::Uncounted;
use crate::base::counts::Counts;
use crate::base::draws::Draws;
use crate::scene::receiver::Receiver;
use std::any::Any;

/// A sampler of any type, called from within another. `scratch` is what its own [`scratch`](Self::scratch) made.
///
/// ```
/// use citylights::base::{draws::{Points, Sequence}, random::RunKey};
/// use citylights::prelude::*;
/// use citylights::visibility::{offset::Offset, stage::{LeaveOut, Stage}};
///
/// let stage = Stage::new(Scene::new(citylights::sources::small::sixteen())?, LeaveOut::Yes, Offset::SCALED);
/// let sampler = Registry::standard().parse("power")?.build(BuildContext { stage: &stage, seed: 1 })?;
/// let source = sampler.source().expect("it chooses at one receiver, without a view of the frame");
/// let (at, mut scratch) = (&stage.receivers()[0], source.scratch());
/// source.arrive(at, &mut *scratch, None);
/// let mut candidates = Vec::new();
/// let mut draws = Sequence::new(RunKey { seed: 1, run: 0 }, at.pixel, Points::R2).pass(0);
/// for call in 0..4 {
///     draws.nested(call, 4, |draws| source.sample(at, draws, &mut *scratch, None, &mut candidates));
/// }
/// assert_eq!(candidates.len(), 4);
/// # Ok::<(), Error>(())
/// ```
pub trait Source: Send + Sync {
    /// New scratch.
    fn scratch(&self) -> Box<dyn Any + Send>;
    /// As [`LightSampler::arrive`]; counts where `work` is given.
    fn arrive(&self, at: &Receiver, scratch: &mut dyn Any, work: Option<&mut Counts>);
    /// As [`LightSampler::sample`]; appends to `picks`. Points are left to whoever shades.
    fn sample(
        &self,
        at: &Receiver,
        draws: &mut Draws,
        scratch: &mut dyn Any,
        work: Option<&mut Counts>,
        picks: &mut Vec<Pick>,
    );
}

impl<L: LightSampler> Source for L {
    fn scratch(&self) -> Box<dyn Any + Send> {
        Box::new(L::Scratch::default())
    }

    fn arrive(&self, at: &Receiver, scratch: &mut dyn Any, work: Option<&mut Counts>) {
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
        work: Option<&mut Counts>,
        picks: &mut Vec<Pick>,
    ) {
        let scratch = scratch.downcast_mut().expect("scratch of this sampler");
        match work {
            Some(work) => LightSampler::sample(self, at, draws, scratch, &mut Picks::new(picks, work)),
            None => LightSampler::sample(self, at, draws, scratch, &mut Picks::new(picks, &mut Uncounted)),
        }
    }
}
