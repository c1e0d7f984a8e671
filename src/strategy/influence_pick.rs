//! The project's own combination: the hierarchy lists the lights in range, a weighted choice picks among them.
//!
//! Biased as [`influence`](super::influence) is, and by the same amount.

use super::influence::Range;
use super::intensity::{draw, expect};
use super::parameters::Arguments;
use super::tally::Tally;
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::visibility::influence::InfluenceTree;
use std::sync::Arc;

/// `picks` independent draws among the lights in range, by what arrives from each.
pub struct InfluencePick {
    range: Range,
    picks: u32,
}

impl Strategy for InfluencePick {
    const INFO: Info = Info {
        name: "influence-pick",
        summary: "picks among the lights in range by what arrives from them",
        source: "the lecture, row 19",
        claim: Claim::Biased("lights out of range are dropped"),
        role: Role::Choosing,
    };
    type Sampler = Sampler;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass")?;
        Ok(Self { picks, range: Range::configure(arguments)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        Ok(Sampler::new(context, &self.range, self.picks))
    }
}

/// [`InfluencePick`] for a scene.
pub struct Sampler {
    scene: Arc<Scene>,
    tree: InfluenceTree,
    picks: u32,
}

/// The lights in range of a receiver that can add anything there, with their weights.
#[derive(Default)]
pub struct Listed {
    lights: Vec<LightId>,
    sums: Cumulative,
}

impl Sampler {
    pub(super) fn new(context: BuildContext<'_>, range: &Range, picks: u32) -> Self {
        Self { scene: Arc::clone(context.stage.scene()), tree: range.tree(context), picks }
    }

    fn list(&self, at: &Receiver, listed: &mut Listed) {
        listed.lights.clear();
        self.tree.list(at.position, &mut listed.lights);
        listed.sums.clear();
        let table = self.scene.lights();
        listed.lights.iter().for_each(|&id| listed.sums.push(importance(&table[id as usize], at)));
    }
}

impl LightSampler for Sampler {
    type Scratch = Listed;

    fn arrive<T: Tally>(&self, at: &Receiver, listed: &mut Listed, tally: &mut T) {
        self.list(at, listed);
        tally.weighed(listed.lights.len() as u64);
    }

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, listed: &mut Listed, out: &mut Picks<'_, T>) {
        draw(&listed.sums, &listed.lights, self.picks, draws, out);
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let mut listed = Listed::default();
        self.list(at, &mut listed);
        expect(&self.scene, &listed.lights, self.picks, at, counts);
        true
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes()
    }
}
