//! Ranges drawn once a light and pass: one refit of the hierarchy serves all receivers.
//!
//! Neighbouring receivers see the same ranges, so that a pass errs in rings around lights rather than in grains. Over passes the
//! ranges of each light are spread as [`Points`](crate::base::draws::Points) say.

use super::sink::Sink;
use crate::base::draws::{Draws, Sequence};
use crate::base::random::{RunKey, hash};
use crate::scene::Scene;
use crate::scene::cutoff::Influence;
use crate::scene::receiver::Receiver;
use crate::strategies::parts::range::Range;
use crate::strategies::parts::reservoir::Reservoir;
use crate::strategy::{BuildContext, Frame, FrameSampler, LightSampler, Picks, Tally};
use crate::visibility::influence_tree::InfluenceTree;
use crate::visibility::russian_roulette::chance;
use std::sync::Arc;

/// The strategy for a scene.
pub(super) struct Sampler {
    scene: Arc<Scene>,
    /// Over the ranges at u = 0.
    tree: InfluenceTree,
    /// Their squares by light, in m^2.
    least2: Vec<f32>,
    longest2: f32,
    picks: u32,
}

impl Sampler {
    pub(super) fn new(context: BuildContext<'_>, range: &Range, picks: u32) -> Self {
        let scene = Arc::clone(context.stage.scene());
        let tree = range.tree(context);
        let mut least2 = vec![0.0; scene.lights().len()];
        tree.lights().for_each(|(volume, light)| least2[light as usize] = volume.radius2);
        Self { tree, least2, longest2: range.cutoff(&scene).longest2(), scene, picks }
    }
}

impl FrameSampler for Sampler {
    type Pass<'a> = Pass<'a>;

    fn begin<'a>(&'a self, frame: Frame<'a>, pass: u32) -> Pass<'a> {
        // Streams of their own, or light 7's range would go with what is drawn at pixel 7.
        let key = RunKey { seed: hash(&[frame.key.seed, u64::from_le_bytes(*b"lightrng")]), ..frame.key };
        let tree = self.tree.resized(|volume, light| {
            let u = Sequence::new(key, light, frame.points).pass(pass).choice(0, 1);
            drawn2(volume.radius2, u, self.longest2)
        });
        Pass { sampler: self, tree }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        if self.picks == 0 {
            for (light, chance) in self.tree.lights().map(|(volume, light)| (light, chance(volume, at.position))) {
                counts[light as usize] += chance;
            }
            self.tree.everywhere().iter().for_each(|&light| counts[light as usize] += 1.0);
        }
        self.picks == 0
    }

    fn heap_bytes(&self) -> usize {
        // The hierarchy of the ranges in use is as large again.
        2 * self.tree.heap_bytes() + size_of_val(&self.least2[..])
    }
}

/// One pass.
pub(super) struct Pass<'a> {
    sampler: &'a Sampler,
    /// Over the ranges of this pass.
    tree: InfluenceTree,
}

impl LightSampler for Pass<'_> {
    type Scratch = Reservoir;

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, reservoir: &mut Reservoir, out: &mut Picks<'_, T>) {
        let Sampler { scene, least2, picks, .. } = self.sampler;
        let mut sink = Sink::new(scene, at, *picks, reservoir, out);
        self.tree.everywhere().iter().for_each(|&light| sink.take(light, 1.0, draws.stream()));
        let nodes = self.tree.visit(at.position, |volume, light| {
            let least = Influence { radius2: least2[light as usize], ..*volume };
            sink.take(light, chance(&least, at.position), draws.stream());
        });
        sink.out.tally.nodes(nodes);
        sink.finish();
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        self.sampler.expected_counts(at, counts)
    }

    fn heap_bytes(&self) -> usize {
        self.tree.heap_bytes()
    }
}

/// The square of the range that `u` in `[0, 1)` draws, from that at 0 up to the longest; in m^2.
#[inline]
pub(crate) fn drawn2(least2: f32, u: f64, longest2: f32) -> f32 {
    // 1 - u is never 0: a range by 1 / u would be infinite once in 2^24 draws of f32.
    ((f64::from(least2) / (1.0 - u)) as f32).min(longest2)
}
