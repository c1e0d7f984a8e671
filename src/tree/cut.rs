//! Which clusters stand for all lights here?
//!
//! A cut is a set of clusters and lights that has each light once, less those that can add nothing. It starts with the root's
//! slots; the one that most needs it is replaced by its own slots until none does or there are enough. What needs it is the
//! caller's to say, from the receiver alone: no random number may move a cut that random choices are made in.

use super::hierarchy::Tree;
use super::node::{Node, Slot};
use super::walk::Walk;
use crate::base::draws::Draws;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::Tally;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A cut; its storage is reused from receiver to receiver.
#[derive(Default)]
pub(crate) struct Cut {
    parts: BinaryHeap<Part>,
}

/// A slot of a node that is in a cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    /// How much it needs to be replaced; 0 for not at all.
    need: f32,
    /// Its weight at the receiver, in lx.
    weight: f32,
    node: u32,
    slot: u32,
}

impl Part {
    /// Its weight at the receiver, in lx.
    pub(crate) fn weight(&self) -> f32 {
        self.weight
    }

    fn key(&self) -> (u32, u32) {
        (self.node, self.slot)
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.need.total_cmp(&other.need).then_with(|| other.key().cmp(&self.key()))
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl Cut {
    /// The parts, in an order that depends on the receiver alone.
    pub(crate) fn parts(&self) -> &[Part] {
        self.parts.as_slice()
    }
}

impl<const N: usize, T: Tally> Walk<'_, N, T> {
    /// Works out the cut at the receiver: `most` parts at the most, or the root's slots if those are more, from `openings`
    /// nodes at the most besides the root. `need` is asked for each cluster that is no light alone, with its weight at the
    /// receiver in lx.
    pub(crate) fn cut(
        &mut self,
        (most, openings): (usize, usize),
        need: impl Fn(&Cluster<'_, N>, f32) -> f32,
        cut: &mut Cut,
    ) {
        cut.parts.clear();
        if self.tree.nodes.is_empty() {
            return;
        }
        // All at once, so that no later receiver needs more.
        cut.parts.reserve(most.min(openings.saturating_mul(N - 1)) + N);
        self.open(0, &need, cut);
        let mut opened = 0;
        while opened < openings
            && cut.parts.len() + N - 1 <= most
            && let Some(part) = cut.parts.peek().filter(|part| part.need > 0.0).copied()
            && let Slot::Node(offset) = self.tree.nodes[part.node as usize].slot(part.slot as usize)
        {
            cut.parts.pop();
            opened += 1;
            self.open(part.node as usize + offset as usize, &need, cut);
        }
    }

    /// Adds the slots of a node that can add anything.
    fn open(&mut self, node: usize, need: &impl Fn(&Cluster<'_, N>, f32) -> f32, cut: &mut Cut) {
        let tree = self.tree;
        let shares = self.shares(node);
        if shares.total() <= 0.0 {
            return;
        }
        for slot in (0..N).filter(|&j| shares.share(j) > 0.0) {
            let weight = (shares.share(slot) * shares.total()) as f32;
            let cluster = tree.cluster(node, slot);
            let need = if cluster.node.is_some() { need(&cluster, weight) } else { 0.0 };
            cut.parts.push(Part { need, weight, node: node as u32, slot: slot as u32 });
        }
    }

    /// A light of a part and its probability there.
    #[inline]
    pub(crate) fn pick_part(&mut self, part: Part, u: f64, draws: &mut Draws) -> Option<(LightId, f64)> {
        self.pick_slot(part.node as usize, part.slot as usize, u, draws)
    }
}

impl<const N: usize> Tree<N> {
    fn cluster(&self, node: usize, slot: usize) -> Cluster<'_, N> {
        let parent = &self.nodes[node];
        let node = match parent.slot(slot) {
            Slot::Node(offset) => Some(&self.nodes[node + offset as usize]),
            Slot::Light(_) | Slot::Empty => None,
        };
        Cluster { parent, slot, node }
    }

    /// The filled slots of a node, and what is in each.
    pub(crate) fn clusters(&self, node: usize) -> impl Iterator<Item = (Cluster<'_, N>, Below)> {
        (0..N).filter_map(move |slot| {
            let below = match self.nodes[node].slot(slot) {
                Slot::Light(light) => Below::Light(light),
                Slot::Node(offset) => Below::Node(node + offset as usize),
                Slot::Empty => return None,
            };
            Some((self.cluster(node, slot), below))
        })
    }

    /// Adds `scale` times the probabilities of [`Walk::pick_part`] to `counts`.
    pub(crate) fn expect_part(&self, part: Part, at: &Receiver, scale: f64, counts: &mut [f32]) {
        self.expect_slot(part.node as usize, part.slot as usize, at, scale, counts);
    }
}

/// What a slot holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Below {
    /// A light.
    Light(LightId),
    /// A cluster, by its node.
    Node(usize),
}

/// A filled slot of a node: a cluster, or a light alone.
pub(crate) struct Cluster<'a, const N: usize> {
    parent: &'a Node<N>,
    slot: usize,
    /// Its node; `None` of a light alone.
    node: Option<&'a Node<N>>,
}

impl<const N: usize> Cluster<'_, N> {
    /// How uniform the cluster is at the receiver, from 0 to 1: the criterion of Conty Estevez and Kulla 2018, with the
    /// variance taken relative to the squared mean, so that it has no unit.
    ///
    /// With E and V of the lights' intensities (e) and of 1/d^2 (g), d spread evenly over [a, b]: the variance of the product
    /// is V_e E_g^2 + E_e^2 V_g + V_e V_g. Relative to the squared mean that is `e + g + e g`.
    pub(crate) fn uniformity(&self, at: &Receiver) -> f32 {
        let [near, far] = self.parent.distances(self.slot, at).map(f64::from);
        if near <= 0.0 {
            return 0.0;
        }
        let (e, g) = (f64::from(self.node.map_or(0.0, |node| node.unevenness)), relative_variance(near, far));
        (1.0 + (e + g + e * g).sqrt()).powf(-0.25) as f32
    }

    /// Sum of the luminances of its lights' peak intensities, in cd.
    pub(crate) fn peak(&self) -> f32 {
        self.parent.peak[self.slot]
    }

    /// The most irradiance that it can send, in lx.
    pub(crate) fn bound(&self, at: &Receiver) -> f32 {
        self.parent.upper_bound(self.slot, at)
    }
}

/// Variance of 1/d^2 over its squared mean, for distances d spread evenly over `[near, far]`.
///
/// `E[g^2] - E[g]^2` itself has no correct digit in f32 once a cluster is far.
pub(crate) fn relative_variance(near: f64, far: f64) -> f64 {
    (far - near).powi(2) / (3.0 * near * far)
}
