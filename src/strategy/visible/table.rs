//! How often is each cluster chosen around here?
//!
//! In proportion to the root mean square of what a pick of it brings, shadow included: the probabilities of least variance. A
//! table holds the ratio of that to the cluster's weight with nothing in between, so that a receiver of the cell chooses by its
//! own weights times what the cell has learned: a cluster below its horizon has no chance, a near one has more.
//!
//! Ratios are learned by a few probes: a receiver of the cell, a walk inside the cluster, a point on the light, a shadow ray.
//! Few probes may all be blocked, or all by luck not: a prior, that half of it is seen, counts as one more probe. And no
//! cluster's factor is less than a share of the cell's mean, for what no probe has seen.

use crate::base::draws::{Draws, Points, Sequence};
use crate::base::random::RunKey;
use crate::scene::light::Kind;
use crate::scene::receiver::Receiver;
use crate::strategy::Pick;
use crate::strategy::tally::Tally;
use crate::strategy::target::Target;
use crate::strategy::tree::Tree;
use crate::strategy::tree::partition::{Divided, Element, Region};
use crate::strategy::tree::walk::{ALMOST_ONE, LEAST_SHARE, Memory};
use std::f64::consts::PI;

/// How much is seen of a cluster, as a share of what there is: what is thought of it before any probe.
const SEEN: f64 = 0.5;
/// How many probes that counts for.
const PRIOR: f64 = 1.0;
/// How many probes a cluster's weight counts for, as what there is of it.
const WEIGHT: f64 = 0.25;

/// Most that a cluster's weight is multiplied with: a probe next to its horizon, where it weighs next to nothing, says little of
/// where it weighs more.
const MOST: f64 = 100.0;

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
    rows: Box<[Row<N>]>,
}

/// In place of a node: the row whose first slot is all directional lights.
const DIRECTIONAL: u32 = u32::MAX;

/// The clusters in a node's slots.
#[derive(Clone, Copy)]
struct Row<const N: usize> {
    node: u32,
    /// What their weights are multiplied with; 0 of a slot that is no cluster here.
    factors: [f32; N],
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
                weights.push(tree.all_directional(memory));
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
        for of_receiver in weights.chunks(count.max(1)) {
            let total: f64 = of_receiver.iter().map(|&weight| f64::from(weight)).sum();
            for (cluster, &weight) in clusters.iter_mut().zip(of_receiver).filter(|_| total > 0.0) {
                cluster.share += f64::from(weight) / total;
            }
        }
        Table::new(&nodes, self.factors(&clusters))
    }

    /// What the clusters' weights are to be multiplied with: what is seen of each, over the mean of that, and the floor.
    fn factors(&self, clusters: &[Cluster]) -> impl Iterator<Item = f32> {
        let sums = clusters.iter().fold([0.0; 2], |[seen, all], c| [seen + c.share * c.seen(), all + c.share]);
        let mean = if sums[0] > 0.0 { sums[0] / sums[1] } else { 1.0 };
        let floor = self.floor;
        clusters.iter().map(move |cluster| ((1.0 - floor) * cluster.seen() / mean + floor).min(MOST) as f32)
    }
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
        (nodes + 1) * size_of::<Row<N>>()
    }

    /// The factors are those of the nodes' clusters, in order, and of the directional lights if there are any.
    fn new(nodes: &[Divided<N>], mut factors: impl Iterator<Item = f32>) -> Self {
        let mut next = |is: bool| if is { factors.next().unwrap_or(1.0) } else { 0.0 };
        let row = |divided: &Divided<N>| Row { node: divided.node(), factors: divided.elements.map(&mut next) };
        let mut rows: Vec<Row<N>> = nodes.iter().map(row).collect();
        rows.extend(factors.next().map(|factor| {
            let mut factors = [0.0; N];
            factors[0] = factor;
            Row { node: DIRECTIONAL, factors }
        }));
        Self { rows: rows.into() }
    }

    /// Weighs the clusters at the receiver that `memory` has arrived at.
    pub(super) fn weigh<T: Tally>(
        &self,
        tree: &Tree<N>,
        at: &Receiver,
        memory: &Memory<N>,
        weighed: &mut Weighed<N>,
        tally: &mut T,
    ) {
        let Weighed { rows, ends } = weighed;
        rows.clear();
        rows.reserve(self.rows.len());
        ends.clear();
        ends.reserve(self.rows.len());
        // Slot by slot, so that all slots of a row are added together.
        let mut sums = [0.0; N];
        for Row { node, factors } in &self.rows {
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
        let least = ((sums.iter().sum::<f64>() * LEAST_SHARE) as f32).max(f32::MIN_POSITIVE);
        let mut end = 0.0;
        for Shares { shares, .. } in rows {
            for share in shares.iter_mut() {
                *share = if *share > 0.0 { share.max(least) } else { 0.0 };
            }
            end = shares.iter().fold(end, |end, &share| end + f64::from(share));
            ends.push(end);
        }
    }

    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.rows[..])
    }
}

/// The chances of all clusters at a receiver.
#[derive(Default)]
pub(super) struct Weighed<const N: usize> {
    rows: Vec<Shares<N>>,
    /// Sums of the shares up to the end of each row.
    ends: Vec<f64>,
}

/// Those in a node's slots: 0 where no light can add anything, or of what is no cluster here.
#[derive(Clone, Copy)]
struct Shares<const N: usize> {
    node: u32,
    shares: [f32; N],
}

impl<const N: usize> Weighed<N> {
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
