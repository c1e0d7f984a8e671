//! All lights in range, none out of range: the lecture's finite lights.
//!
//! Biased: each light that is left out adds less than half a display step, but there are many. In a plane of equal
//! lamps around a receiver that faces them the loss grows with the logarithm of the city's radius and never stops.

use super::parameters::Arguments;
use super::tally::Tally;
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::influence::{Cutoff, Transfer};
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::visibility::influence::InfluenceTree;

/// The cut-off as two parameters, shared by the strategies that have one.
pub(super) struct Range {
    steps: f32,
    transfer: Transfer,
}

impl Range {
    pub(super) fn configure(arguments: &mut Arguments) -> Result<Self> {
        let steps =
            arguments.real("cutoff", 0.5, 1e-6..=255.0, "displayed value where a light ends, in steps of 1/255")?;
        let transfer = arguments.choice(
            "transfer",
            0,
            &["linear", "srgb"],
            "the display's curve; srgb makes dark steps 12.92 times smaller",
        )?;
        Ok(Self { steps, transfer: [Transfer::Linear, Transfer::Srgb][transfer] })
    }

    pub(super) fn cutoff(&self, scene: &Scene) -> Cutoff {
        Cutoff::new(scene, self.steps, self.transfer)
    }

    pub(super) fn tree(&self, context: BuildContext<'_>) -> InfluenceTree {
        let scene = context.stage.scene();
        InfluenceTree::new(scene, context.stage.lights(), self.cutoff(scene))
    }
}

/// Takes every light in range, one point each.
pub struct Influence {
    range: Range,
}

impl Strategy for Influence {
    const INFO: Info = Info {
        name: "influence",
        summary: "takes every light in range, listed by a hierarchy over influence volumes",
        source: "the lecture, rows 16 and 17; Olsson, Billeter, Assarsson, HPG 2012",
        claim: Claim::Biased("lights out of range are dropped"),
        role: Role::Choosing,
    };
    type Sampler = Sampler;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        Ok(Self { range: Range::configure(arguments)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        Ok(Sampler { tree: self.range.tree(context) })
    }
}

/// [`Influence`] for a scene.
pub struct Sampler {
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
