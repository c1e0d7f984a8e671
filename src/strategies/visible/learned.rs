//! What is seen of each cluster around here?
//!
//! A cluster should be chosen in proportion to the root mean square of what a pick of it brings, shadow included: the probabilities
//! of least variance. A table holds the ratio of that to the cluster's weight with nothing in between, so that a receiver of the
//! cell chooses by its own weights times what the cell has learned: a cluster below its horizon has no chance, a near one has
//! more.
//!
//! Ratios are learned by a few probes: a receiver of the cell, a walk inside the cluster, a point on the light, a shadow ray.
//! Few probes may all be blocked, or all by luck not: a prior, that half of it is seen, counts as one more probe. And no
//! cluster's factor is less than a share of the cell's mean, for what no probe has seen.
//!
//! A weight at a receiver may be far too small, where little of a cluster's box is above its horizon but a strong light is there.
//! So some picks go by each cluster's share of all light that is seen in the cell.

use crate::base::draws::{Draws, Points, Sequence};
use crate::base::random::RunKey;
use crate::scene::light::Kind;
use crate::scene::receiver::Receiver;
use crate::strategies::parts::target_function::TargetFunction;
use crate::strategy::{Pick, Tally};
use crate::tree::{Divided, Element, Memory, Region, Tree};
use std::f64::consts::PI;

/// Slots of a node of the tree: those of `light-tree` as it comes. Nodes of four make the same choice on first-night and take a
/// fifth more error x CPU s on downtown.
pub(super) const WIDTH: usize = 8;

/// How much is seen of a cluster, as a share of what there is: what is thought of it before any probe.
const SEEN: f64 = 0.5;
/// How many probes that counts for.
const PRIOR: f64 = 1.0;
/// How many probes a cluster's weight counts for, as what there is of it.
const WEIGHT: f64 = 0.25;

/// Most that a cluster's weight is multiplied with: a probe where it weighs next to nothing says little of where it weighs more.
const MOST: f64 = 1000.0;

/// Picks by the clusters' shares of the cell's light, over those by their weights at the receiver, where `floor` is nothing. A
/// weight may be next to nothing where much arrives, as from a sign that stands out of its facade in a cluster of windows that do
/// not: without these picks a few pixels of downtown have a third of the error.
const COMMON: f64 = 0.2;

/// How tables are learned.
#[derive(Clone, Copy)]
pub(super) struct Lesson {
    /// Most clusters.
    pub(super) cut: usize,
    /// Probes of each.
    pub(super) probes: u32,
    /// About the share of picks by weights alone.
    pub(super) floor: f64,
}

/// Clusters of all lights, each with what is seen of it over its weight.
pub(super) struct Table<const N: usize> {
    pub(super) rows: Box<[Row<N>]>,
}

/// In place of a node: the row whose first slot is all directional lights.
pub(super) const DIRECTIONAL: u32 = u32::MAX;

/// The clusters in a node's slots.
#[derive(Clone, Copy)]
pub(super) struct Row<const N: usize> {
    pub(super) node: u32,
    /// What their weights are multiplied with; 0 of a slot that is no cluster here.
    pub(super) factors: [f32; N],
    /// Their shares of the light of the cell, together [`COMMON`] at most.
    pub(super) common: [f32; N],
}

