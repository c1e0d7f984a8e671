//! How often is each cluster chosen around here?
//!
//! In proportion to the root mean square of what a pick of it brings, shadow included: the probabilities of least variance.
//! It is taken over a few probes: a receiver of the cell, a walk inside the cluster, a point on the light, a shadow ray.
//! Few probes may all be blocked, or all by luck not: a prior, that a cluster is seen in part, counts as half a probe.
//! And a share of all picks goes by what clusters could add with nothing in between, for what no probe has seen.

use crate::base::draws::{Draws, Points, Sequence};
use crate::base::random::RunKey;
use crate::scene::light::Kind;
use crate::scene::receiver::Receiver;
use crate::strategy::Pick;
use crate::strategy::tally::Tally;
use crate::strategy::target::Target;
use crate::strategy::tree::Tree;
use crate::strategy::tree::partition::{Element, Region, Weighed};
use crate::strategy::tree::walk::Memory;
use std::f32::consts::FRAC_1_PI;

/// Root mean square of what is seen of a cluster over the mean of what there is: what is thought of it before any probe.
const SEEN: f64 = 0.3;
/// How many probes that counts for.
const PRIOR: f64 = 0.5;
/// How many probes the weight of a cluster's box counts for.
const BOX: f64 = 0.25;

/// Of picks with nothing in between: shares by what probes found, by the boxes' weights, and to each cluster alike.
const OPEN: [f64; 3] = [0.5, 0.45, 0.05];

/// How tables are learned.
#[derive(Clone, Copy)]
pub(super) struct Lesson {
    /// Most clusters.
    pub(super) cut: usize,
    /// Probes of each.
    pub(super) probes: u32,
    /// Share of picks with nothing in between.
    pub(super) floor: f64,
}

/// Clusters of all lights, each with its probability. Whole numbers, so that probabilities are exact and sum to 1.
pub(super) struct Table(Box<[Entry]>);

/// A cluster.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    /// Sum of the probabilities of those before it, in 2^-32.
    start: u32,
    element: Element,
}

/// What is known of a cluster.
#[derive(Clone, Copy, Default)]
struct Found {
    /// Sum over the probes of what each point adds with nothing in between, over its probability.
    open: f64,
    /// Sum of the squares, of those that are visible.
    seen2: f64,
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
    ) -> Table {
        let elements = school.tree.partition(region, self.cut, memory, tally);
        let mut found = vec![Found::default(); elements.len()];
        if elements.len() > 1 {
            for (i, at) in tried.iter().enumerate() {
                school.tree.arrive(at, memory, tally);
                let mut draws = Sequence::new(RunKey { seed: name, run: 0 }, i as u32, Points::Random).pass(0);
                for (e, (weighed, found)) in elements.iter().zip(&mut found).enumerate() {
                    if weighed.weight <= 0.0 {
                        continue;
                    }
                    // Each cluster at other receivers, in equal steps.
                    for j in (0..self.probes)
                        .filter(|&j| (e + j as usize * tried.len() / self.probes as usize) % tried.len() == i)
                    {
                        let u = (f64::from(j) + draws.stream().uniform64()) / f64::from(self.probes);
                        let (value, visible) = school.probe(weighed.element, at, u, &mut draws, memory, tally);
                        found.open += value;
                        found.seen2 += if visible { value * value } else { 0.0 };
                    }
                }
            }
        }
        self.table(&elements, &found)
    }

    /// Weighs the clusters.
    fn table(&self, elements: &[Weighed], found: &[Found]) -> Table {
        let probes = f64::from(self.probes);
        let boxed = || elements.iter().map(|weighed| f64::from(weighed.weight * FRAC_1_PI));
        let open = || found.iter().zip(boxed()).map(|(found, boxed)| (found.open + BOX * boxed) / (probes + BOX));
        let seen = || {
            let prior = open().map(|open| PRIOR * (SEEN * open).powi(2));
            found.iter().zip(prior).map(|(found, prior)| ((found.seen2 + prior) / (probes + PRIOR)).sqrt())
        };
        let count = elements.len();
        let shares = |total: f64| move |value: f64| if total > 0.0 { value / total } else { 1.0 / count as f64 };
        let (by_boxed, by_open, by_seen) = (shares(boxed().sum()), shares(open().sum()), shares(seen().sum()));
        let mut sum = 0.0;
        let mut entries = Vec::with_capacity(count);
        for (i, ((boxed, open), seen)) in boxed().zip(open()).zip(seen()).enumerate() {
            // One of 2^32 parts is each cluster's own.
            let start = (f64::min(sum, 1.0) * (PARTS - count as u64) as f64) as u64 + i as u64;
            entries.push(Entry { start: start as u32, element: elements[i].element });
            let floor = OPEN[0] * by_open(open) + OPEN[1] * by_boxed(boxed) + OPEN[2] / count as f64;
            sum += (1.0 - self.floor) * by_seen(seen) + self.floor * floor;
        }
        Table(entries.into_boxed_slice())
    }
}

/// What tables are learned of.
#[derive(Clone, Copy)]
pub(super) struct School<'a, const N: usize> {
    pub(super) tree: &'a Tree<N>,
    pub(super) target: &'a Target,
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

/// What the probabilities of a table sum to.
const PARTS: u64 = 1 << 32;

impl Table {
    /// The element that 64 uniform bits choose, its probability, and what is left of them as a number uniform in
    /// `[0, 1)`; `None` if there are no lights.
    #[inline]
    pub(super) fn pick(&self, bits: u64) -> Option<(Element, f64, f64)> {
        let target = (bits >> 32) as u32;
        let index = self.0.partition_point(|entry| entry.start <= target).checked_sub(1)?;
        let width = self.width(index);
        let left = bits - (u64::from(self.0[index].start) << 32);
        let left = (left as f64 / ((width as f64) * PARTS as f64)).min(1.0 - f64::EPSILON / 2.0);
        Some((self.0[index].element, width as f64 / PARTS as f64, left))
    }

    /// All elements with their probabilities.
    pub(super) fn elements(&self) -> impl Iterator<Item = (Element, f64)> {
        (0..self.0.len()).map(|i| (self.0[i].element, self.width(i) as f64 / PARTS as f64))
    }

    /// Probability of an entry, in 2^-32.
    #[inline]
    fn width(&self, index: usize) -> u64 {
        let end = self.0.get(index + 1).map_or(PARTS, |next| u64::from(next.start));
        end - u64::from(self.0[index].start)
    }

    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.0[..])
    }
}
