//! How large is a strategy's error after one pass? See [`citylights::bench::variance`].
//!
//! To see that a worse estimator is found: `cargo bench --features bench --bench variance -- --save-baseline before`, then
//! `CITYLIGHTS_BENCH_MUTANT=1 cargo bench --features bench --bench variance -- --baseline before`. Each pick of [`Mutant`]'s strategies is
//! then kept with a chance of 1/4 only, and weighted four times.

use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::scene::receiver::Receiver;
use citylights::strategies::{intensity, power, uniform};
use citylights::strategy::{Arguments, BuildContext, Info, LightSampler, Pick, Picks, Registry, Strategy, Tally};
use std::path::{Path, PathBuf};

fn main() -> Result<()> {
    let scenes = ["lamps-only", "first-night"].map(|name| Path::new("scenes").join(name).with_extension("toml"));
    let registry = registry(std::env::var_os("CITYLIGHTS_BENCH_MUTANT").is_some());
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("references");
    citylights::bench::variance(&registry, &scenes.each_ref().map(PathBuf::as_path), &cache)
}

/// The registry, with mutants in place of some strategies if asked for.
fn registry(mutants: bool) -> Registry {
    let standard = Registry::standard();
    if !mutants {
        return standard;
    }
    standard.with::<Mutant<uniform::Uniform>>().with::<Mutant<power::Power>>().with::<Mutant<intensity::Intensity>>()
}

/// A strategy made worse: of a variance V about a mean m it makes `4 V + 3 m²`, unbiased as before.
struct Mutant<S>(S);

/// [`Mutant`] for a scene.
struct Thinned<L>(L);

impl<S: Strategy<Sampler: LightSampler>> Strategy for Mutant<S> {
    const INFO: Info = S::INFO;
    type Sampler = Thinned<S::Sampler>;

    fn configure(arguments: &mut Arguments) -> Result<Self> {
        Ok(Self(S::configure(arguments)?))
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(Thinned(self.0.build(context)?))
    }
}

impl<L: LightSampler> LightSampler for Thinned<L> {
    type Scratch = (L::Scratch, Vec<Pick>);

    fn arrive<T: Tally>(&self, at: &Receiver, (scratch, _): &mut Self::Scratch, tally: &mut T) {
        self.0.arrive(at, scratch, tally);
    }

    fn sample<T: Tally>(
        &self,
        at: &Receiver,
        draws: &mut Draws,
        (scratch, picks): &mut Self::Scratch,
        out: &mut Picks<'_, T>,
    ) {
        picks.clear();
        self.0.sample(at, draws, scratch, &mut Picks::new(picks, out.tally));
        for pick in picks.iter() {
            if draws.stream().below(4) == 0 {
                out.push(pick.light, 4.0 * pick.weight);
            }
        }
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        self.0.heap_bytes()
    }
}
