//! Bright lights more often, wherever they are.

use super::parameters::Arguments;
use super::tally::Tally;
use super::{BuildContext, Claim, Info, LightSampler, Picks, Role, Strategy};
use crate::base::colour::luminance;
use crate::base::discrete::AliasTable;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::light::{Light, LightId};
use crate::scene::receiver::Receiver;
use crate::visibility::stage::Stage;

/// `picks` independent draws, each light with a probability in proportion to its luminous flux.
///
/// By flux alone a dim lamp next to the receiver is drawn once in a million passes where a stadium stands far away;
/// `mix` of the probability is shared out evenly instead (defensive mixing: Hesterberg, Technometrics 37(2), 1995).
pub struct Power {
    picks: u32,
    mix: f32,
}

impl Strategy for Power {
    const INFO: Info = Info {
        name: "power",
        summary: "picks lights by their flux, from an alias table",
        source: "Shirley, Wang, Zimmerman, ACM TOG 15(1), 1996; Vose, IEEE TSE 17(9), 1991",
        claim: Claim::Unbiased,
        role: Role::Choosing,
    };
    type Sampler = Sampler;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        let picks = arguments.count("picks", 1, 1..=1024, "lights drawn a pass")?;
        Ok(Self {
            picks,
            mix: arguments.real("mix", 0.0, 0.0..=1.0, "share of the probability that is the same for all")?,
        })
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let radius = context.stage.scene().radius();
        let flux = |light: &Light| luminance(light.flux(radius));
        let table = context.stage.scene().lights();
        let shining =
            || context.stage.lights().iter().map(|&id| f64::from(flux(&table[id as usize]))).filter(|&w| w > 0.0);
        let mean = shining().sum::<f64>() / shining().count().max(1) as f64;
        let mixed = |flux: f64| if flux > 0.0 { flux + f64::from(self.mix) * (mean - flux) } else { 0.0 };
        let lights = Aliased::new(context.stage, |light| mixed(f64::from(flux(light))))?;
        Ok(Sampler { lights, picks: self.picks })
    }
}

/// Lights with an alias table over fixed weights.
pub(super) struct Aliased {
    lights: Vec<LightId>,
    /// `None` where no light has any weight.
    table: Option<AliasTable>,
}

impl Aliased {
    /// The lights of a stage, each with the weight that `weight` gives it.
    pub(super) fn new(stage: &Stage, weight: impl Fn(&Light) -> f64) -> Result<Self> {
        let lights = stage.lights().to_vec();
        let table = stage.scene().lights();
        let weights: Vec<f64> = lights.iter().map(|&id| weight(&table[id as usize])).collect();
        let table = weights.iter().any(|&w| w > 0.0).then(|| AliasTable::new(&weights)).transpose()?;
        Ok(Self { lights, table })
    }

    /// The light that 64 uniform bits choose, and its probability.
    #[inline]
    pub(super) fn pick(&self, bits: u64) -> Option<(LightId, f32)> {
        let table = self.table.as_ref()?;
        let index = table.pick(bits);
        Some((self.lights[index], table.pmf(index)))
    }

    /// All lights with their probabilities.
    pub(super) fn pmf(&self) -> impl Iterator<Item = (LightId, f32)> {
        let table = self.table.as_ref();
        self.lights.iter().enumerate().filter_map(move |(i, &light)| Some((light, table?.pmf(i))))
    }

    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.lights[..]) + self.table.as_ref().map_or(0, AliasTable::heap_bytes)
    }
}

/// [`Power`] for a scene.
pub struct Sampler {
    lights: Aliased,
    picks: u32,
}

impl LightSampler for Sampler {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        for j in 0..self.picks {
            if let Some((light, pmf)) = self.lights.pick(draws.choice_bits(j, self.picks)) {
                out.push(light, 1.0 / (self.picks as f32 * pmf));
            }
        }
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        self.lights.pmf().for_each(|(light, pmf)| counts[light as usize] += self.picks as f32 * pmf);
        true
    }

    fn heap_bytes(&self) -> usize {
        self.lights.heap_bytes()
    }
}