/// What tables are learned of.
#[derive(Clone, Copy)]
pub(super) struct School<'a, const N: usize> {
    pub(super) tree: &'a Tree<N>,
    pub(super) target: &'a TargetFunction,
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
        let count = clusters.len();
        // By receiver, then by cluster.
        let mut weights = Vec::with_capacity(tried.len() * count);
        tried.iter().for_each(|at| school.weigh(&nodes, at, &mut weights, memory, tally));
        for (e, cluster) in clusters.iter_mut().enumerate() {
            cluster.lit = weights[e..].iter().step_by(count).filter(|weight| **weight > 0.0).count();
        }
        let mut seen = Vec::new();
        for (i, at) in tried.iter().enumerate() {
            tree.walk(at, memory, tally).arrive();
            let mut draws = Sequence::new(RunKey { seed: name, run: 0 }, i as u32, Points::Random).pass(0);
            let weights = &weights[i * count..][..count];
            for (e, (cluster, weight)) in clusters.iter_mut().zip(weights).enumerate().filter(|(_, (_, w))| **w > 0.0) {
                for j in cluster.turn(e, self.probes) {
                    let u = (f64::from(j) + draws.stream().uniform64()) / f64::from(self.probes);
                    let (value, visible) = school.probe(cluster.element, at, u, &mut draws, memory, tally);
                    cluster.add(value * PI / f64::from(*weight), visible);
                    if visible {
                        seen.push(Seen { cluster: e, receiver: i, value: value * PI });
                    }
                }
                cluster.met += 1;
            }
        }
        for of_receiver in weights.chunks(count.max(1)) {
            let total: f64 = of_receiver.iter().map(|&weight| f64::from(weight)).sum();
            for (cluster, &weight) in clusters.iter_mut().zip(of_receiver).filter(|_| total > 0.0) {
                cluster.share += f64::from(weight) / total;
            }
        }
        let factors: Vec<f32> = self.factors(&clusters).collect();
        let common = self.common(&clusters, &factors, &weights, &seen);
        Table::new(&nodes, factors.into_iter().zip(common))
    }

    /// What the clusters' weights are to be multiplied with: what is seen of each, over the mean of that, and the floor.
    fn factors(&self, clusters: &[Cluster]) -> impl Iterator<Item = f32> {
        let sums = clusters.iter().fold([0.0; 2], |[seen, all], c| [seen + c.share * c.seen(), all + c.share]);
        let mean = if sums[0] > 0.0 { sums[0] / sums[1] } else { 1.0 };
        let floor = self.floor;
        clusters.iter().map(move |cluster| ((1.0 - floor) * cluster.seen() / mean + floor).min(MOST) as f32)
    }

    /// The clusters' shares of the light of the cell: root mean squares of what is seen of each at a receiver, over all that is
    /// seen there.
    fn common(&self, clusters: &[Cluster], factors: &[f32], weights: &[f32], seen: &[Seen]) -> Vec<f32> {
        let total = |of: &[f32]| of.iter().zip(factors).map(|(&w, &f)| f64::from(w) * f64::from(f)).sum::<f64>();
        let totals: Vec<f64> = weights.chunks(clusters.len().max(1)).map(total).collect();
        let mut shares = vec![0.0; clusters.len()];
        for &Seen { cluster, receiver, value } in seen {
            shares[cluster] += (value / totals[receiver]).powi(2);
        }
        shares.iter_mut().zip(clusters).for_each(|(share, of)| *share = (*share / f64::from(of.made.max(1))).sqrt());
        let sum: f64 = shares.iter().sum();
        let scale = if sum > 0.0 { (1.0 - self.floor) * COMMON / sum } else { 0.0 };
        shares.into_iter().map(|share| (scale * share) as f32).collect()
    }
}

/// What a probe has seen.
struct Seen {
    cluster: usize,
    receiver: usize,
    /// What the point adds over its probability, in lx.
    value: f64,
}

/// A cluster while it is learned of.
#[derive(Clone, Copy)]
struct Cluster {
    element: Element,
    /// Receivers at which it weighs anything: of all, and of those so far.
    lit: usize,
    met: usize,
    /// Its share of the weights at a receiver, summed over the receivers.
    share: f64,
    /// Sum over the probes of the square of what each point adds with nothing in between, over its probability and the
    /// cluster's weight.
    open2: f64,
    /// The same of those that are visible.
    seen2: f64,
    made: u32,
}

