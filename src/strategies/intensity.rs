//! Lights by what arrives from them here: the best choice without knowing what is in between.
//!
//! Every light is weighed at every receiver: O(N), the yardstick of what cheaper strategies approximate.

use super::parts::weighed::{draw, expect};
use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};
use std::sync::Arc;

/// `picks` independent draws, each light with a probability in proportion to its unshadowed irradiance.
pub(super) struct Intensity {
    picks: u32,
}

impl Strategy for Intensity {
    const INFO: Info = Info {
        name: "intensity",
        summary: "weighs every light by what arrives from it, nothing in between",
        source: "the lecture, row 18; Shirley, Wang, Zimmerman, ACM TOG 15(1), 1996",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "picks={1,4,16,64}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self { picks: arguments.count("picks", 1, 1..=1024, "lights drawn a pass")? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let stage = context.stage;
        Ok(Sampler { scene: Arc::clone(stage.scene()), lights: stage.lights().to_vec(), picks: self.picks })
    }
}

/// [`Intensity`] for a scene.
pub(super) struct Sampler {
    scene: Arc<Scene>,
    lights: Vec<LightId>,
    picks: u32,
}

impl LightSampler for Sampler {
    type Scratch = Cumulative;

    fn arrive<T: Tally>(&self, at: &Receiver, sums: &mut Cumulative, tally: &mut T) {
        sums.clear();
        tally.weighed(self.lights.len() as u64);
        let table = self.scene.lights();
        self.lights.iter().for_each(|&id| sums.push(importance(&table[id as usize], at)));
    }

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, sums: &mut Cumulative, out: &mut Picks<'_, T>) {
        draw(sums, &self.lights, self.picks, draws, out);
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        expect(&self.scene, &self.lights, self.picks, at, counts);
        true
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(&self.lights[..])
    }
}
