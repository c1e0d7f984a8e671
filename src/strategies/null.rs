//! Nothing: what does the harness itself cost?

use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};

/// Picks no light.
pub(super) struct Null;

impl Strategy for Null {
    const INFO: Info = Info {
        name: "null",
        summary: "picks nothing: the harness's own cost",
        source: "the harness",
        claim: Claim::Floor,
    };
    type Sampler = Self;

    fn configure(_arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, _context: BuildContext<'_>) -> Result<Self> {
        Ok(Self)
    }
}

impl LightSampler for Null {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, _draws: &mut Draws, _scratch: &mut (), _out: &mut Picks<'_, T>) {}

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        true
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}