impl Cluster {
    fn new(element: Element) -> Self {
        Self { element, lit: 0, met: 0, share: 0.0, open2: 0.0, seen2: 0.0, made: 0 }
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
        self.open2 += open * open;
        self.seen2 += if visible { open * open } else { 0.0 };
    }

    /// Root mean square, over what it weighs, of what its points add with nothing in between.
    fn open(&self) -> f64 {
        // A weight may be next to nothing where a point adds much, and the other way round.
        ((self.open2 + WEIGHT) / (f64::from(self.made) + WEIGHT)).sqrt().clamp(1e-6, 1e6)
    }

    /// The same with what is in between.
    fn seen(&self) -> f64 {
        let thought = SEEN * self.open();
        ((self.seen2 + PRIOR * thought * thought) / (f64::from(self.made) + PRIOR)).sqrt()
    }
}

impl<const N: usize> School<'_, N> {
    /// Appends the weights of all clusters at a receiver.
    fn weigh<T: Tally>(
        self,
        nodes: &[Divided<N>],
        at: &Receiver,
        weights: &mut Vec<f32>,
        memory: &mut Memory<N>,
        tally: &mut T,
    ) {
        for divided in nodes {
            let of_slots = self.tree.weights(divided.node(), at, tally);
            weights.extend(of_slots.iter().zip(divided.elements).filter(|(_, is)| *is).map(|(weight, _)| *weight));
        }
        if self.tree.has_directional() {
            self.tree.walk(at, memory, tally).arrive();
            weights.push(self.tree.all_directional(memory));
        }
    }

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
        let picked = self.tree.walk(at, memory, tally).pick_in(element, u, draws);
        let Some((light, pmf)) = picked else { return (0.0, false) };
        let extended = self.target.scene().lights()[light as usize].kind() == Kind::Triangle;
        let uv = if extended { draws.stream().uniform2() } else { [0.0; 2] };
        let (value, visible) = self.target.of_point_seen(&Pick { light, weight: 1.0, uv }, at, tally);
        (f64::from(value) / pmf, visible)
    }
}

impl<const N: usize> Table<N> {
    /// Most bytes of a table of so many nodes.
    pub(super) fn bytes(nodes: usize) -> usize {
        (nodes + 1) * size_of::<Row<N>>()
    }

    /// What was learned are the factors and shares of the nodes' clusters, in order, and of the directional lights if there are
    /// any.
    fn new(nodes: &[Divided<N>], mut learned: impl Iterator<Item = (f32, f32)>) -> Self {
        let mut next = |is: bool| if is { learned.next().unwrap_or((1.0, 0.0)) } else { (0.0, 0.0) };
        let row = |divided: &Divided<N>| {
            let both = divided.elements.map(&mut next);
            Row { node: divided.node(), factors: both.map(|of| of.0), common: both.map(|of| of.1) }
        };
        let mut rows: Vec<Row<N>> = nodes.iter().map(row).collect();
        rows.extend(learned.next().map(|both| {
            let (mut factors, mut common) = ([0.0; N], [0.0; N]);
            (factors[0], common[0]) = both;
            Row { node: DIRECTIONAL, factors, common }
        }));
        Self { rows: rows.into() }
    }

    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.rows[..])
    }
}

#[cfg(test)]
mod tests {
    use super::{Cluster, Lesson};
    use crate::tree::Element;

    #[test]
    fn a_cluster_tried_where_it_weighs_next_to_nothing_does_not_take_all_picks_elsewhere() {
        let lesson = Lesson { cut: 2, probes: 4, floor: 0.25 };
        let mut plain = Cluster { share: 1.0, ..Cluster::new(Element::DIRECTIONAL) };
        plain.add(1.0, true);
        let mut faint = Cluster { share: 1e-38, ..plain };
        faint.add(1e40, true);
        let factors: Vec<f64> = lesson.factors(&[plain, faint]).map(f64::from).collect();
        assert!(factors.iter().all(|factor| (lesson.floor..=1e4).contains(factor)), "{factors:?}");
    }
}
