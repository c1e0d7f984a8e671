//! What has been worked out at a receiver: the shares of the nodes that passes met there.

use crate::base::discrete::Cumulative;

/// Least share of a slot that weighs anything: no light is lost to rounding beside one 10^12 times as strong.
pub(crate) const LEAST_SHARE: f64 = 1.0 / 1_073_741_824.0;

/// A number whose slot had this probability or less has no digits to spare.
pub(crate) const USED_UP: f64 = 1.0 / 65_536.0;

/// Slots whose shares are remembered, in nodes.
const REMEMBERED: usize = 4096;

/// What has been worked out at the receiver that was arrived at.
///
/// Passes at one receiver meet the same nodes, those near the root each time. A node's shares are kept in the place
/// that its number gives, until another node claims it.
pub struct Memory<const N: usize> {
    arrival: u32,
    kept: Vec<Kept<N>>,
    /// Weights of the directional lights.
    pub(super) directional: Cumulative,
}

#[derive(Clone)]
struct Kept<const N: usize> {
    node: u32,
    arrival: u32,
    shares: Shares<N>,
}

impl<const N: usize> Default for Memory<N> {
    fn default() -> Self {
        Self { arrival: 0, kept: Vec::new(), directional: Cumulative::default() }
    }
}

/// A choice among the slots of a node.
#[derive(Clone)]
pub(super) struct Shares<const N: usize> {
    /// Weights summed up to each slot, in lx.
    pub(super) ends: [f64; N],
}

impl<const N: usize> Shares<N> {
    pub(super) fn total(&self) -> f64 {
        self.ends[N - 1]
    }

    /// Probability of a slot.
    #[inline]
    pub(super) fn share(&self, j: usize) -> f64 {
        let start = if j == 0 { 0.0 } else { self.ends[j - 1] };
        (self.ends[j] - start) / self.total()
    }

    /// The slot that `u` in `[0, 1)` chooses, never one of weight 0, and `u` stretched over it; `None` if all are 0.
    #[inline]
    pub(super) fn pick(&self, u: f64) -> Option<(usize, f64)> {
        let total = self.total();
        if total <= 0.0 {
            return None;
        }
        // Just below the total where rounding would reach it.
        let target = (u * total).min(total.next_down());
        let j = self.ends.iter().map(|&end| usize::from(end <= target)).sum::<usize>();
        let start = if j == 0 { 0.0 } else { self.ends[j - 1] };
        Some((j, ((target - start) / (self.ends[j] - start)).min(ALMOST_ONE)))
    }
}

/// The greatest number below 1.
pub(crate) const ALMOST_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

impl<const N: usize> Memory<N> {
    /// Comes to a receiver: forgets what was worked out elsewhere.
    pub(super) fn arrive(&mut self) {
        self.arrival = self.arrival.wrapping_add(1);
        if self.arrival == 0 || self.kept.is_empty() {
            self.arrival = 1;
            self.kept.clear();
            self.kept.resize(REMEMBERED / N, Kept { node: 0, arrival: 0, shares: Shares { ends: [0.0; N] } });
        }
    }

    /// The shares of a node: remembered, or worked out.
    #[inline]
    pub(super) fn shares(&mut self, node: usize, work_out: impl FnOnce() -> Shares<N>) -> &Shares<N> {
        let kept = &mut self.kept[node % (REMEMBERED / N)];
        if kept.node != node as u32 || kept.arrival != self.arrival {
            *kept = Kept { node: node as u32, arrival: self.arrival, shares: work_out() };
        }
        &kept.shares
    }
}
