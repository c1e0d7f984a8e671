//! Samplers of any type behind one call for a tile of receivers and a block of passes.
//!
//! The one virtual call is made once a tile, so that it costs nothing; shading then runs over the picks, compiled for
//! what the scene needs and not once more for each strategy.

use super::{BuildContext, Info, LightSampler, Pick, Picks, Strategy};
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;
use std::ops::Range;

/// A strategy of any type.
pub trait AnyStrategy: Send + Sync {
    /// What it is.
    fn info(&self) -> Info;
    /// Builds its sampler for a scene.
    fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>>;
}

impl<S: Strategy> AnyStrategy for S {
    fn info(&self) -> Info {
        S::INFO
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>> {
        Ok(Box::new(Strategy::build(self, context)?))
    }
}

/// A sampler of any type: implemented by every [`LightSampler`].
pub trait AnySampler: Send + Sync {
    /// A worker with its own scratch; one a thread.
    fn worker(&self) -> Box<dyn Worker + '_>;
    /// As [`LightSampler::expected_counts`].
    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool;
    /// As [`LightSampler::heap_bytes`].
    fn heap_bytes(&self) -> usize;
}

/// What samples a sampler on one thread.
pub trait Worker {
    /// Fills `out` with the picks of each receiver in each pass: all passes of one receiver together.
    ///
    /// `points` says whether any light has an extent, so that a point on it must be drawn.
    fn fill(&mut self, receivers: &[Receiver], passes: Range<u32>, key: RunKey, points: bool, out: &mut PickBuffer);
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
    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(Typed { sampler: self, scratch: L::Scratch::default() })
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        LightSampler::expected_counts(self, at, counts)
    }

    fn heap_bytes(&self) -> usize {
        LightSampler::heap_bytes(self)
    }
}

struct Typed<'a, L: LightSampler> {
    sampler: &'a L,
    scratch: L::Scratch,
}

impl<L: LightSampler> Worker for Typed<'_, L> {
    fn fill(&mut self, receivers: &[Receiver], passes: Range<u32>, key: RunKey, points: bool, out: &mut PickBuffer) {
        out.clear();
        for at in receivers {
            self.sampler.arrive(at, &mut self.scratch);
            for pass in passes.clone() {
                let mut rng = key.stream(pass, at.pixel);
                let first = out.picks.len();
                self.sampler.sample(at, &mut rng, &mut self.scratch, &mut Picks::new(&mut out.picks));
                if points {
                    for pick in &mut out.picks[first..] {
                        if pick.uv == Pick::DRAW {
                            pick.uv = rng.uniform2();
                        }
                    }
                }
                out.ends.push(out.picks.len() as u32);
            }
        }
    }
}
