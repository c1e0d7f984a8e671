//! Picks among the lights in range, by what arrives from each.

use super::range::Range;
use super::weighed::{draw, expect};
use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::strategy::{BuildContext, LightSampler, Picks, Tally};
use crate::visibility::influence_tree::InfluenceTree;
use std::sync::Arc;

/// The hierarchy that lists the lights in range of a receiver, and the number of picks among them.
pub(crate) struct InRange {
    scene: Arc<Scene>,
    tree: InfluenceTree,
    picks: u32,
}

/// The lights in range of a receiver that can add anything there, with their weights.
#[derive(Default)]
pub(crate) struct Listed {
    lights: Vec<LightId>,
    sums: Cumulative,
}

impl InRange {
    pub(in crate::strategies) fn new(context: BuildContext<'_>, range: &Range, picks: u32) -> Self {
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

impl LightSampler for InRange {
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
