//! What do strategies render, and where are errors taken?
//!
//! A strategy always renders whole frames, as a user does: what it shares between neighbours, and what an arrival or a
//! pass costs, is then what it will be elsewhere. Errors are taken at some of the frame's receivers, or at all.

use crate::scene::receiver::Receiver;
use crate::visibility::stage::Stage;
use glam::Vec3;
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
}

impl<'a> Target<'a> {
    /// All that the camera sees, measured everywhere.
    pub(crate) fn whole(stage: &'a Stage) -> Self {
        let frame = Cow::Borrowed(stage.receivers());
        Self { stage, places: (0..frame.len()).collect(), frame }
    }

    /// These receivers, whoever chose them: a frame of their own, measured everywhere.
    pub(crate) fn of(stage: &'a Stage, receivers: Vec<Receiver>) -> Self {
        Self { stage, places: (0..receivers.len()).collect(), frame: Cow::Owned(receivers) }
    }

    /// The same frame measured at up to `count` of the measured receivers: one from each stratum, see [`places`].
    pub(crate) fn thinned(&self, count: usize) -> Self {
        let places = places(self.places.len(), count).map(|i| self.places[i]).collect();
        Self { places, ..self.clone() }
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
