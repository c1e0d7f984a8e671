//! Which lights are tested together?

use super::truth::Truth;
use super::unseen::Unseen;

/// Lights expected fewer times than this in all draws share a bin of the weights check; where all together are, there
/// is nothing to test.
const BIN: f64 = 30.0;

/// Parts of the radiance where expected counts cannot be told, lights sorted by what they add, and picks of each in the
/// pilot run: their weights differ, and few would not show by how much.
const PARTS: f64 = 8.0;
const PART: f64 = 200.0;

/// The lights that add something and can be picked, in bins.
///
/// A bin's statistic is the sum of weight times expected count: each pick of an honest light adds 1. Where counts
/// cannot be told it is the sum of weight times contribution, of the very point: resampling may drop points that add
/// nothing, and the weights of a light then sum to the share of it that is seen. It gives a light that is dim beside
/// others a great weight on the rare occasions that it wins against them; only together do the dim ones win often
/// enough to be tested.
pub(super) struct Pool {
    bins: Vec<Bin>,
    /// Of each light; `u32::MAX` is none.
    bin_of: Vec<u32>,
}

/// Lights that are tested together.
#[derive(Clone, Default)]
pub(super) struct Bin {
    /// Expected sum a call, and how much of its variance is left to chance: the mean of 1 - expected count, if told.
    pub(super) expected: f64,
    pub(super) chance: f64,
    /// Variance of what is expected, where the truth knows no better.
    pub(super) uncertain: f64,
    /// One of the lights.
    pub(super) first: u32,
    /// Expected picks in all draws.
    picks: f64,
    /// What may be missing, where expected counts cannot be told.
    pub(super) unseen: Unseen,
    /// The sum over the current call, over the batch before it, and those of the batches before.
    call: f64,
    batch: f64,
    finished: Vec<f64>,
}

impl Bin {
    /// The sums of the batches.
    pub(super) fn batches(&self) -> impl Iterator<Item = f64> + Clone {
        self.finished.iter().copied()
    }
}

impl Pool {
    /// Bins for `draws` calls; `counts` are the expected picks a call, `told` by the sampler or seen in a pilot run.
    pub(super) fn new(truth: &Truth, counts: &[f32], told: bool, draws: f64) -> Self {
        let share = |i: usize| if told { f64::from(counts[i]) } else { truth.lights()[i] };
        let mut order: Vec<usize> = (0..counts.len()).filter(|&i| truth.adds(i) && counts[i] > 0.0).collect();
        order.sort_by(|&a, &b| share(a).total_cmp(&share(b)));
        let mut left: f64 = order.iter().map(|&light| share(light)).sum();
        // What a bin needs of shares and of picks.
        let (part, picks) = if told { (0.0, BIN) } else { (left / PARTS, PART) };
        let mut picks_left = order.iter().map(|&light| f64::from(counts[light]) * draws).sum::<f64>();
        if picks_left < picks {
            order.clear();
        }
        let mut bins: Vec<Bin> = Vec::new();
        let mut bin_of = vec![u32::MAX; counts.len()];
        for light in order {
            let full = bins.last().is_none_or(|bin| bin.expected >= part && bin.picks >= picks);
            // What would not fill another joins the last.
            if bins.is_empty() || full && left >= part && picks_left >= picks {
                bins.push(Bin { first: light as u32, ..Bin::default() });
            }
            let expected = f64::from(counts[light]) * draws;
            (left, picks_left) = (left - share(light), picks_left - expected);
            let at = bins.len() - 1;
            bins[at].picks += expected;
            bins[at].expected += share(light);
            bins[at].chance += share(light) * (1.0 - f64::from(counts[light])).max(0.0);
            bin_of[light] = at as u32;
        }
        for (bin, at) in bins.iter_mut().zip(0..) {
            bin.chance /= bin.expected;
            if !told {
                let truth = truth.sum(|light| bin_of[light] == at);
                bin.uncertain = truth.variance / truth.n as f64;
            }
        }
        Self { bins, bin_of }
    }

    pub(super) fn bins(&self) -> &[Bin] {
        &self.bins
    }

    /// Adds what a pick of a light comes to: weight times expected count or contribution.
    pub(super) fn add(&mut self, light: usize, amount: f64) {
        if let Some(bin) = self.bins.get_mut(self.bin_of[light] as usize) {
            bin.call += amount;
        }
    }

    /// Ends a call, where what each comes to matters.
    pub(super) fn end_call(&mut self) {
        for bin in &mut self.bins {
            let call = std::mem::take(&mut bin.call);
            bin.unseen.add(call);
            bin.batch += call;
        }
    }

    /// Ends a batch.
    pub(super) fn close(&mut self) {
        for bin in &mut self.bins {
            bin.finished.push(std::mem::take(&mut bin.batch) + std::mem::take(&mut bin.call));
        }
    }
}
