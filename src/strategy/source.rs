//! A sampler of any type, called from within another.

use super::pick::{Pick, Picks};
use super::sampler::LightSampler;
use super::tally::Uncounted;
use crate::base::counts::Counts;
use crate::base::draws::Draws;
use crate::scene::receiver::Receiver;
use std::any::Any;

/// A sampler of any type, called from within another. `scratch` is what its own [`scratch`](Self::scratch) made.
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
