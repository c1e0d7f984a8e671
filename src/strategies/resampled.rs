//! Candidates from a cheap strategy, the choice among them by what they add here.
//!
//! `from` names any strategy that chooses lights at one receiver, with its parameters between `;`:
//! `resampled:from=light-tree:arity=2;open=0,m=4`. With `visibility=on` every candidate costs a shadow ray, and
//! hidden ones are never chosen.

use super::parts::candidates::{Candidates, Pool, Recipe, Value};
use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::receiver::Receiver;
use crate::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Pick, Picks, Strategy, Tally};

/// `picks` lights chosen among the candidates of `m` calls.
pub(super) struct Resampled {
    recipe: Recipe,
    value: Value,
    picks: u32,
}

impl Strategy for Resampled {
    const INFO: Info = Info {
        name: "resampled",
        summary: "draws candidates from another strategy and picks among them by what they add here",
        source: "Talbot, Cline, Egbert, EGSR 2005",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler;
    const GRID: &'static str = "picks={1,4,16},m={8,32}";

    fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let recipe = Recipe::configure(arguments)?;
        let meaning = "whether a candidate is tested for visibility before the choice";
        let value = [Value::Light, Value::VisiblePoint][arguments.choice("visibility", 0, &["off", "on"], meaning)?];
        let picks = arguments.count("picks", 1, 1..=1024, "lights picked among the candidates of a pass")?;
        Ok(Self { recipe, value, picks })
    }

    fn info(&self) -> Info {
        Info { claim: self.recipe.claim(), ..Self::INFO }
    }

    fn gives_candidates(&self) -> bool {
        false
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Sampler> {
        Ok(Sampler { candidates: self.recipe.build(context)?, value: self.value, picks: self.picks })
    }
}

/// [`Resampled`] for a scene.
pub(super) struct Sampler {
    candidates: Candidates,
    value: Value,
    picks: u32,
}

/// One worker's storage.
#[derive(Default)]
pub(super) struct Scratch(Pool);

impl LightSampler for Sampler {
    type Scratch = Scratch;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut Scratch, tally: &mut T) {
        self.candidates.arrive(at, &mut scratch.0, tally);
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Scratch, out: &mut Picks<'_, T>) {
        self.candidates.draw(self.value, at, draws, &mut scratch.0, out.tally);
        // One number for all picks, evenly spread. Not from the sequence of choices: the candidates used that up.
        let start = draws.stream().uniform64();
        for k in 0..self.picks {
            let u = (f64::from(k) + start) / f64::from(self.picks);
            let Some((Pick { light, weight, uv }, _)) = self.candidates.choose(&scratch.0, u) else { return };
            let weight = weight / self.picks as f32;
            if uv == Pick::DRAW {
                out.push(light, weight);
            } else {
                out.push_at(light, weight, uv);
            }
        }
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        self.candidates.heap_bytes()
    }
}
