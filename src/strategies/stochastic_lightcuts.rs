//! A cut through a binary tree of lights, and one light at random from each of its clusters.
//!
//! The cut is found before anything is drawn: from the root, the cluster that could add most is replaced by its halves
//! until there are `cut`. A pick from each stratifies the choice. Down a cluster, the probability of a half is the mean
//! of two, one with its least distance, one with its greatest.
//!
//! Of the sources' pieces these are other ones here: halves are weighed with this project's horizons and cosines, which
//! reject only what adds nothing, so that no branch is dead that should not be; the tree is that of
//! [`light_tree`](super::light_tree), not a perfect one over Morton codes; and each receiver has its own cut, where the
//! real-time version shares one among a block of pixels.

use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally, Uncounted};
use crate::tree::{Cut, Distance, How, Memory, Tree};

/// One pick from each of `cut` clusters.
pub(super) struct StochasticLightcuts {
    cut: u32,
}

impl Strategy for StochasticLightcuts {
    const INFO: Info = Info {
        name: "stochastic-lightcuts",
        summary: "picks a light from each cluster of a cut that is chosen by what clusters could add",
        source: "Yuksel, HPG 2019; Lin and Yuksel, Proc. ACM CGIT 3(1) (I3D), 2020",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "cut={8,32,64,128}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self { cut: arguments.count("cut", 8, 2..=4096, "most clusters of a cut; one light is picked from each")? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let how = How { distance: Distance::MinMax, ..How::default() };
        Ok(Sampler { tree: Tree::new(context.stage.scene(), context.stage.lights(), how), cut: self.cut })
    }
}

/// [`StochasticLightcuts`] for a scene.
pub(super) struct Sampler {
    tree: Tree<2>,
    cut: u32,
}

/// What a worker keeps.
#[derive(Default)]
pub(super) struct Scratch {
    memory: Memory<2>,
    cut: Cut,
}

impl LightSampler for Sampler {
    type Scratch = Scratch;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch, tally: &mut T) {
        let Scratch { memory, cut } = scratch;
        let mut walk = self.tree.walk(at, memory, tally);
        walk.arrive();
        walk.cut((self.cut as usize, usize::MAX), |cluster, _| cluster.bound(at), cut);
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Scratch, out: &mut Picks<'_, T>) {
        let Scratch { memory, cut } = scratch;
        self.tree.directional(memory).for_each(|(light, _)| out.push(light, 1.0));
        let of = cut.parts().len() as u32;
        for (j, &part) in (0..).zip(cut.parts()) {
            let u = draws.choice(j, of);
            if let Some((light, pmf)) = self.tree.walk(at, memory, out.tally).pick_part(part, u, draws) {
                out.push(light, ((1.0 / pmf) as f32).min(f32::MAX));
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut scratch = Scratch::default();
        self.arrive(at, &mut scratch, &mut Uncounted);
        self.tree.directional(&scratch.memory).for_each(|(light, _)| counts[light as usize] += 1.0);
        scratch.cut.parts().iter().for_each(|&part| self.tree.expect_part(part, at, 1.0, counts));
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes()
    }
}
