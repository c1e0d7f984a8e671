//! Ranges drawn at each receiver: roulette down a hierarchy, no list and no state of a pass.

use super::sink::Sink;
use crate::base::draws::Draws;
use crate::scene::Scene;
use crate::scene::receiver::Receiver;
use crate::strategies::parts::range::Range;
use crate::strategies::parts::reservoir::Reservoir;
use crate::strategy::{BuildContext, LightSampler, Picks, Tally};
use crate::visibility::russian_roulette::{RussianRoulette, Stack};
use std::sync::Arc;

/// The strategy for a scene.
pub(super) struct Sampler {
    scene: Arc<Scene>,
    roulette: RussianRoulette,
    picks: u32,
}

impl Sampler {
    pub(super) fn new(context: BuildContext<'_>, range: &Range, picks: u32) -> Self {
        let scene = Arc::clone(context.stage.scene());
        let roulette = RussianRoulette::new(&scene, context.stage.lights(), range.cutoff(&scene));
        Self { roulette, scene, picks }
    }
}

impl LightSampler for Sampler {
    type Scratch = (Reservoir, Stack);

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Self::Scratch, out: &mut Picks<'_, T>) {
        let (reservoir, stack) = scratch;
        let mut sink = Sink::new(&self.scene, at, self.picks, reservoir, out);
        // Of its own, so that the reservoir's numbers do not interleave with the roulette's.
        let mut rng = draws.stream().split();
        let see = |light, chance| sink.take(light, chance, draws.stream());
        let nodes = self.roulette.survivors(at.position, &mut rng, stack, see);
        sink.out.tally.nodes(nodes);
        sink.finish();
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        if self.picks == 0 {
            self.roulette.chances(at.position).for_each(|(light, chance)| counts[light as usize] += chance);
        }
        self.picks == 0
    }

    fn heap_bytes(&self) -> usize {
        self.roulette.heap_bytes()
    }
}
