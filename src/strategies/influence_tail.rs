//! The combination made unbiased: lights out of range keep an exactly accounted chance.
//!
//! Besides the weighted picks among the lights in range, `tail` draws over all lights. One that turns out to be in
//! range is dropped, since the first part already stands for it; any other is weighted by its own probability. So each
//! light is covered by exactly one of the two parts, and the sum of both is the whole.
//!
//! The draws go by the influence radius r, not by flux (r^2). Out of range a light adds `T (r/d)^2`; over receivers
//! spread in a plane the mean of its square is in proportion to r^2, so that the probability of least variance is in
//! proportion to r: the second moment is `(sum r)^2` against `n sum r^2` for flux, the more so the more unequal the
//! lights are.

use super::parts::in_range::{InRange, Listed};
use super::parts::light_table::LightTable;
use super::parts::range::Range;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::Scene;
use crate::scene::cutoff::Cutoff;
use crate::scene::light::{Light, LightId};
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};
use std::sync::Arc;

/// `picks` weighted draws in range and `tail` draws by influence radius out of it.
pub(super) struct InfluenceTail {
    range: Range,
    picks: u32,
    tail: u32,
}

impl Strategy for InfluenceTail {
    const INFO: Info = Info {
        name: "influence-tail",
        summary: "influence-pick made unbiased: lights out of range are drawn by their radius",
        source: "this project",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "picks={1,4,16},tail={1,4,16}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let picks = arguments.count("picks", 1, 1..=1024, "lights in range drawn a pass")?;
        let tail = arguments.count("tail", 1, 1..=1024, "draws a pass for the lights out of range")?;
        Ok(Self { picks, tail, range: Range::configure(arguments)? })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let scene = Arc::clone(context.stage.scene());
        let cutoff = self.range.cutoff(&scene);
        let near = InRange::new(context, &self.range, self.picks);
        // A directional light is in range everywhere and never drawn here.
        let radius = |light: &Light| cutoff.volume(light).map_or(0.0, |volume| f64::from(volume.radius2).sqrt());
        let far = LightTable::new(context.stage, radius)?;
        Ok(Sampler { near, far, scene, cutoff, tail: self.tail })
    }
}

/// [`InfluenceTail`] for a scene.
pub(super) struct Sampler {
    scene: Arc<Scene>,
    near: InRange,
    far: LightTable,
    cutoff: Cutoff,
    tail: u32,
}

impl Sampler {
    /// Exactly what the hierarchy answers, for one light.
    fn in_range(&self, light: LightId, at: &Receiver) -> bool {
        self.cutoff.volume(&self.scene.lights()[light as usize]).is_none_or(|volume| volume.contains(at.position))
    }
}

impl LightSampler for Sampler {
    type Scratch = Listed;

    fn arrive<T: Tally>(&self, at: &Receiver, listed: &mut Self::Scratch, tally: &mut T) {
        self.near.arrive(at, listed, tally);
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, listed: &mut Self::Scratch, out: &mut Picks<'_, T>) {
        self.near.sample(at, draws, listed, out);
        for j in 0..self.tail {
            if let Some((light, pmf)) = self.far.pick(draws.choice_bits(j, self.tail))
                && !self.in_range(light, at)
            {
                out.push(light, 1.0 / (self.tail as f32 * pmf));
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        for (light, pmf) in self.far.pmf().filter(|(light, _)| !self.in_range(*light, at)) {
            counts[light as usize] += self.tail as f32 * pmf;
        }
        self.near.expected_counts(at, counts)
    }

    fn heap_bytes(&self) -> usize {
        self.near.heap_bytes() + self.far.heap_bytes()
    }
}
