//! How large is a strategy's error after one pass? See [`citylights::bench::variance`].
//!
//! To see that a worse estimator is found: `cargo bench --features bench --bench variance -- --save-baseline before`, then
//! `CITYLIGHTS_BENCH_MUTANT=1 cargo bench --features bench --bench variance -- --baseline before`. A pick of `power` is
//! then kept with a chance of 1/4 only, and weighted four times: of a variance V about a mean m this makes
//! `4 V + 3 m²`, unbiased as before.

use citylights::prelude::*;
use std::path::{Path, PathBuf};

fn main() -> Result<()> {
    let scenes = ["lamps-only", "first-night"].map(|name| Path::new("scenes").join(name).with_extension("toml"));
    let is_worse = std::env::var_os("CITYLIGHTS_BENCH_MUTANT").is_some();
    let registry = if is_worse { Registry::standard().with::<Thinned>() } else { Registry::standard() };
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("references");
    citylights::bench::variance(&registry, &scenes.each_ref().map(PathBuf::as_path), &cache)
}

/// `power`, made worse.
struct Thinned;

/// [`Thinned`] for a scene.
struct Sampler(LightTable);

impl Strategy for Thinned {
    const INFO: Info = Info {
        name: "power",
        summary: "in proportion to flux, and three of four picks dropped",
        source: "this bench",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;

    fn configure(_: &mut Arguments<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        let radius = context.stage.scene().radius();
        Ok(Sampler(LightTable::new(context.stage, |light| f64::from(luminance(light.flux(radius))))?))
    }
}

impl LightSampler for Sampler {
    type Scratch = ();

    fn sample<T: Tally>(&self, _: &Receiver, draws: &mut Draws, (): &mut (), out: &mut Picks<'_, T>) {
        let kept = draws.stream().below(4) == 0;
        if let Some((light, probability)) = self.0.pick(draws.choice_bits(0, 1)).filter(|_| kept) {
            out.push(light, 4.0 / probability);
        }
    }

    fn expected_counts(&self, _: &Receiver, counts: &mut [f32]) -> bool {
        self.0.pmf().for_each(|(light, probability)| counts[light as usize] += 0.25 * probability);
        true
    }

    fn heap_bytes(&self) -> usize {
        self.0.heap_bytes()
    }
}
