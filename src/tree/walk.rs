//! How is a light chosen, and with which probability?
//!
//! One number chooses at every node: what is left of it within the chosen slot's share is stretched to [0, 1) again.
//! Once its digits are used up, a new one is drawn.

use super::hierarchy::{Directional, Tree};
use super::importance::{directional, weigh};
use super::memory::{ALMOST_ONE, LEAST_SHARE, Memory, Shares, USED_UP};
use super::node::{Node, Slot};
use crate::base::draws::Draws;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::{Tally, Uncounted};

/// Walks down a tree at one receiver: what has been worked out there is kept in `memory`, work is counted in `tally`.
pub struct Walk<'w, const N: usize, T> {
    pub(super) tree: &'w Tree<N>,
    pub(super) at: &'w Receiver,
    pub(super) memory: &'w mut Memory<N>,
    pub(super) tally: &'w mut T,
}

impl<const N: usize> Tree<N> {
    /// Walks at a receiver: the first thing to do at another than before, or with a new memory, is to
    /// [arrive](Walk::arrive); picks panic without.
    #[inline]
    pub fn walk<'w, T: Tally>(
        &'w self,
        at: &'w Receiver,
        memory: &'w mut Memory<N>,
        tally: &'w mut T,
    ) -> Walk<'w, N, T> {
        Walk { tree: self, at, memory, tally }
    }
}

impl<const N: usize, T: Tally> Walk<'_, N, T> {
    /// Comes to the receiver: forgets what was worked out elsewhere.
    pub fn arrive(&mut self) {
        self.memory.arrive();
        let Self { tree, at, memory, .. } = self;
        let weight = |light: &Directional| directional(light.towards, light.strength, at);
        let total: f64 = tree.directional.iter().map(|light| f64::from(weight(light))).sum();
        let least = (total * LEAST_SHARE) as f32;
        memory.directional.clear();
        for light in &tree.directional {
            let weight = weight(light);
            memory.directional.push(if weight > 0.0 { weight.max(least) } else { 0.0 });
        }
        self.tally.weighed(tree.directional.len() as u64);
    }

    /// A light and its probability; none where no light can add anything, or on a way that ended where none can.
    #[inline]
    pub fn pick(&mut self, u: f64, draws: &mut Draws) -> Option<(LightId, f64)> {
        let share = self.directional_share();
        if u < share {
            let (light, pmf) = self.tree.pick_directional(u / share, self.memory)?;
            return Some((light, share * pmf));
        }
        if self.tree.nodes.is_empty() {
            return None;
        }
        let left = if 1.0 - share < USED_UP {
            draws.stream().uniform64()
        } else {
            ((u - share) / (1.0 - share)).min(ALMOST_ONE)
        };
        let (light, pmf) = self.pick_below(0, left, draws)?;
        Some((light, (1.0 - share) * pmf))
    }

    /// As [`pick`](Self::pick), among the lights of a slot.
    #[inline]
    pub(super) fn pick_slot(&mut self, node: usize, slot: usize, u: f64, draws: &mut Draws) -> Option<(LightId, f64)> {
        match self.tree.nodes[node].slot(slot) {
            Slot::Light(light) => Some((light, 1.0)),
            Slot::Node(offset) => self.pick_below(node + offset as usize, u, draws),
            Slot::Empty => None,
        }
    }

    /// As [`pick`](Self::pick), among the lights of a node.
    #[inline]
    fn pick_below(&mut self, node: usize, u: f64, draws: &mut Draws) -> Option<(LightId, f64)> {
        // The probability so far, and that since the number was drawn.
        let (mut node, mut u, mut pmf, mut of_number) = (node, u, 1.0, 1.0);
        loop {
            let shares = self.shares(node);
            let (j, left) = shares.pick(u)?;
            let share = shares.share(j);
            pmf *= share;
            of_number *= share;
            u = left;
            if of_number < USED_UP {
                (u, of_number) = (draws.stream().uniform64(), 1.0);
            }
            match self.tree.nodes[node].slot(j) {
                Slot::Light(light) => return Some((light, pmf)),
                Slot::Node(offset) => node += offset as usize,
                Slot::Empty => unreachable!("an empty slot weighs nothing"),
            }
        }
    }

    /// Probability that a directional light is chosen, not one of the tree.
    fn directional_share(&mut self) -> f64 {
        let directional = self.memory.directional.total();
        if directional <= 0.0 {
            return 0.0;
        }
        let tree = if self.tree.nodes.is_empty() { 0.0 } else { self.shares(0).total() };
        let share = directional / (directional + tree);
        if tree > 0.0 { share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE) } else { 1.0 }
    }

    /// The shares of a node: remembered, or worked out.
    #[inline]
    pub(super) fn shares(&mut self, node: usize) -> &Shares<N> {
        let Self { tree, at, memory, tally } = self;
        tally.nodes(1);
        memory.shares(node, || {
            tally.weighed(N as u64);
            tree.work_out(&tree.nodes[node], at)
        })
    }
}

impl<const N: usize> Tree<N> {
    /// Adds `scale` times the probabilities of [`Walk::pick`] to `counts`, one a light of the scene.
    pub fn expect(&self, at: &Receiver, scale: f64, counts: &mut [f32]) {
        let mut memory = Memory::default();
        let mut tally = Uncounted;
        let mut walk = self.walk(at, &mut memory, &mut tally);
        walk.arrive();
        let share = walk.directional_share();
        self.expect_directional(scale * share, &memory, counts);
        if !self.nodes.is_empty() {
            self.expect_below(0, at, scale * (1.0 - share), counts);
        }
    }

    /// As [`expect`](Self::expect), of [`Walk::pick_slot`].
    pub(super) fn expect_slot(&self, node: usize, slot: usize, at: &Receiver, scale: f64, counts: &mut [f32]) {
        match self.nodes[node].slot(slot) {
            Slot::Light(light) => add(counts, light, scale),
            Slot::Node(offset) => self.expect_below(node + offset as usize, at, scale, counts),
            Slot::Empty => {}
        }
    }

    /// As [`expect`](Self::expect), of [`Walk::pick_below`].
    fn expect_below(&self, node: usize, at: &Receiver, scale: f64, counts: &mut [f32]) {
        let shares = self.work_out(&self.nodes[node], at);
        for j in (0..N).filter(|_| shares.total() > 0.0) {
            let share = scale * shares.share(j);
            if share <= 0.0 {
                continue;
            }
            match self.nodes[node].slot(j) {
                Slot::Light(light) => add(counts, light, share),
                Slot::Node(offset) => self.expect_below(node + offset as usize, at, share, counts),
                Slot::Empty => unreachable!("an empty slot weighs nothing"),
            }
        }
    }

    /// The directional lights that add something at the receiver that was arrived at, with what they add, in lx.
    pub(crate) fn directional(&self, memory: &Memory<N>) -> impl Iterator<Item = (LightId, f32)> {
        let weight = |i| (memory.directional.pmf(i) * memory.directional.total()) as f32;
        self.directional.iter().enumerate().map(move |(i, light)| (light.light, weight(i))).filter(|(_, w)| *w > 0.0)
    }

    /// What they add together, in lx.
    pub(crate) fn all_directional(&self, memory: &Memory<N>) -> f32 {
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
}

/// Adds a probability; none so small that f32 would make it 0.
fn add(counts: &mut [f32], light: LightId, probability: f64) {
    if probability > 0.0 {
        counts[light as usize] += (probability as f32).max(f32::MIN_POSITIVE);
    }
}
