//! Every light: what does no choice at all cost?

use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::light::{Kind, LightId};
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};

/// Takes every light in every pass, one point each: exact after one pass where lights have no extent.
pub(super) struct All;

impl Strategy for All {
    const INFO: Info = Info {
        name: "all",
        summary: "takes every light, one point and one shadow ray each",
        source: "the sum itself",
        claim: Claim::Ceiling,
    };
    type Sampler = Lights;

    fn configure(_arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Lights> {
        let table = context.stage.scene().lights();
        let extended = |light: LightId| table[light as usize].kind() == Kind::Triangle;
        Ok(Lights(context.stage.lights().iter().map(|&light| (light, extended(light))).collect()))
    }
}

/// The lights to take, in table order, and whether each has an extent. Sums come out the same to the last bit whether
/// or not useless lights were left out: the order is kept, and a light's points depend on nothing but the light and the
/// pass.
pub(super) struct Lights(Vec<(LightId, bool)>);

impl LightSampler for Lights {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        for &(light, extended) in &self.0 {
            let uv = if extended { draws.point_of(light) } else { [0.0; 2] };
            out.push_at(light, 1.0, uv);
        }
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        self.0.iter().for_each(|&(light, _)| counts[light as usize] += 1.0);
        true
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(&self.0[..])
    }
}
