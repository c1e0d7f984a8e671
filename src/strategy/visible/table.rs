//! How often is each cluster chosen around here?
//!
//! In proportion to the root mean square of what a pick of it brings, shadow included: the probabilities of least variance. A
//! table holds the ratio of that to the cluster's weight with nothing in between, so that a receiver of the cell chooses by its
//! own weights times what the cell has learned: a cluster below its horizon has no chance, a near one has more.
//!
//! Ratios are learned by a few probes: a receiver of the cell, a walk inside the cluster, a point on the light, a shadow ray.
//! Few probes may all be blocked, or all by luck not: a prior, that a cluster is seen in part, counts as half a probe. And a
//! share of all picks goes by the weights alone, for what no probe has seen.

use crate::base::discrete::Cumulative;
use crate::base::draws::{Draws, Points, Sequence};
use crate::base::random::RunKey;
use crate::scene::light::Kind;
use crate::scene::receiver::Receiver;
use crate::strategy::Pick;
use crate::strategy::tally::Tally;
use crate::strategy::target::Target;
use crate::strategy::tree::Tree;
use crate::strategy::tree::partition::{Divided, Element, Region};
use crate::strategy::tree::walk::{LEAST_SHARE, Memory};
use std::f64::consts::PI;

/// Root mean square of what is seen of a cluster over the mean of what there is: what is thought of it before any probe.
const SEEN: f64 = 0.3;
/// How many probes that counts for.
const PRIOR: f64 = 0.5;
/// How many probes a cluster's weight counts for, as what there is of it.
const WEIGHT: f64 = 0.25;

/// How tables are learned.
#[derive(Clone, Copy)]
pub(super) struct Lesson {
    /// Most clusters.
    pub(super) cut: usize,
    /// Probes of each.
    pub(super) probes: u32,
}

/// Clusters of all lights, each with what is seen of it over its weight.
pub(super) struct Table<const N: usize> {
    rows: Box<[Row<N>]>,
    /// Of the directional lights.
    directional: f32,
}

/// The clusters in a node's slots.
#[derive(Clone, Copy)]
pub(super) struct Row<const N: usize> {
    node: u32,
    /// 0 of a slot that is no cluster here.
    ratios: [f32; N],
}

/// What tables are learned of.
#[derive(Clone, Copy)]
pub(super) struct School<'a, const N: usize> {
    pub(super) tree: &'a Tree<N>,
    pub(super) target: &'a Target,
}

impl Lesson {
    /// The table of a region, by probes at some receivers there; `name` names their random numbers.
    pub(super) fn learn<const N: usize, T: Tally>(
        &self,
        school: School<'_, N>,
        region: &Region,
        tried: &[Receiver],
        name: u64,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> Table<N> {
        let tree = school.tree;
        let nodes = tree.partition(region, self.cut, tally);
        let mut clusters: Vec<Cluster> = nodes.iter().flat_map(Cluster::all).collect();
        if tree.has_directional() {
            clusters.push(Cluster::new(Element::DIRECTIONAL));
        }
        // By receiver, then by cluster.
        let mut weights = Vec::with_capacity(tried.len() * clusters.len());
        for at in tried {
            for divided in &nodes {
                let of_slots = tree.weights(divided.node(), at, tally);
                weights.extend(of_slots.iter().zip(divided.elements).filter(|(_, is)| *is).map(|(weight, _)| *weight));
            }
            if tree.has_directional() {
                tree.arrive(at, memory, tally);
                weights.push(tree.directional(memory).map(|(_, weight)| weight).sum());
            }
        }
        let count = clusters.len();
        for (e, cluster) in clusters.iter_mut().enumerate() {
            cluster.lit = weights[e..].iter().step_by(count).filter(|weight| **weight > 0.0).count();
        }
        for (i, at) in tried.iter().enumerate() {
            tree.arrive(at, memory, tally);
            let mut draws = Sequence::new(RunKey { seed: name, run: 0 }, i as u32, Points::Random).pass(0);
            let weights = &weights[i * count..][..count];
            for (e, (cluster, weight)) in clusters.iter_mut().zip(weights).enumerate().filter(|(_, (_, w))| **w > 0.0) {
                for j in cluster.turn(e, self.probes) {
                    let u = (f64::from(j) + draws.stream().uniform64()) / f64::from(self.probes);
                    let (value, visible) = school.probe(cluster.element, at, u, &mut draws, memory, tally);
                    cluster.add(value * PI / f64::from(*weight), visible);
                }
                cluster.met += 1;
            }
        }
        Table::new(&nodes, &clusters)
    }
}

/// A cluster while it is learned of.
#[derive(Clone, Copy)]
struct Cluster {
    element: Element,
    /// Receivers at which it weighs anything: of all, and of those so far.
    lit: usize,
    met: usize,
    /// Sum over the probes of what each point adds with nothing in between, over its probability and the cluster's weight.
    open: f64,
    /// Sum of the squares, of those that are visible.
    seen2: f64,
    made: u32,
}

impl Cluster {
    fn new(element: Element) -> Self {
        Self { element, lit: 0, met: 0, open: 0.0, seen2: 0.0, made: 0 }
    }

    fn all<const N: usize>(of: &Divided<N>) -> impl Iterator<Item = Self> + use<N> {
        let (node, elements) = (of.node(), of.elements);
        (0..N).filter(move |&slot| elements[slot]).map(move |slot| Self::new(Divided::<N>::element(node, slot)))
    }

