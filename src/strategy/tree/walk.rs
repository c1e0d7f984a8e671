//! How is a light chosen, and with which probability?
//!
//! One number chooses at every node: what is left of it within the chosen slot's share is stretched to [0, 1) again.
//! Once its digits are used up, a new one is drawn.

use super::Tree;
use super::importance::{directional, weigh};
use super::node::{Node, Slot};
use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::tally::Tally;

/// Least share of a slot that weighs anything: no light is lost to rounding beside one 10^12 times as strong.
pub(in crate::strategy) const LEAST_SHARE: f64 = 1.0 / 1_073_741_824.0;

/// A number whose slot had this probability or less has no digits to spare.
pub(in crate::strategy) const USED_UP: f64 = 1.0 / 65_536.0;

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
    directional: Cumulative,
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
    ends: [f64; N],
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
    fn pick(&self, u: f64) -> Option<(usize, f64)> {
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
pub(in crate::strategy) const ALMOST_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

impl<const N: usize> Tree<N> {
    /// Comes to a receiver: forgets what was worked out elsewhere.
    pub fn arrive<T: Tally>(&self, at: &Receiver, memory: &mut Memory<N>, tally: &mut T) {
        memory.arrival = memory.arrival.wrapping_add(1);
        if memory.arrival == 0 || memory.kept.is_empty() {
            memory.arrival = 1;
            memory.kept.clear();
            memory.kept.resize(REMEMBERED / N, Kept { node: 0, arrival: 0, shares: Shares { ends: [0.0; N] } });
        }
        self.weigh_directional(at, &mut memory.directional);
        tally.weighed(self.directional.len() as u64);
    }

    /// A light and its probability; none where no light can add anything, or on a way that ended where none can.
    #[inline]
    pub fn pick<T: Tally>(
        &self,
        at: &Receiver,
        u: f64,
        draws: &mut Draws,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> Option<(LightId, f64)> {
        let share = self.directional_share(at, memory, tally);
        if u < share {
            return self.pick_directional(u / share, memory).map(|(light, pmf)| (light, share * pmf));
        }
        if self.nodes.is_empty() {
            return None;
        }
        let left = if 1.0 - share < USED_UP {
            draws.stream().uniform64()
        } else {
            ((u - share) / (1.0 - share)).min(ALMOST_ONE)
        };
        let (light, pmf) = self.pick_below(0, at, left, draws, memory, tally)?;
        Some((light, (1.0 - share) * pmf))
    }

    /// As [`pick`](Self::pick), among the lights of a slot.
    #[inline]
    #[expect(clippy::too_many_arguments, reason = "a slot, a receiver and what a walk needs")]
    pub(super) fn pick_slot<T: Tally>(
        &self,
        node: usize,
        slot: usize,
        at: &Receiver,
        u: f64,
        draws: &mut Draws,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> Option<(LightId, f64)> {
        match self.nodes[node].slot(slot) {
            Slot::Light(light) => Some((light, 1.0)),
            Slot::Node(offset) => self.pick_below(node + offset as usize, at, u, draws, memory, tally),
            Slot::Empty => None,
        }
    }

    /// As [`expect`](Self::expect), of [`pick_slot`](Self::pick_slot).
    pub(super) fn expect_slot(&self, node: usize, slot: usize, at: &Receiver, scale: f64, counts: &mut [f32]) {
        match self.nodes[node].slot(slot) {
            Slot::Light(light) => add(counts, light, scale),
            Slot::Node(offset) => self.expect_below(node + offset as usize, at, scale, counts),
            Slot::Empty => {}
        }
    }

    /// As [`pick`](Self::pick), among the lights of a node.
    #[inline]
    pub(super) fn pick_below<T: Tally>(
        &self,
        node: usize,
        at: &Receiver,
        u: f64,
        draws: &mut Draws,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> Option<(LightId, f64)> {
        // The probability so far, and that since the number was drawn.
        let (mut node, mut u, mut pmf, mut of_number) = (node, u, 1.0, 1.0);
        loop {
            let shares = self.shares(node, at, memory, tally);
            let (j, left) = shares.pick(u)?;
            let share = shares.share(j);
            pmf *= share;
            of_number *= share;
            u = left;
            if of_number < USED_UP {
                (u, of_number) = (draws.stream().uniform64(), 1.0);
            }
            match self.nodes[node].slot(j) {
                Slot::Light(light) => return Some((light, pmf)),
                Slot::Node(offset) => {
                    let far = self.is_far(node, j, at);
                    node += offset as usize;
                    if far {
                        let (light, share) = self.pick_far(&self.nodes[node], u);
                        return Some((light, pmf * share));
                    }
                }
                Slot::Empty => unreachable!("an empty slot weighs nothing"),
            }
        }
    }

    /// Probability that [`pick`](Self::pick) gives the light in that place of the tree's order.
    pub(in crate::strategy) fn probability<T: Tally>(
        &self,
        place: usize,
        at: &Receiver,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> f64 {
        let share = self.directional_share(at, memory, tally);
        (1.0 - share) * self.probability_below(0, place, at, memory, tally)
    }

    /// As [`probability`](Self::probability), of [`pick_below`](Self::pick_below).
    pub(super) fn probability_below<T: Tally>(
        &self,
        node: usize,
        place: usize,
        at: &Receiver,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> f64 {
        let (mut node, mut pmf) = (node, 1.0);
        loop {
            let shares = self.shares(node, at, memory, tally);
            if shares.total() <= 0.0 {
                return 0.0;
            }
            let (j, below) = self.towards(node, place);
            pmf *= shares.share(j);
            let Some(below) = below else { return pmf };
            if self.is_far(node, j, at) {
                return pmf * self.far_share(&self.nodes[below], place);
            }
            node = below;
        }
    }

    /// The slot of a node that holds the light in a place of the tree's order, and its node if it is one.
    pub(super) fn towards(&self, node: usize, place: usize) -> (usize, Option<usize>) {
        let mut end = self.nodes[node].lights().start;
        for j in 0..N {
            let below = match self.nodes[node].slot(j) {
                Slot::Node(offset) => Some(node + offset as usize),
                Slot::Light(_) | Slot::Empty => None,
            };
            end += below.map_or(1, |below| self.nodes[below].lights().len());
            if place < end {
                return (j, below);
            }
        }
        unreachable!("the lights of a node are those of its slots, in order")
    }

    /// Adds `scale` times the probabilities of [`pick`](Self::pick) to `counts`, one a light of the scene.
    pub fn expect(&self, at: &Receiver, scale: f64, counts: &mut [f32]) {
        let mut memory = Memory::default();
        self.arrive(at, &mut memory, &mut crate::strategy::tally::Uncounted);
        let share = self.directional_share(at, &mut memory, &mut crate::strategy::tally::Uncounted);
        self.expect_directional(scale * share, &memory, counts);
        if !self.nodes.is_empty() {
            self.expect_below(0, at, scale * (1.0 - share), counts);
        }
    }

    /// As [`expect`](Self::expect), of [`pick_below`](Self::pick_below).
    pub(super) fn expect_below(&self, node: usize, at: &Receiver, scale: f64, counts: &mut [f32]) {
        let shares = self.work_out(&self.nodes[node], at);
        for j in (0..N).filter(|_| shares.total() > 0.0) {
            let share = scale * shares.share(j);
            if share <= 0.0 {
                continue;
            }
            match self.nodes[node].slot(j) {
                Slot::Light(light) => add(counts, light, share),
                Slot::Node(offset) if self.is_far(node, j, at) => {
                    let below = &self.nodes[node + offset as usize];
                    below.lights().for_each(|place| {
                        add(counts, self.order[place], share * self.far_share(below, place));
                    });
                }
                Slot::Node(offset) => self.expect_below(node + offset as usize, at, share, counts),
                Slot::Empty => unreachable!("an empty slot weighs nothing"),
            }
        }
    }

    /// The directional lights that add something at the receiver that was arrived at, with what they add, in lx.
    pub(in crate::strategy) fn directional(&self, memory: &Memory<N>) -> impl Iterator<Item = (LightId, f32)> {
        let weight = |i| (memory.directional.pmf(i) * memory.directional.total()) as f32;
        self.directional.iter().enumerate().map(move |(i, light)| (light.light, weight(i))).filter(|(_, w)| *w > 0.0)
    }

    /// What they add together, in lx.
    pub(in crate::strategy) fn all_directional(&self, memory: &Memory<N>) -> f32 {
        (memory.directional.total() as f32).min(f32::MAX)
    }

    /// A directional light by what it adds, and its probability among them.
    #[inline]
    pub(super) fn pick_directional(&self, u: f64, memory: &Memory<N>) -> Option<(LightId, f64)> {
        let (index, pmf) = memory.directional.pick(u)?;
        Some((self.directional[index].light, pmf))
    }

    /// Adds `scale` times the probabilities of [`pick_directional`](Self::pick_directional) to `counts`.
    pub(super) fn expect_directional(&self, scale: f64, memory: &Memory<N>, counts: &mut [f32]) {
        for (i, light) in self.directional.iter().enumerate() {
            add(counts, light.light, scale * memory.directional.pmf(i));
        }
    }

    /// Probability that a directional light is chosen, not one of the tree.
    fn directional_share<T: Tally>(&self, at: &Receiver, memory: &mut Memory<N>, tally: &mut T) -> f64 {
        let directional = memory.directional.total();
        if directional <= 0.0 {
            return 0.0;
        }
        let tree = if self.nodes.is_empty() { 0.0 } else { self.shares(0, at, memory, tally).total() };
        let share = directional / (directional + tree);
        if tree > 0.0 { share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE) } else { 1.0 }
    }

    fn weigh_directional(&self, at: &Receiver, sums: &mut Cumulative) {
        let weight = |light: &super::Directional| directional(light.towards, light.strength, at);
        let total: f64 = self.directional.iter().map(|light| f64::from(weight(light))).sum();
        let least = (total * LEAST_SHARE) as f32;
        sums.clear();
        for light in &self.directional {
            let weight = weight(light);
            sums.push(if weight > 0.0 { weight.max(least) } else { 0.0 });
        }
    }

    /// The shares of a node: remembered, or worked out.
    #[inline]
    pub(super) fn shares<'m, T: Tally>(
        &self,
        node: usize,
        at: &Receiver,
        memory: &'m mut Memory<N>,
        tally: &mut T,
    ) -> &'m Shares<N> {
        tally.nodes(1);
        let kept = &mut memory.kept[node % (REMEMBERED / N)];
        if kept.node != node as u32 || kept.arrival != memory.arrival {
            tally.weighed(N as u64);
            *kept = Kept { node: node as u32, arrival: memory.arrival, shares: self.work_out(&self.nodes[node], at) };
        }
        &kept.shares
    }

    #[inline]
    fn work_out(&self, node: &Node<N>, at: &Receiver) -> Shares<N> {
        let weights = weigh(node, at, self.how);
        let sum = |of: &[f32; N]| of.iter().map(|&w| f64::from(w)).sum::<f64>();
        let (near, far) = (sum(&weights.near), sum(&weights.far));
        let mut ends = [0.0; N];
        let mut end = 0.0;
        if far > 0.0 {
            let total = 0.5 * (near + far);
            let (by_near, by_far) = (0.5 * total / near, 0.5 * total / far);
            for ((place, &near), &far) in ends.iter_mut().zip(&weights.near).zip(&weights.far) {
                let weight = f64::from(near) * by_near + f64::from(far) * by_far;
                end += if weight > 0.0 { weight.max(total * LEAST_SHARE) } else { 0.0 };
                *place = end;
            }
        }
        Shares { ends }
    }

    /// Whether a light of that slot is chosen by peak intensity at once.
    #[inline]
    fn is_far(&self, node: usize, j: usize, at: &Receiver) -> bool {
        self.how.far > 0.0 && self.nodes[node].is_far(j, at, self.how.far)
    }

    /// A light of a node by peak intensity, and its probability there.
    fn pick_far(&self, node: &Node<N>, u: f64) -> (LightId, f64) {
        let lights = node.lights();
        let (start, end) = (self.sums[lights.start], self.sums[lights.end]);
        let target = start + ((u * (end - start) as f64) as u64).min(end - start - 1);
        let place = lights.start + self.sums[lights.start + 1..lights.end].partition_point(|&end| end <= target);
        (self.order[place], self.far_share(node, place))
    }

    fn far_share(&self, node: &Node<N>, place: usize) -> f64 {
        let lights = node.lights();
        let weight = |from: usize, to: usize| (self.sums[to] - self.sums[from]) as f64;
        weight(place, place + 1) / weight(lights.start, lights.end)
    }
}

/// Adds a probability; none so small that f32 would make it 0.
fn add(counts: &mut [f32], light: LightId, probability: f64) {
    if probability > 0.0 {
        counts[light as usize] += (probability as f32).max(f32::MIN_POSITIVE);
    }
}
