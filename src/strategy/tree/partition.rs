//! Which clusters stand for all lights around here?
//!
//! A partition serves all receivers of a region: every light of the tree is in one of its elements, those too that seem to add
//! nothing here. A cluster is weighed with its box grown by the region's, at the region's middle; the heaviest is replaced by its
//! slots until there are enough. The directional lights together are one element.

use super::Tree;
use super::importance::weigh;
use super::node::Slot;
use super::walk::Memory;
use crate::base::draws::Draws;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::tally::Tally;
use glam::Vec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Lights that a partition holds together: a slot of a node, or all directional lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::strategy) struct Element(u32);

impl Element {
    const DIRECTIONAL: Self = Self(u32::MAX);
}

/// An element and its weight around here.
#[derive(Clone, Copy, Debug)]
pub(in crate::strategy) struct Weighed {
    pub(in crate::strategy) element: Element,
    /// In lx.
    pub(in crate::strategy) weight: f32,
    /// Where its lights start in the tree's order: elements are sorted by it.
    first: u32,
    /// Its node, if it can be replaced.
    node: Option<u32>,
}

impl Ord for Weighed {
    fn cmp(&self, other: &Self) -> Ordering {
        self.weight.total_cmp(&other.weight).then_with(|| other.first.cmp(&self.first))
    }
}

impl PartialOrd for Weighed {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Weighed {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Weighed {}

/// Receivers with nearly the same normal: one in the middle of their box, and half its extents in metres.
#[derive(Clone, Copy, Debug)]
pub(in crate::strategy) struct Region {
    pub(in crate::strategy) middle: Receiver,
    pub(in crate::strategy) half: Vec3,
}

impl<const N: usize> Tree<N> {
    /// Most elements of a partition that is asked for `most`: never less than the root's slots and the directional lights.
    pub(in crate::strategy) fn most_elements(&self, most: usize) -> usize {
        most.max(N).min(self.order.len()) + usize::from(!self.directional.is_empty())
    }

    /// All lights as elements, neighbours together, of which there are [`most_elements`](Self::most_elements) at the most.
    ///
    /// Each light of the tree is in one element, whatever its weight: 0 means that nothing of the element can add anything
    /// to a receiver of the region that has the middle one's normal.
    pub(in crate::strategy) fn partition<T: Tally>(
        &self,
        region: &Region,
        most: usize,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> Vec<Weighed> {
        self.arrive(&region.middle, memory, tally);
        let mut settled = Vec::with_capacity(self.most_elements(most));
        let mut open = BinaryHeap::with_capacity(self.most_elements(most));
        if !self.nodes.is_empty() {
            self.divide(0, region, &mut open, tally);
        }
        while let Some(heaviest) = open.pop() {
            match heaviest.node {
                Some(node) if heaviest.weight > 0.0 && settled.len() + open.len() + N <= most => {
                    self.divide(node as usize, region, &mut open, tally);
                }
                _ => settled.push(heaviest),
            }
        }
        settled.sort_unstable_by_key(|weighed| weighed.first);
        if !self.directional.is_empty() {
            let weight = self.directional(memory).map(|(_, weight)| weight).sum();
            settled.push(Weighed { element: Element::DIRECTIONAL, weight, first: u32::MAX, node: None });
        }
        settled
    }

    /// Adds the filled slots of a node.
    fn divide<T: Tally>(&self, at: usize, region: &Region, open: &mut BinaryHeap<Weighed>, tally: &mut T) {
        tally.nodes(1);
        tally.weighed(N as u64);
        let node = &self.nodes[at];
        let weights = weigh(&node.grown(region.half), &region.middle, self.how);
        let mut first = node.lights().start as u32;
        for slot in 0..N {
            let (below, lights) = match node.slot(slot) {
                Slot::Empty => continue,
                Slot::Light(_) => (None, 1),
                Slot::Node(offset) => (Some(at as u32 + offset), self.nodes[at + offset as usize].lights().len()),
            };
            let element = Element((at * N + slot) as u32);
            open.push(Weighed { element, weight: 0.5 * (weights.near[slot] + weights.far[slot]), first, node: below });
            first += lights as u32;
        }
    }

    /// A light of an element and its probability there, at the receiver that `memory` has arrived at.
    #[inline]
    pub(in crate::strategy) fn pick_in<T: Tally>(
        &self,
        element: Element,
        at: &Receiver,
        u: f64,
        draws: &mut Draws,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> Option<(LightId, f64)> {
        if element == Element::DIRECTIONAL {
            return self.pick_directional(u, memory);
        }
        let (node, slot) = (element.0 as usize / N, element.0 as usize % N);
        match self.nodes[node].slot(slot) {
            Slot::Light(light) => Some((light, 1.0)),
            Slot::Node(offset) => self.pick_below(node + offset as usize, at, u, draws, memory, tally),
            Slot::Empty => None,
        }
    }

    /// Adds `scale` times the probabilities of [`pick_in`](Self::pick_in) to `counts`.
    pub(in crate::strategy) fn expect_in(
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
        match self.nodes[node].slot(slot) {
            Slot::Light(light) => counts[light as usize] += scale as f32,
            Slot::Node(offset) => self.expect_below(node + offset as usize, at, scale, counts),
            Slot::Empty => {}
        }
    }
}
