//! Near and strong lights more often: a walk down a tree of clusters, each weighed at the receiver.
//!
//! At a receiver the heaviest clusters are opened first until there are `open` nodes of them, and each walk begins
//! among those. A cluster that seems heavy from afar is thus looked into before it is believed, and one around the
//! receiver is no longer one number: on `downtown` the variance of a pick falls to a fifth, and all passes at a
//! receiver share the work.
//!
//! `importance=box` weighs a cluster by what of its box lies above the receiver's horizon and above its emitters';
//! `importance=classic` is the literature's weight, for comparison. `split` makes several walks where a cluster would be a
//! bad guess. `facing=rms`, with boxes, looks more often at headlights that may face another way: a quarter more error on
//! `downtown`, where few do.

use super::parts::walks::{OPEN, Sampler, Walks};
use crate::base::error::Result;
use crate::strategy::{AnySampler, Arguments, BuildContext, Claim, Info, Strategy};
use crate::tree::{Distance, Facing, How, Weighing};

/// `picks` walks down a tree.
pub(super) struct LightTree {
    arity: usize,
    how: How,
    walks: Walks,
}

impl Strategy for LightTree {
    const INFO: Info = Info {
        name: "light-tree",
        summary: "walks down a tree of clusters, each weighed at the receiver",
        source: "Conty Estevez and Kulla, Proc. ACM CGIT 1(2), 2018; wide nodes, box horizons and peaks: this project",
        claim: Claim::Unbiased,
    };
    type Sampler = Box<dyn AnySampler>;
    const GRID: &'static str = "picks={1,4,16,64},open={16,64}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass; of each cluster, with split")?;
        let arity = arguments.choice("arity", 2, &["2", "4", "8"], "slots of a node")?;
        let weighing = arguments.choice("importance", 0, &["box", "classic"], "how a cluster is weighed")?;
        let distance = arguments.choice("distance", 0, &["mean", "minmax"], "at which distance of its box")?;
        let facing = "emission taken where lights may face any way: mean, or root mean square";
        let facing = arguments.choice("facing", 0, &["mean", "rms"], facing)?;
        let split = "clusters less uniform than this get picks of their own parts; 0 for never";
        let split = arguments.real("split", 0.0, 0.0..=1.0, split)?;
        let cut = arguments.count("cut", 32, 8..=4096, "most clusters with picks of their own, with split")?;
        let open = "nodes of clusters, arity - 1 in each, that walks at a receiver begin among; 0 for the root";
        let open = arguments.count("open", OPEN, 0..=1024, open)?;
        let how = How {
            weighing: [Weighing::Box, Weighing::Classic][weighing],
            distance: [Distance::Mean, Distance::MinMax][distance],
            facing: [Facing::Mean, Facing::Rms][facing],
        };
        Ok(Self { arity: [2, 4, 8][arity], how, walks: Walks { picks, split, cut, open } })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(match self.arity {
            2 => Box::new(Sampler::<2>::new(context, self.how, self.walks)),
            4 => Box::new(Sampler::<4>::new(context, self.how, self.walks)),
            _ => Box::new(Sampler::<8>::new(context, self.how, self.walks)),
        })
    }
}
