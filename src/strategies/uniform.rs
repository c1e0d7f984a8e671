//! Any light with the same chance.

use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::random::below;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};

/// `picks` independent draws, each light with probability 1/N.
pub(super) struct Uniform {
    picks: u32,
}

impl Strategy for Uniform {
    const INFO: Info = Info {
        name: "uniform",
        summary: "picks any light with the same chance",
        source: "Shirley, Wang, Zimmerman, ACM TOG 15(1), 1996",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "picks={1,4,16,64}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self { picks: arguments.count("picks", 1, 1..=1024, "lights drawn a pass")? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let lights = context.stage.lights().to_vec();
        Ok(Sampler { weight: lights.len() as f32 / self.picks as f32, picks: self.picks, lights })
    }
}

/// [`Uniform`] for a scene.
pub(super) struct Sampler {
    lights: Vec<LightId>,
    picks: u32,
    weight: f32,
}

impl LightSampler for Sampler {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        if self.lights.is_empty() {
            return;
        }
        for j in 0..self.picks {
            let bits = draws.choice_bits(j, self.picks);
            out.push(self.lights[below(bits, self.lights.len())], self.weight);
        }
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        self.lights.iter().for_each(|&light| counts[light as usize] += 1.0 / self.weight);
        true
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(&self.lights[..])
    }
}
