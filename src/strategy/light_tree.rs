//! Near and strong lights more often: a walk down a tree of clusters, each weighed at the receiver.
//!
//! At a receiver the heaviest clusters are opened first until there are `open` nodes of them, and each walk begins
//! among those. A cluster that seems heavy from afar is thus looked into before it is believed, and one around the
//! receiver is no longer one number: on `downtown` the variance of a pick falls to a fifth, and all passes at a
//! receiver share the work.
//!
//! `importance=box` weighs a cluster by what of its box lies above the receiver's horizon and above its emitters';
//! `importance=classic` is the literature's weight, for comparison. `far` cuts walks short, `split` makes several where
//! a cluster would be a bad guess, `mix` makes some of the picks by strength alone. `facing=rms`, with boxes, looks more often
//! at headlights that may face another way: a quarter more error on `downtown`, where few do.

use super::erased::AnySampler;
use super::parameters::Arguments;
use super::tally::{Tally, Uncounted};
use super::tree::Tree;
use super::tree::cut::{Cluster, Cut, Part};
use super::tree::importance::{Distance, Facing, How, Weighing};
use super::tree::walk::{LEAST_SHARE, Memory, USED_UP};
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::discrete::{AliasTable, Cumulative};
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;

/// `picks` walks down a tree.
pub struct LightTree {
    arity: usize,
    how: How,
    walks: Walks,
}

/// Which walks are made in a pass.
#[derive(Clone, Copy)]
struct Walks {
    /// Picks by the whole tree; of each cluster of a cut, if there is one.
    picks: u32,
    /// Clusters less uniform than this are split before anything is drawn, each part to get picks of its own; 0 for
    /// none.
    split: f32,
    /// Most clusters of a cut.
    cut: u32,
    /// Without splits: walks begin among so many clusters, in nodes of `arity - 1`; 0 for the root alone.
    open: u32,
    /// Share of picks made by peak intensity.
    mix: f32,
}

impl Strategy for LightTree {
    const INFO: Info = Info {
        name: "light-tree",
        summary: "walks down a tree of clusters, each weighed at the receiver",
        source: "Conty Estevez and Kulla, Proc. ACM CGIT 1(2), 2018; wide nodes, box horizons and peaks: this project",
        claim: Claim::Unbiased,
        role: Role::Choosing,
    };
    type Sampler = Box<dyn AnySampler>;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass; of each cluster, with split")?;
        let arity = arguments.choice("arity", 2, &["2", "4", "8"], "slots of a node")?;
        let weighing = arguments.choice("importance", 0, &["box", "classic"], "how a cluster is weighed")?;
        let distance = arguments.choice("distance", 0, &["mean", "minmax"], "at which distance of its box")?;
        let facing = "emission taken where lights may face any way: mean, or root mean square";
        let facing = arguments.choice("facing", 0, &["mean", "rms"], facing)?;
        let far = "squared size over squared distance below which a light is chosen by strength at once; 0 for never";
        let far = arguments.real("far", 0.0, 0.0..=1.0, far)?;
        let split = "clusters less uniform than this get picks of their own parts; 0 for never";
        let split = arguments.real("split", 0.0, 0.0..=1.0, split)?;
        let cut = arguments.count("cut", 32, 8..=4096, "most clusters with picks of their own, with split")?;
        let open = arguments.count(
            "open",
            16,
            0..=1024,
            "nodes of clusters, arity - 1 in each, that walks at a receiver begin among; 0 for the root",
        )?;
        let mix = arguments.real("mix", 0.0, 0.0..=0.9, "share of picks made by peak intensity alone")?;
        let how = How {
            weighing: [Weighing::Box, Weighing::Classic][weighing],
            distance: [Distance::Mean, Distance::MinMax][distance],
            facing: [Facing::Mean, Facing::Rms][facing],
            far,
        };
        Ok(Self { arity: [2, 4, 8][arity], how, walks: Walks { picks, split, cut, open, mix } })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(match self.arity {
            2 => Box::new(self.sampler::<2>(context)?),
            4 => Box::new(self.sampler::<4>(context)?),
            _ => Box::new(self.sampler::<8>(context)?),
        })
    }
}

impl LightTree {
    /// The strategy with these parameters, otherwise as it comes.
    pub(super) fn with(parameters: &str) -> Result<Self> {
        Self::configure(&mut Arguments::new(Self::INFO.name, parameters)?)
    }

