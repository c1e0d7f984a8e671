//! All lights in range, none out of range: the lecture's finite lights.
//!
//! Biased: each light that is left out adds less than half a display step, but there are many. In a plane of equal
//! lamps around a receiver that faces them the loss grows with the logarithm of the city's radius and never stops.

use super::parts::range::Range;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};
use crate::visibility::influence_tree::InfluenceTree;

/// Takes every light in range, one point each.
pub(super) struct Influence {
    range: Range,
}

impl Strategy for Influence {
    const INFO: Info = Info {
        name: "influence",
        summary: "takes every light in range, listed by a hierarchy over influence volumes",
        source: "the lecture, rows 16 and 17; Olsson, Billeter, Assarsson, HPG 2012",
        claim: Claim::biased("lights out of range are dropped"),
    };
    type Sampler = Sampler;
    const GRID: &'static str = "cutoff={0.03125,0.125,0.5,2}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self { range: Range::configure(arguments)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        Ok(Sampler { tree: self.range.tree(context) })
    }
}

/// [`Influence`] for a scene.
pub(super) struct Sampler {
    tree: InfluenceTree,
}

impl LightSampler for Sampler {
    /// The list of the receiver arrived at.
    type Scratch = Vec<LightId>;

    fn arrive<T: Tally>(&self, at: &Receiver, list: &mut Vec<LightId>, tally: &mut T) {
        list.clear();
        self.tree.list(at.position, list);
        tally.weighed(list.len() as u64);
    }

    fn sample<T: Tally>(&self, _at: &Receiver, _draws: &mut Draws, list: &mut Vec<LightId>, out: &mut Picks<'_, T>) {
        list.iter().for_each(|&light| out.push(light, 1.0));
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut list = Vec::new();
        self.tree.list(at.position, &mut list);
        list.iter().for_each(|&light| counts[light as usize] += 1.0);
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes()
    }
}
