//! Every light: what does no choice at all cost?

use super::parameters::Arguments;
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::error::Result;
use crate::base::random::{Stream, scattered};
use crate::scene::light::{Kind, LightId};
use crate::scene::receiver::Receiver;

/// Takes every light in every pass, one point each: exact after one pass where lights have no extent.
pub struct All;

impl Strategy for All {
    const INFO: Info = Info {
        name: "all",
        summary: "takes every light, one point and one shadow ray each",
        source: "the sum itself",
        claim: Claim::Unbiased,
        role: Role::Ceiling,
    };
    type Sampler = Lights;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Lights> {
        let stage = context.stage;
        Ok(Lights { lights: stage.lights().to_vec(), points: stage.needs().has(Kind::Triangle) })
    }
}

/// The lights to take, in table order: sums then come out the same whether or not useless lights were left out.
pub struct Lights {
    lights: Vec<LightId>,
    /// Whether any light has an extent.
    points: bool,
}

impl LightSampler for Lights {
    type Scratch = ();

    fn sample(&self, _at: &Receiver, rng: &mut Stream, _scratch: &mut (), out: &mut Picks<'_>) {
        if self.points {
            // Points that belong to a light and not to its place in the list: they too are then the same whether or
            // not useless lights were left out.
            let salt = rng.bits();
            self.lights.iter().for_each(|&light| out.push_at(light, 1.0, scattered(salt, light)));
        } else {
            self.lights.iter().for_each(|&light| out.push(light, 1.0));
        }
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        self.lights.iter().for_each(|&light| counts[light as usize] += 1.0);
        true
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(&self.lights[..])
    }
}