    /// A sampler of a tree `N` wide, whatever `arity` says.
    pub(super) fn sampler<const N: usize>(&self, context: BuildContext<'_>) -> Result<Sampler<N>> {
        let (scene, lights) = (context.stage.scene(), context.stage.lights());
        let tree = Tree::new(scene, lights, self.how);
        let strong = if self.walks.mix > 0.0 && !tree.is_empty() { Some(Strong::new(scene, &tree)?) } else { None };
        Ok(Sampler { tree, walks: self.walks, strong })
    }
}

/// [`LightTree`] for a scene.
pub struct Sampler<const N: usize> {
    tree: Tree<N>,
    walks: Walks,
    /// `None` where no pick is made by strength.
    strong: Option<Strong>,
}

/// The tree's lights by peak intensity.
struct Strong {
    lights: Vec<LightId>,
    table: AliasTable,
    /// Where each light of the scene stands in the tree's order.
    places: Vec<u32>,
}

impl Strong {
    fn new<const N: usize>(scene: &Scene, tree: &Tree<N>) -> Result<Self> {
        let (lights, peaks): (Vec<LightId>, Vec<f64>) =
            tree.peaks(scene).map(|(light, peak)| (light, f64::from(peak))).unzip();
        let mut places = vec![u32::MAX; scene.lights().len()];
        lights.iter().zip(0..).for_each(|(&light, place)| places[light as usize] = place);
        Ok(Self { table: AliasTable::new(&peaks)?, lights, places })
    }

    /// Probability of a light; 0 of a directional one.
    fn pmf(&self, light: LightId) -> f64 {
        let place = self.places[light as usize];
        if place == u32::MAX { 0.0 } else { f64::from(self.table.pmf(place as usize)) }
    }
}

/// What a worker keeps.
pub struct Scratch<const N: usize> {
    pub(super) memory: Memory<N>,
    cut: Cut,
    /// Weights of the directional lights and of the cut's parts, where a walk begins among them.
    sums: Cumulative,
}

impl<const N: usize> Default for Scratch<N> {
    fn default() -> Self {
        Self { memory: Memory::default(), cut: Cut::default(), sums: Cumulative::default() }
    }
}

