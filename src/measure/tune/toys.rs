//! Strategies whose error and cost are known.

use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};

/// Nodes that a call visits, of 10 ns, and one light weighed, of 5: with the 5 of the call itself as much as four picks of
/// 60 ns.
const NODES: u64 = 23;

/// Picks the only light `picks` times, with weights off by a sign that a call shares, and one that each pick has.
///
/// The relative variance of a call is `(1 + S)(1 + P / picks) - 1`, its cost `240 + 60 picks` ns. With S = 0.04 and
/// `P (1 + S) = 4 S` their product is least at 4 picks: 18 / 16 times as much at 2 and at 8, 25 / 16 at 1 and at 16.
pub(super) struct Toy {
    picks: u32,
    heavy: u32,
}

/// S.
const SHARED: f32 = 0.04;

impl Strategy for Toy {
    const INFO: Info = Info {
        name: "toy",
        summary: "picks the only light with a random weight",
        source: "a test",
        claim: Claim::Unbiased,
    };
    const GRID: &'static str = "picks={1,2,4,8,16}";
    type Sampler = Sampler;

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass")?;
        Ok(Self { picks, heavy: arguments.count("heavy", 0, 0..=100_000_000, "more nodes of a call")? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let lights = context.stage.lights();
        if lights.len() != 1 {
            let text = format!("toy is for one light; there are {}", lights.len());
            return Err(crate::base::error::Error::Invalid(text));
        }
        Ok(Sampler { light: lights[0], picks: self.picks, heavy: self.heavy.into() })
    }
}

/// [`Toy`] for a scene.
pub(super) struct Sampler {
    light: LightId,
    picks: u32,
    heavy: u64,
}

/// 1 with a sign by chance.
fn sign(stream: &mut Stream) -> f32 {
    if stream.bits() & 1 == 0 { 1.0 } else { -1.0 }
}

impl LightSampler for Sampler {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        out.tally.nodes(NODES + self.heavy);
        out.tally.weighed(1);
        let shared = 1.0 + SHARED.sqrt() * sign(draws.stream());
        for _ in 0..self.picks {
            let own = 1.0 + (4.0 * SHARED / (1.0 + SHARED)).sqrt() * sign(draws.stream());
            out.push(self.light, shared * own / self.picks as f32);
        }
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        counts[self.light as usize] += 1.0;
        true
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

/// The same at every value of `tag`, but for its random numbers.
pub(super) struct Same {
    tag: u32,
}

impl Strategy for Same {
    const INFO: Info = Info {
        name: "same",
        summary: "picks the only light with another random weight",
        source: "a test",
        claim: Claim::Unbiased,
    };
    const GRID: &'static str = "tag={0..11}";
    type Sampler = Tagged;

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self { tag: arguments.count("tag", 0, 0..=100, "names the random numbers")? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Tagged> {
        Ok(Tagged { light: context.stage.lights()[0], tag: self.tag.into() })
    }
}

/// [`Same`] for a scene.
pub(super) struct Tagged {
    light: LightId,
    tag: u64,
}

impl LightSampler for Tagged {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        let mut stream = Stream::keyed(&[self.tag, draws.stream().bits()]);
        // Exponential: now and then far off, as a lamp that is seldom drawn.
        out.push(self.light, -(1.0 - stream.uniform()).ln());
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        counts[self.light as usize] += 1.0;
        true
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}
