//! Finite lights without the bias: the range at which a light ends is drawn at random.
//!
//! A light's influence radius r0, where it falls under the display's step, becomes `r0 / sqrt(1 - u)`: it reaches a distance
//! d with probability `min(1, (r0/d)^2)` and is weighted by the inverse when it does. What [`influence`](super::influence)
//! drops is thus kept on average, and the same threshold bounds each light's noise instead of its bias. Lists grow with the
//! logarithm of the city's radius.
//!
//! The ranges are drawn once a light and pass, and the hierarchy refitted to them (`pass`); or once a light, receiver and
//! pass, by roulette down a hierarchy (`receiver`). From the lights in range, of which there may be any number, a
//! reservoir of fixed size keeps as many as are to be shaded.

mod pass;
mod receiver;
mod sink;

use super::parts::range::Range;
use crate::base::error::Result;
use crate::strategy::{AnySampler, Arguments, BuildContext, Claim, Info, PerPass, Strategy};

// What `stability` holds to more digits.
#[cfg(feature = "measure")]
pub(crate) use pass::drawn2;

/// Lights with random ranges, `picks` of them shaded.
pub(crate) struct StochasticCull {
    range: Range,
    picks: u32,
    draw: Draw,
}

/// When ranges are drawn.
#[derive(Clone, Copy)]
enum Draw {
    /// Once a light and pass.
    Pass,
    /// Once a light, receiver and pass.
    Receiver,
}

impl Strategy for StochasticCull {
    const INFO: Info = Info {
        name: "stochastic-cull",
        summary: "takes some of the lights in a random range, which on average is the whole scene",
        source: "Tokuyoshi and Harada, JCGT 5(1), 2016; roulette: the same, Comput. Graph. Forum 38(7), 2019",
        claim: Claim::Unbiased,
    };
    type Sampler = Box<dyn AnySampler>;
    const GRID: &'static str = "picks={4,16,64},cutoff={0.5,2,8}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let words = ["pass", "receiver"];
        let draw = arguments.choice("draw", 0, &words, "when ranges are drawn: for each pass, or at each receiver")?;
        let picks = arguments.count("picks", 4, 0..=64, "lights in range that are shaded a pass; 0 for all of them")?;
        Ok(Self { range: Range::configure(arguments)?, picks, draw: [Draw::Pass, Draw::Receiver][draw] })
    }

    fn gives_candidates(&self) -> bool {
        matches!(self.draw, Draw::Receiver)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(match self.draw {
            Draw::Pass => Box::new(PerPass(pass::Sampler::new(context, &self.range, self.picks))),
            Draw::Receiver => Box::new(receiver::Sampler::new(context, &self.range, self.picks)),
        })
    }
}
