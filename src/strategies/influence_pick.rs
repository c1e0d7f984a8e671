//! The project's own combination: the hierarchy lists the lights in range, a weighted choice picks among them.
//!
//! Biased as [`influence`](super::influence) is, and by the same amount.

use super::parts::in_range::InRange;
use super::parts::range::Range;
use crate::base::error::Result;
use crate::strategy::{Arguments, BuildContext, Claim, Info, Strategy};

/// `picks` independent draws among the lights in range, by what arrives from each.
pub(super) struct InfluencePick {
    range: Range,
    picks: u32,
}

impl Strategy for InfluencePick {
    const INFO: Info = Info {
        name: "influence-pick",
        summary: "picks among the lights in range by what arrives from them",
        source: "the lecture, row 19",
        claim: Claim::biased("lights out of range are dropped"),
    };
    type Sampler = InRange;
    const GRID: &'static str = "picks={1,2,4,8},cutoff={0.03125,0.125,0.5}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass")?;
        Ok(Self { picks, range: Range::configure(arguments)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<InRange> {
        Ok(InRange::new(context, &self.range, self.picks))
    }
}
