//! Which clusters stand for all lights around here?
//!
//! A partition serves all receivers of a region: every light of the tree is in one of its elements, those too that seem to add
//! nothing there. The cluster that could send the most to the region's middle, its box grown by the region's, is replaced by the
//! slots of its node until there are enough. By what it is likely to send, which may be far too little, some that matter would
//! stay whole: on metropolis `visible` errs a quarter less this way. At a receiver an element then weighs what it weighs there.
//! The directional lights together are one element.

use super::hierarchy::Tree;
use super::importance::weigh;
use super::memory::Memory;
use super::node::Slot;
use super::walk::Walk;
use crate::base::draws::Draws;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::Tally;
use glam::Vec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Lights that a partition holds together: a slot of a node, or all directional lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Element(u32);

impl Element {
    /// All directional lights.
    pub(crate) const DIRECTIONAL: Self = Self(u32::MAX);
}

/// A node with slots that are elements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divided<const N: usize> {
    node: u32,
    /// Which slots: not the empty ones, nor those that are divided themselves.
    pub(crate) elements: [bool; N],
}

impl<const N: usize> Divided<N> {
    /// The element in a slot.
    #[inline]
    pub(crate) fn element(node: u32, slot: usize) -> Element {
        Element(node * N as u32 + slot as u32)
    }

    pub(crate) fn node(&self) -> u32 {
        self.node
    }
}

/// Receivers with nearly the same normal: one in the middle of their box, and half its extents in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Region {
    pub(crate) middle: Receiver,
    pub(crate) half: Vec3,
}

/// A slot that may be divided.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// The most that it can send, in lx.
    bound: f32,
    /// Its own node.
    node: u32,
    /// The node it is a slot of, by its place in the list, and the slot.
    of: (usize, usize),
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then_with(|| other.node.cmp(&self.node))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl<const N: usize, T: Tally> Walk<'_, N, T> {
    /// A light of an element and its probability there.
    #[inline]
    pub(crate) fn pick_in(&mut self, element: Element, u: f64, draws: &mut Draws) -> Option<(LightId, f64)> {
        if element == Element::DIRECTIONAL {
            return self.tree.pick_directional(u, self.memory);
        }
        let (node, slot) = (element.0 as usize / N, element.0 as usize % N);
        self.pick_slot(node, slot, u, draws)
    }
}

impl<const N: usize> Tree<N> {
    /// Most nodes of a partition that is asked for `most` elements.
    pub(crate) fn most_divided(&self, most: usize) -> usize {
        // Nearly all nodes have more than half of their slots filled.
        (1 + 2 * most / N).min(self.nodes.len())
    }

    /// The light that is alone in an element; none of several.
    #[inline]
    pub(crate) fn light_alone(&self, element: Element) -> Option<LightId> {
        if element == Element::DIRECTIONAL {
            return if let [only] = &self.directional[..] { Some(only.light) } else { None };
        }
        let (node, slot) = (element.0 as usize / N, element.0 as usize % N);
        match self.nodes[node].slot(slot) {
            Slot::Light(light) => Some(light),
            Slot::Node(_) | Slot::Empty => None,
        }
    }

    /// Whether there is any directional light.
    pub(crate) fn has_directional(&self) -> bool {
        !self.directional.is_empty()
    }

    /// Nodes whose slots make up all lights of the tree, `most` elements or those of the root if they are more; the nodes in the
    /// tree's order.
    pub(crate) fn partition<T: Tally>(&self, region: &Region, most: usize, tally: &mut T) -> Vec<Divided<N>> {
        let mut divided = Vec::new();
        let mut open = BinaryHeap::new();
        if self.nodes.is_empty() {
            return divided;
        }
        let mut count = self.divide(0, region, &mut divided, &mut open, tally);
        while let Some(Candidate { bound, node, of: (place, slot) }) = open.pop() {
            if bound <= 0.0 || count + N - 1 > most || divided.len() == self.most_divided(most) {
                break;
            }
            divided[place].elements[slot] = false;
            count += self.divide(node, region, &mut divided, &mut open, tally) - 1;
        }
        divided.sort_unstable_by_key(|divided| divided.node);
        divided
    }

    /// Adds a node and its slots; gives their number.
    fn divide<T: Tally>(
        &self,
        at: u32,
        region: &Region,
        divided: &mut Vec<Divided<N>>,
        open: &mut BinaryHeap<Candidate>,
        tally: &mut T,
    ) -> usize {
        tally.nodes(1);
        tally.weighed(N as u64);
        let node = &self.nodes[at as usize];
        let grown = node.grown(region.half);
        let mut elements = [true; N];
        for (slot, element) in elements.iter_mut().enumerate() {
            match node.slot(slot) {
                Slot::Empty => *element = false,
                Slot::Light(_) => {}
                Slot::Node(offset) => {
                    let bound = grown.upper_bound(slot, &region.middle);
                    open.push(Candidate { bound, node: at + offset, of: (divided.len(), slot) });
                }
            }
        }
        divided.push(Divided { node: at, elements });
        elements.iter().filter(|element| **element).count()
    }

    /// The weights of a node's slots at a receiver, in lx: 0 only where no light of a slot can add anything.
    #[inline]
    pub(crate) fn weights<T: Tally>(&self, node: u32, at: &Receiver, tally: &mut T) -> [f32; N] {
        tally.nodes(1);
        tally.weighed(N as u64);
        let weights = weigh(&self.nodes[node as usize], at, self.how);
        std::array::from_fn(|slot| 0.5 * weights.near[slot] + 0.5 * weights.far[slot])
    }

    /// Adds `scale` times the probabilities of [`Walk::pick_in`] to `counts`.
    pub(crate) fn expect_in(
        &self,
        element: Element,
        at: &Receiver,
        scale: f64,
        memory: &Memory<N>,
        counts: &mut [f32],
    ) {
        if element == Element::DIRECTIONAL {
            return self.expect_directional(scale, memory, counts);
        }
        let (node, slot) = (element.0 as usize / N, element.0 as usize % N);
        self.expect_slot(node, slot, at, scale, counts);
    }
}
