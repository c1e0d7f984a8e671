//! Walks down a light tree that begin among clusters opened at the receiver.

use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::{BuildContext, LightSampler, Picks, Tally, Uncounted};
use crate::tree::{Cluster, Cut, How, LEAST_SHARE, Memory, Part, Tree, USED_UP};

/// As many nodes are opened at a receiver unless a user says otherwise.
pub(in crate::strategies) const OPEN: u32 = 16;

/// Which walks are made in a pass.
#[derive(Clone, Copy)]
pub(in crate::strategies) struct Walks {
    /// Picks by the whole tree; of each cluster of a cut, if there is one.
    pub(in crate::strategies) picks: u32,
    /// Clusters less uniform than this are split before anything is drawn, each part to get picks of its own; 0 for
    /// none.
    pub(in crate::strategies) split: f32,
    /// Most clusters of a cut, with splits.
    pub(in crate::strategies) cut: u32,
    /// Without splits: walks begin among so many clusters, in nodes of `arity - 1`; 0 for the root alone.
    pub(in crate::strategies) open: u32,
}

/// A tree `N` wide of a scene, and the walks down it.
pub(in crate::strategies) struct Sampler<const N: usize> {
    tree: Tree<N>,
    walks: Walks,
}

/// What a worker keeps.
pub(in crate::strategies) struct Scratch<const N: usize> {
    pub(in crate::strategies) memory: Memory<N>,
    cut: Cut,
    /// Weights of the directional lights and of the cut's parts, where a walk begins among them.
    sums: Cumulative,
}

impl<const N: usize> Default for Scratch<N> {
    fn default() -> Self {
        Self { memory: Memory::default(), cut: Cut::default(), sums: Cumulative::default() }
    }
}

impl<const N: usize> Sampler<N> {
    pub(in crate::strategies) fn new(context: BuildContext<'_>, how: How, walks: Walks) -> Self {
        Self { tree: Tree::new(context.stage.scene(), context.stage.lights(), how), walks }
    }

    pub(in crate::strategies) fn tree(&self) -> &Tree<N> {
        &self.tree
    }

    /// A light of one of the cut's parts, or a directional one, and its probability.
    #[inline]
    fn pick_among<T: Tally>(
        &self,
        u: f64,
        at: &Receiver,
        draws: &mut Draws,
        scratch: &mut Scratch<N>,
        tally: &mut T,
    ) -> Option<(LightId, f64)> {
        let Scratch { memory, cut, sums } = scratch;
        let (index, share, left) = sums.pick_stretched(u)?;
        let first = self.tree.directional(memory).count();
        if index < first {
            return self.tree.directional(memory).nth(index).map(|(light, _)| (light, share));
        }
        let part = cut.parts()[index - first];
        let left = if share < USED_UP { draws.stream().uniform64() } else { left };
        let (light, pmf) = self.tree.walk(at, memory, tally).pick_part(part, left, draws)?;
        Some((light, share * pmf))
    }

    /// The weight of a light that comes with this probability.
    #[inline]
    fn weight(&self, pmf: f64) -> f32 {
        ((1.0 / (f64::from(self.walks.picks) * pmf)) as f32).min(f32::MAX)
    }
}

impl<const N: usize> LightSampler for Sampler<N> {
    type Scratch = Scratch<N>;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch<N>, tally: &mut T) {
        let Scratch { memory, cut, sums } = scratch;
        let Walks { split, open, .. } = self.walks;
        let mut walk = self.tree.walk(at, memory, tally);
        walk.arrive();
        if split > 0.0 {
            // Of clusters that are not uniform, the one of greatest weight first.
            let need = |cluster: &Cluster<'_, N>, weight| if cluster.uniformity(at) < split { weight } else { 0.0 };
            walk.cut((self.walks.cut as usize, usize::MAX), need, cut);
        } else if open > 0 {
            // Slots that can add nothing make no cluster: where many are, more nodes are looked into, up to four times.
            let (clusters, openings) = (open as usize * (N - 1) + 1, 4 * open as usize);
            walk.cut((clusters, openings), |_, weight| weight, cut);
            let directional = || self.tree.directional(memory).map(|(_, weight)| weight);
            let weights = || directional().chain(cut.parts().iter().map(Part::weight));
            // As in a node, no part is lost to rounding beside one 10^12 times as strong.
            let least = (weights().map(f64::from).sum::<f64>() * LEAST_SHARE) as f32;
            sums.clear();
            sums.reserve(directional().count() + clusters + N);
            weights().for_each(|weight| sums.push(weight.max(least)));
        }
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Scratch<N>, out: &mut Picks<'_, T>) {
        let Walks { picks, split, open, .. } = self.walks;
        for j in 0..picks {
            if split > 0.0 {
                let Scratch { memory, cut, .. } = &mut *scratch;
                self.tree.directional(memory).for_each(|(light, _)| out.push(light, self.weight(1.0)));
                let of = cut.parts().len() as u32;
                for (i, &part) in (0..).zip(cut.parts()) {
                    let u = draws.choice(j * of + i, picks * of);
                    let found = self.tree.walk(at, memory, out.tally).pick_part(part, u, draws);
                    found.into_iter().for_each(|(light, pmf)| out.push(light, self.weight(pmf)));
                }
                continue;
            }
            let u = draws.choice(j, picks);
            let found = if open > 0 {
                self.pick_among(u, at, draws, scratch, out.tally)
            } else {
                self.tree.walk(at, &mut scratch.memory, out.tally).pick(u, draws)
            };
            found.into_iter().for_each(|(light, pmf)| out.push(light, self.weight(pmf)));
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let picks = f64::from(self.walks.picks);
        if self.walks.split <= 0.0 && self.walks.open == 0 {
            self.tree.expect(at, picks, counts);
            return true;
        }
        let mut scratch = Scratch::default();
        self.arrive(at, &mut scratch, &mut Uncounted);
        let Scratch { memory, cut, sums } = &scratch;
        // With splits each part has picks of its own; otherwise one of the parts has each pick.
        let share = |i| picks * if self.walks.split > 0.0 { 1.0 } else { sums.pmf(i) };
        let mut next = 0;
        for (light, _) in self.tree.directional(memory) {
            counts[light as usize] += share(next) as f32;
            next += 1;
        }
        for (i, &part) in cut.parts().iter().enumerate() {
            self.tree.expect_part(part, at, share(next + i), counts);
        }
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes()
    }
}
