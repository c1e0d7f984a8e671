//! Bright lights more often, wherever they are.

use super::parts::light_table::LightTable;
use crate::base::colour::luminance;
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::light::Light;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Strategy, Tally};

/// `picks` independent draws, each light with a probability in proportion to its luminous flux.
///
/// By flux alone a dim lamp next to the receiver is drawn once in a million passes where a stadium stands far away;
/// `mix` of the probability is shared out evenly instead (defensive mixing: Hesterberg, Technometrics 37(2), 1995).
pub(super) struct Power {
    picks: u32,
    mix: f32,
}

impl Strategy for Power {
    const INFO: Info = Info {
        name: "power",
        summary: "picks lights by their flux, from an alias table",
        source: "Shirley, Wang, Zimmerman, ACM TOG 15(1), 1996; Vose, IEEE TSE 17(9), 1991",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "picks={1,4,16,64},mix={0,0.25}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
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
        let lights = LightTable::new(context.stage, |light| mixed(f64::from(flux(light))))?;
        Ok(Sampler { lights, picks: self.picks })
    }
}

/// [`Power`] for a scene.
pub(super) struct Sampler {
    lights: LightTable,
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
