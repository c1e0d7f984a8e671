//! The cut-off as parameters, and the hierarchy over influence volumes that it makes.

use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::cutoff::{Cutoff, Transfer};
use crate::strategy::{Arguments, BuildContext};
use crate::visibility::influence_tree::InfluenceTree;

/// The cut-off as two parameters, shared by the strategies that have one.
pub(in crate::strategies) struct Range {
    steps: f32,
    transfer: Transfer,
}

impl Range {
    pub(in crate::strategies) fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
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

    pub(in crate::strategies) fn cutoff(&self, scene: &Scene) -> Cutoff {
        Cutoff::new(scene, self.steps, self.transfer)
    }

    pub(in crate::strategies) fn tree(&self, context: BuildContext<'_>) -> InfluenceTree {
        let scene = context.stage.scene();
        InfluenceTree::new(scene, context.stage.lights(), self.cutoff(scene))
    }
}
