//! Which receivers are measured?

use crate::scene::receiver::Receiver;
use crate::visibility::stage::Stage;
use std::borrow::Cow;

/// Above this many pixel-light pairs, errors are measured at [`SUBSET`] receivers only.
pub const MOST_PAIRS: u64 = 5_000_000_000;

/// How many receivers stand for all where there are too many pairs.
pub const SUBSET: usize = 1_024;

/// The receivers that errors are taken over.
pub struct Target<'a> {
    /// The scene made ready.
    pub stage: &'a Stage,
    /// The measured receivers.
    pub receivers: Cow<'a, [Receiver]>,
    /// Whether they are a fixed stratified subset.
    pub subset: bool,
}

impl<'a> Target<'a> {
    /// All receivers, or the fixed subset where a reference of all would take too long.
    pub fn new(stage: &'a Stage) -> Self {
        let all = stage.receivers();
        let pairs = all.len() as u64 * stage.scene().lights().len() as u64;
        let subset = pairs > MOST_PAIRS && all.len() > SUBSET;
        let receivers = if subset { Cow::Owned(spread(all, SUBSET)) } else { Cow::Borrowed(all) };
        Self { stage, receivers, subset }
    }

    /// Every receiver, however long it takes.
    pub fn whole(stage: &'a Stage) -> Self {
        Self { stage, receivers: Cow::Borrowed(stage.receivers()), subset: false }
    }

    /// These receivers, whoever chose them.
    pub fn of(stage: &'a Stage, receivers: Vec<Receiver>) -> Self {
        Self { stage, receivers: Cow::Owned(receivers), subset: true }
    }

    /// The same target thinned out to about `count` receivers, for pilots.
    pub fn thinned(&self, count: usize) -> Self {
        Self { stage: self.stage, receivers: Cow::Owned(spread(&self.receivers, count)), subset: self.subset }
    }
}

/// `count` receivers at equal steps through the list, whose order follows squares of the image: one from each stratum.
pub fn spread(receivers: &[Receiver], count: usize) -> Vec<Receiver> {
    places(receivers.len(), count).map(|i| receivers[i]).collect()
}

/// Where [`spread`] finds its receivers in a list of `all`.
pub fn places(all: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(all);
    (0..count).map(move |i| (2 * i + 1) * all / (2 * count))
}