impl<const N: usize> LightSampler for Sampler<N> {
    type Scratch = Scratch<N>;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch<N>, tally: &mut T) {
        self.tree.arrive(at, &mut scratch.memory, tally);
        let Scratch { memory, cut, sums } = scratch;
        let Walks { split, open, .. } = self.walks;
        if split > 0.0 {
            // Of clusters that are not uniform, the one of greatest weight first.
            let need = |cluster: &Cluster<'_, N>, weight| if cluster.uniformity(at) < split { weight } else { 0.0 };
            self.tree.cut(at, (self.walks.cut as usize, usize::MAX), need, cut, memory, tally);
        } else if open > 0 {
            // Slots that can add nothing make no cluster: where many are, more nodes are looked into, up to four times.
            let (clusters, openings) = (open as usize * (N - 1) + 1, 4 * open as usize);
            self.tree.cut(at, (clusters, openings), |_, weight| weight, cut, memory, tally);
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
        for j in 0..self.walks.picks {
            if let Some(strong) = &self.strong
                && draws.stream().uniform() < self.walks.mix
            {
                let place = strong.table.pick(draws.choice_bits(j, self.walks.picks));
                let light = strong.lights[place];
                let by_tree = self.chance(place, at, scratch, out.tally);
                out.push(light, self.weight(by_tree, light));
            } else if self.walks.split > 0.0 {
                self.sample_cut(j, at, draws, scratch, out);
            } else if self.walks.open > 0 {
                if let Some((light, pmf)) = self.pick_among(j, at, draws, scratch, out.tally) {
                    out.push(light, self.weight(pmf, light));
                }
            } else {
                let u = draws.choice(j, self.walks.picks);
                if let Some((light, pmf)) = self.tree.pick(at, u, draws, &mut scratch.memory, out.tally) {
                    out.push(light, self.weight(pmf, light));
                }
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let picks = f64::from(self.walks.picks);
        let by_strength = if self.strong.is_some() { f64::from(self.walks.mix) } else { 0.0 };
        let by_tree = picks * (1.0 - by_strength);
        if self.walks.split > 0.0 || self.walks.open > 0 {
            let mut scratch = Scratch::default();
            self.arrive(at, &mut scratch, &mut Uncounted);
            let Scratch { memory, cut, sums } = &scratch;
            // With splits each part has picks of its own; otherwise one of the parts has each pick.
            let share = |i| by_tree * if self.walks.split > 0.0 { 1.0 } else { sums.pmf(i) };
            let mut next = 0;
            for (light, _) in self.tree.directional(memory) {
                counts[light as usize] += share(next) as f32;
                next += 1;
            }
            for (i, &part) in cut.parts().iter().enumerate() {
                self.tree.expect_part(part, at, share(next + i), counts);
            }
        } else {
            self.tree.expect(at, by_tree, counts);
        }
        if let Some(strong) = &self.strong {
            for &light in &strong.lights {
                counts[light as usize] += (picks * by_strength * strong.pmf(light)) as f32;
            }
        }
        true
    }

    fn heap_bytes(&self) -> usize {
        let strong = self.strong.as_ref().map_or(0, |strong| {
            size_of_val(&strong.lights[..]) + strong.table.heap_bytes() + size_of_val(&strong.places[..])
        });
        self.tree.heap_bytes() + strong
    }
}

impl<const N: usize> Sampler<N> {
    pub(super) fn tree(&self) -> &Tree<N> {
        &self.tree
    }

    /// A pick of each part of the cut.
    fn sample_cut<T: Tally>(
        &self,
        j: u32,
        at: &Receiver,
        draws: &mut Draws,
        scratch: &mut Scratch<N>,
        out: &mut Picks<'_, T>,
    ) {
        for (light, _) in self.tree.directional(&scratch.memory) {
            out.push(light, self.weight(1.0, light));
        }
        let of = scratch.cut.parts().len() as u32;
        for i in 0..of {
            let part = scratch.cut.parts()[i as usize];
            let u = draws.choice(j * of + i, self.walks.picks * of);
            if let Some((light, pmf)) = self.tree.pick_part(part, at, u, draws, &mut scratch.memory, out.tally) {
                out.push(light, self.weight(pmf, light));
            }
        }
    }

    /// A light of one of the cut's parts, or a directional one, and its probability.
    #[inline]
    fn pick_among<T: Tally>(
        &self,
        j: u32,
        at: &Receiver,
        draws: &mut Draws,
        scratch: &mut Scratch<N>,
        tally: &mut T,
    ) -> Option<(LightId, f64)> {
        let (index, share, left) = scratch.sums.pick_stretched(draws.choice(j, self.walks.picks))?;
        let first = self.tree.directional(&scratch.memory).count();
        if index < first {
            return self.tree.directional(&scratch.memory).nth(index).map(|(light, _)| (light, share));
        }
        let part = scratch.cut.parts()[index - first];
        let left = if share < USED_UP { draws.stream().uniform64() } else { left };
        let (light, pmf) = self.tree.pick_part(part, at, left, draws, &mut scratch.memory, tally)?;
        Some((light, share * pmf))
    }

    /// How often one walk, or the walks of a cut, give the light in a place of the tree's order.
    fn chance<T: Tally>(&self, place: usize, at: &Receiver, scratch: &mut Scratch<N>, tally: &mut T) -> f64 {
        let Scratch { memory, cut, sums } = scratch;
        if self.walks.split > 0.0 || self.walks.open > 0 {
            let found = self.tree.probability_in_parts(place, at, cut, memory, tally);
            let Some((index, pmf)) = found else { return 0.0 };
            let first = self.tree.directional(memory).count();
            pmf * if self.walks.split > 0.0 { 1.0 } else { sums.pmf(first + index) }
        } else {
            self.tree.probability(place, at, memory, tally)
        }
    }

    /// The weight of a light that the tree gives so often: one over the expected count of its picks, of either sort.
    #[inline]
    fn weight(&self, by_tree: f64, light: LightId) -> f32 {
        let chance = match &self.strong {
            Some(strong) => {
                let mix = f64::from(self.walks.mix);
                (1.0 - mix) * by_tree + mix * strong.pmf(light)
            }
            None => by_tree,
        };
        ((1.0 / (f64::from(self.walks.picks) * chance)) as f32).min(f32::MAX)
    }
}
