//! What do strategies render, and where are errors taken?
//!
//! A strategy always renders whole frames, as a user does: what it shares between neighbours, and what an arrival or a
//! pass costs, is then what it will be elsewhere. Errors are taken at some of the frame's receivers, or at all.
//!
//! Where receivers move from pass to pass, the frame's stand for their pixels. The error of a pixel after some passes is
//! then the mean over these of the estimate less the truth at the very receiver that the pass visited: the noise of
//! choosing lights alone, none of where a pass happened to look. A pass that visits nothing adds 0 to both.

use crate::scene::receiver::Receiver;
use crate::visibility::stage::Stage;
use glam::Vec3;
use rayon::prelude::*;
use std::borrow::Cow;

/// A frame, and the receivers in it that errors are taken over.
#[derive(Clone)]
pub(crate) struct Target<'a> {
    /// The scene made ready.
    pub stage: &'a Stage,
    /// The receivers that strategies are run on.
    pub frame: Cow<'a, [Receiver]>,
    /// Which of them are measured: indices into the frame, ascending.
    pub places: Vec<usize>,
    /// Where receivers move: the numbers of passes after which errors are taken, ascending. Empty where they stay.
    budgets: Vec<u32>,
}

/// A receiver whose radiance must be known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Visited {
    /// Which of the measured places it belongs to: an index into [`Target::places`].
    pub place: usize,
    /// The pass that visits it; none where every pass does.
    pub pass: Option<u32>,
    /// The receiver.
    pub at: Receiver,
}

impl<'a> Target<'a> {
    /// All that the camera sees, measured everywhere.
    pub(crate) fn whole(stage: &'a Stage) -> Self {
        let frame = Cow::Borrowed(stage.receivers());
        Self { stage, places: (0..frame.len()).collect(), frame, budgets: Vec::new() }
    }

    /// These receivers, whoever chose them: a frame of their own, measured everywhere.
    pub(crate) fn of(stage: &'a Stage, receivers: Vec<Receiver>) -> Self {
        Self { stage, places: (0..receivers.len()).collect(), frame: Cow::Owned(receivers), budgets: Vec::new() }
    }

    /// The same frame measured at up to `count` of the measured receivers: one from each stratum, see [`places`].
    pub(crate) fn thinned(&self, count: usize) -> Self {
        let places = places(self.places.len(), count).map(|i| self.places[i]).collect();
        Self { places, ..self.clone() }
    }

    /// The same target with errors taken after these numbers of passes, in any order. It matters only where receivers move.
    pub(crate) fn after(&self, passes: impl IntoIterator<Item = u32>) -> Self {
        let mut budgets: Vec<u32> = passes.into_iter().collect();
        budgets.sort_unstable();
        budgets.dedup();
        if !self.stage.visits().moves() {
            budgets.clear();
        }
        Self { budgets, ..self.clone() }
    }

    /// Where receivers move: the numbers of passes after which errors are taken, ascending. Empty where they stay.
    pub(crate) fn budgets(&self) -> &[u32] {
        &self.budgets
    }

    /// The receivers whose radiance errors are taken against, place by place: one of each where they stay, else those of
    /// all passes.
    pub(crate) fn visited(&self) -> Vec<Visited> {
        let centres = self.places.iter().map(|&i| &self.frame[i]).enumerate();
        if !self.stage.visits().moves() {
            return centres.map(|(place, at)| Visited { place, pass: None, at: *at }).collect();
        }
        let most = self.budgets.last().copied().unwrap_or(0);
        let centres: Vec<(usize, &Receiver)> = centres.collect();
        let of = |&(place, centre): &(usize, &Receiver)| {
            let visited = |pass| Some(Visited { place, pass: Some(pass), at: self.stage.visited(centre, pass)? });
            (0..most).filter_map(visited).collect::<Vec<_>>()
        };
        centres.par_iter().flat_map_iter(of).collect()
    }

    /// Whether errors are taken at some of the frame's receivers only.
    pub(crate) fn is_subset(&self) -> bool {
        self.places.len() < self.frame.len()
    }

    /// The measured receivers.
    pub(crate) fn measured(&self) -> Vec<Receiver> {
        self.places.iter().map(|&i| self.frame[i]).collect()
    }

    /// An image of the frame at the measured receivers.
    pub(crate) fn at_places(&self, image: &[Vec3]) -> Vec<Vec3> {
        self.places.iter().map(|&i| image[i]).collect()
    }
}

/// `count` receivers at equal steps through the list, whose order follows squares of the image: one from each stratum.
pub(crate) fn spread(receivers: &[Receiver], count: usize) -> Vec<Receiver> {
    places(receivers.len(), count).map(|i| receivers[i]).collect()
}

/// Neighbours of a square. Receivers follow squares of 8 x 8 pixels.
pub(crate) const SQUARE: usize = 64;

/// `count` squares of [`SQUARE`] neighbouring receivers at equal steps through the list; all of it where it is shorter.
pub(crate) fn squares(receivers: &[Receiver], count: usize) -> Vec<Receiver> {
    if receivers.len() <= count * SQUARE {
        return receivers.to_vec();
    }
    let begins = places(receivers.len() / SQUARE, count).map(|square| square * SQUARE);
    begins.flat_map(|begin| receivers[begin..][..SQUARE].iter().copied()).collect()
}

/// Where [`spread`] finds its receivers in a list of `all`.
pub(crate) fn places(all: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(all);
    (0..count).map(move |i| (2 * i + 1) * all / (2 * count))
}
