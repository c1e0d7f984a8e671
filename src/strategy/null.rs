//! Nothing: what does the harness itself cost?

use super::parameters::Arguments;
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::receiver::Receiver;

/// Picks no light.
pub struct Null;

impl Strategy for Null {
    const INFO: Info = Info {
        name: "null",
        summary: "picks nothing: the harness's own cost",
        source: "the harness",
        claim: Claim::Biased("no light is ever picked"),
        role: Role::Floor,
    };
    type Sampler = Self;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, _context: BuildContext<'_>) -> Result<Self> {
        Ok(Self)
    }
}

impl LightSampler for Null {
    type Scratch = ();

    fn sample(&self, _at: &Receiver, _rng: &mut Stream, _scratch: &mut (), _out: &mut Picks<'_>) {}

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        true
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}
