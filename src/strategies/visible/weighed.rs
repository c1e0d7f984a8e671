//! Which cluster is chosen at this receiver?
//!
//! Each by its weight there, nothing in between, times its factor in the table, and by its share of the cell's light. One that
//! weighs nothing can add nothing and is not chosen.
//!
//! Where several are drawn at once, a light that is expected once or more need not be left to chance: it gets a whole number of picks.
//! A lamp needs one, and adds no noise then; a second would show the same. In five cities of 1,000 lights that takes 60 to 90 % of
//! the error of 64 picks away.

use super::learned::{DIRECTIONAL, Row, Table};
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::Tally;
use crate::tree::{ALMOST_ONE, Divided, Element, LEAST_SHARE, Memory, Tree};

/// The chances of all clusters at a receiver.
#[derive(Default)]
pub(super) struct Weighed<const N: usize> {
    rows: Vec<Shares<N>>,
    /// Sums of the shares up to the end of each row.
    ends: Vec<f64>,
    /// Lights with picks of their own, and how many; those are no longer among the shares.
    certain: Vec<(LightId, u32)>,
    /// Picks that are left for the shares.
    left: u32,
}

/// Those in a node's slots: 0 where no light can add anything, or of what is no cluster here.
#[derive(Clone, Copy)]
struct Shares<const N: usize> {
    node: u32,
    shares: [f32; N],
}

impl<const N: usize> Weighed<N> {
    /// Weighs the clusters of a table at the receiver that `memory` has arrived at.
    pub(super) fn weigh<T: Tally>(
        &mut self,
        table: &Table<N>,
        tree: &Tree<N>,
        at: &Receiver,
        memory: &Memory<N>,
        tally: &mut T,
    ) {
        let Self { rows, ends, .. } = self;
        rows.clear();
        rows.reserve(table.rows.len());
        ends.clear();
        ends.reserve(table.rows.len());
        // Slot by slot, so that all slots of a row are added together.
        let mut sums = [0.0; N];
        for Row { node, factors, .. } in &table.rows {
            let weights = match *node {
                DIRECTIONAL => std::array::from_fn(|slot| if slot == 0 { tree.all_directional(memory) } else { 0.0 }),
                node => tree.weights(node, at, tally),
            };
            // Neither factor is infinite: what is no cluster here stays 0.
            let shares = std::array::from_fn(|slot| (weights[slot] * factors[slot]).min(f32::MAX));
            sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += f64::from(share));
            rows.push(Shares { node: *node, shares });
        }
        // As in a node, none is lost to rounding beside one 10^12 times as strong, nor to underflow.
        let sum: f64 = sums.iter().sum();
        let least = ((sum * LEAST_SHARE) as f32).max(f32::MIN_POSITIVE);
        let all = (sum as f32).min(f32::MAX);
        let mut end = 0.0;
        for (Shares { shares, .. }, Row { common, .. }) in rows.iter_mut().zip(&table.rows) {
            for (share, common) in shares.iter_mut().zip(common) {
                *share = if *share > 0.0 { (*share + common * all).max(least).min(f32::MAX) } else { 0.0 };
            }
            end = shares.iter().fold(end, |end, &share| end + f64::from(share));
            ends.push(end);
        }
    }

    /// Takes the lights that are alone in their elements and expected once or more in so many picks from what is drawn: a light
    /// without extent gets one pick, a triangle the nearest whole number. What they leave is for the others, of which some may
    /// be expected once or more then; about as many picks are made in all, a third more at most.
    ///
    /// Source: thresholds as in Fearnhead and Clifford, J. R. Stat. Soc. B 65(4), 2003; whole numbers of points: `allocate`.
    pub(super) fn settle<T: Tally>(
        &mut self,
        picks: u32,
        tree: &Tree<N>,
        is_extended: impl Fn(LightId) -> bool,
        tally: &mut T,
    ) {
        let Self { rows, ends, certain, left } = self;
        certain.clear();
        *left = picks;
        if picks < 2 {
            return;
        }
        // All at once, so that no later receiver needs more.
        certain.reserve(picks as usize);
        let mut total = ends.last().copied().unwrap_or(0.0);
        // Each round takes a pick at least.
        while *left > 0 && total > 0.0 {
            let limit = (total / f64::from(*left)) as f32;
            let before = certain.len();
            for Shares { node, shares } in rows.iter_mut() {
                for (slot, share) in
                    shares.iter_mut().enumerate().filter(|(_, share)| **share >= limit && **share > 0.0)
                {
                    let Some(light) = tree.light_alone(element::<N>(*node, slot)) else { continue };
                    let expected = (*share / limit).round() as u32;
                    let count = if is_extended(light) { expected.clamp(1, picks) } else { 1 };
                    certain.push((light, count));
                    *left = left.saturating_sub(count);
                    *share = 0.0;
                }
            }
            tally.weighed(rows.len() as u64);
            if certain.len() == before {
                break;
            }
            let mut end = 0.0;
            for (place, row) in ends.iter_mut().zip(&*rows) {
                end = row.shares.iter().fold(end, |end, &share| end + f64::from(share));
                *place = end;
            }
            total = end;
        }
        *left = if total > 0.0 { (*left).max(1) } else { 0 };
    }

    /// Lights with picks of their own, and how many each.
    pub(super) fn certain(&self) -> &[(LightId, u32)] {
        &self.certain
    }

    /// Picks by the shares.
    pub(super) fn left(&self) -> u32 {
        self.left
    }

    /// The element that `u` in `[0, 1)` chooses, its probability and what is left of `u`; `None` if nothing can add anything.
    #[inline]
    pub(super) fn pick(&self, u: f64) -> Option<(Element, f64, f64)> {
        let total = *self.ends.last()?;
        if total <= 0.0 {
            return None;
        }
        // Just below the total where rounding would reach it.
        let target = (u * total).min(total.next_down());
        let row = self.ends.partition_point(|&end| end <= target);
        let Shares { node, shares } = &self.rows[row];
        let mut start = if row == 0 { 0.0 } else { self.ends[row - 1] };
        for (slot, share) in shares.iter().map(|&share| f64::from(share)).enumerate() {
            let end = start + share;
            if end > target {
                let left = ((target - start) / share).clamp(0.0, ALMOST_ONE);
                return Some((element::<N>(*node, slot), share / total, left));
            }
            start = end;
        }
        unreachable!("a row ends above the target")
    }

    /// All elements with their probabilities.
    pub(super) fn elements(&self) -> impl Iterator<Item = (Element, f64)> {
        let total = self.ends.last().copied().unwrap_or(0.0);
        self.rows.iter().flat_map(move |Shares { node, shares }| {
            let positive = (0..N).filter(|&slot| shares[slot] > 0.0);
            positive.map(move |slot| (element::<N>(*node, slot), f64::from(shares[slot]) / total))
        })
    }
}

fn element<const N: usize>(node: u32, slot: usize) -> Element {
    if node == DIRECTIONAL { Element::DIRECTIONAL } else { Divided::<N>::element(node, slot) }
}