    /// The probes to make at the next receiver: each cluster at other ones, in equal steps.
    fn turn(&self, number: usize, probes: u32) -> impl Iterator<Item = u32> + use<> {
        let Self { lit, met, .. } = *self;
        (0..probes).filter(move |&j| (number + j as usize * lit / probes as usize) % lit == met)
    }

    fn add(&mut self, open: f64, visible: bool) {
        self.made += 1;
        self.open += open;
        self.seen2 += if visible { open * open } else { 0.0 };
    }

    fn ratio(&self) -> f32 {
        let made = f64::from(self.made);
        let open = (self.open + WEIGHT) / (made + WEIGHT);
        let ratio = ((self.seen2 + PRIOR * (SEEN * open).powi(2)) / (made + PRIOR)).sqrt();
        // A weight may be next to nothing where a point adds much, and the other way round.
        ratio.clamp(1e-6, 1e6) as f32
    }
}

impl<const N: usize> School<'_, N> {
    /// What a point of a light of the element adds at a receiver with nothing in between, over the light's probability
    /// there, and whether it is seen.
    fn probe<T: Tally>(
        self,
        element: Element,
        at: &Receiver,
        u: f64,
        draws: &mut Draws,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) -> (f64, bool) {
        let Some((light, pmf)) = self.tree.pick_in(element, at, u, draws, memory, tally) else { return (0.0, false) };
        let extended = self.target.scene().lights()[light as usize].kind() == Kind::Triangle;
        let uv = if extended { draws.stream().uniform2() } else { [0.0; 2] };
        let (value, visible) = self.target.of_point_seen(&Pick { light, weight: 1.0, uv }, at, tally);
        (f64::from(value) / pmf, visible)
    }
}

impl<const N: usize> Table<N> {
    /// Most bytes of a table of so many nodes.
    pub(super) fn bytes(nodes: usize) -> usize {
        nodes * size_of::<Row<N>>()
    }

    /// `clusters` are those of the nodes, in order, and the directional lights if there are any.
    fn new(nodes: &[Divided<N>], clusters: &[Cluster]) -> Self {
        let mut ratios = clusters.iter().map(Cluster::ratio);
        let mut row = |divided: &Divided<N>| Row {
            node: divided.node(),
            ratios: divided.elements.map(|is| if is { ratios.next().unwrap_or(1.0) } else { 0.0 }),
        };
        Self { rows: nodes.iter().map(&mut row).collect(), directional: ratios.next().unwrap_or(0.0) }
    }

    /// Weighs the clusters at the receiver that `memory` has arrived at; `floor` is the share of picks by their weights
    /// alone.
    pub(super) fn weigh<T: Tally>(
        &self,
        tree: &Tree<N>,
        at: &Receiver,
        floor: f64,
        memory: &Memory<N>,
        weighed: &mut Weighed,
        tally: &mut T,
    ) {
        weighed.clear(N * self.rows.len() + 1);
        for Row { node, ratios } in &self.rows {
            let weights = tree.weights(*node, at, tally);
            for slot in (0..N).filter(|&slot| ratios[slot] > 0.0 && weights[slot] > 0.0) {
                weighed.push(Divided::<N>::element(*node, slot), weights[slot], ratios[slot]);
            }
        }
        let directional: f32 = tree.directional(memory).map(|(_, weight)| weight).sum();
        if directional > 0.0 {
            weighed.push(Element::DIRECTIONAL, directional, self.directional);
        }
        weighed.settle(floor);
    }

    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.rows[..])
    }
}

/// Clusters that can add something at a receiver.
#[derive(Default)]
pub(super) struct Weighed {
    elements: Vec<Element>,
    /// With nothing in between, and what is seen of that.
    weights: Vec<(f32, f32)>,
    sums: Cumulative,
}

impl Weighed {
    fn clear(&mut self, most: usize) {
        self.elements.clear();
        self.elements.reserve(most);
        self.weights.clear();
        self.weights.reserve(most);
        self.sums.clear();
        self.sums.reserve(most);
    }

    #[inline]
    fn push(&mut self, element: Element, weight: f32, ratio: f32) {
        self.elements.push(element);
        self.weights.push((weight, ratio));
    }

    /// Makes probabilities of the weights.
    fn settle(&mut self, floor: f64) {
        let (open, seen) = self.weights.iter().fold((0.0, 0.0), |(open, seen), &(weight, ratio)| {
            (open + f64::from(weight), seen + f64::from(weight) * f64::from(ratio))
        });
        let (by_open, by_seen) = (floor / open, (1.0 - floor) / seen);
        for &(weight, ratio) in &self.weights {
            let share = f64::from(weight) * (by_open + by_seen * f64::from(ratio));
            // As in a node, none is lost to rounding beside one 10^12 times as strong.
            self.sums.push(share.max(LEAST_SHARE) as f32);
        }
    }

    /// The element that `u` chooses, its probability and what is left of `u`; `None` if nothing can add anything.
    #[inline]
    pub(super) fn pick(&self, u: f64) -> Option<(Element, f64, f64)> {
        self.sums.pick_stretched(u).map(|(index, share, left)| (self.elements[index], share, left))
    }

    /// All elements with their probabilities.
    pub(super) fn elements(&self) -> impl Iterator<Item = (Element, f64)> {
        self.elements.iter().enumerate().map(|(index, element)| (*element, self.sums.pmf(index)))
    }
}
