//! Which receivers are sampled together, and in which passes?
//!
//! Receivers that stay are visited once, for all passes: what an arrival costs is then shared by them. Receivers that move
//! are visited pass by pass, and every pass pays for its own arrivals.

use super::film::Film;
use crate::scene::receiver::Receiver;
use crate::visibility::stage::Stage;
use glam::DVec3;
use std::borrow::Cow;
use std::ops::Range;

/// Receivers, and the passes that are sampled at them in one go.
pub(crate) struct Visit<'a> {
    /// The receivers.
    pub(crate) receivers: Cow<'a, [Receiver]>,
    /// The film's place of each; none where they are the film's own places in order.
    places: Option<Vec<u32>>,
    /// The passes.
    pub(crate) passes: Range<u32>,
}

impl<'a> Visit<'a> {
    /// All visits of some passes to the pixels of a film, which `centres` stand for.
    pub(super) fn all(stage: &'a Stage, centres: &'a [Receiver], passes: Range<u32>) -> impl Iterator<Item = Self> {
        let moving = if stage.visits().moves() { passes.clone() } else { 0..0 };
        let staying = (!stage.visits().moves()).then(|| Self::staying(centres, passes));
        staying.into_iter().chain(moving.map(move |pass| Self::moving(stage, centres, pass)))
    }

    fn staying(receivers: &'a [Receiver], passes: Range<u32>) -> Self {
        Self { receivers: Cow::Borrowed(receivers), places: None, passes }
    }

    /// The receivers of one pass: fewer than pixels where some see none.
    pub(crate) fn moving(stage: &Stage, centres: &[Receiver], pass: u32) -> Self {
        let found = (0..).zip(centres).filter_map(|(place, at)| Some((place, stage.visited(at, pass)?)));
        let (places, receivers): (Vec<u32>, Vec<Receiver>) = found.unzip();
        Self { receivers: Cow::Owned(receivers), places: Some(places), passes: pass..pass + 1 }
    }

    /// Adds to a film what `sample` adds to the sums of the receivers.
    pub(crate) fn onto(&self, film: &mut Film, sample: impl FnOnce(&mut [DVec3])) {
        let Some(places) = &self.places else { return sample(&mut film.sums) };
        let mut sums = vec![DVec3::ZERO; places.len()];
        sample(&mut sums);
        places.iter().zip(sums).for_each(|(&place, sum)| film.sums[place as usize] += sum);
    }
}
