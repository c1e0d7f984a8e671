//! What a strategy is: parameters, and how they become a sampler of a scene.

use super::any_sampler::AnySampler;
use super::arguments::Arguments;
use super::configured::AnyStrategy;
use super::context::BuildContext;
use super::info::Info;
use crate::base::claim::Claim;
use crate::base::error::Result;

/// How lights are chosen: the parameters, before any scene is known.
///
/// ```
/// use citylights::prelude::*;
///
/// /// Any light with the same chance.
/// struct Any;
///
/// /// The lights of a scene.
/// struct Lights(Vec<LightId>);
///
/// impl Strategy for Any {
///     const INFO: Info = Info {
///         name: "any",
///         summary: "picks any light",
///         source: "an example",
///         claim: Claim::Unbiased,
///     };
///     type Sampler = Lights;
///     fn configure(_: &mut Arguments<'_>) -> Result<Self> {
///         Ok(Self)
///     }
///     fn build(&self, context: BuildContext<'_>) -> Result<Lights> {
///         Ok(Lights(context.stage.lights().to_vec()))
///     }
/// }
///
/// impl LightSampler for Lights {
///     type Scratch = ();
///     fn sample<T: Tally>(&self, _: &Receiver, draws: &mut Draws, _: &mut (), out: &mut Picks<'_, T>) {
///         let count = self.0.len() as f64;
///         if let Some(&light) = self.0.get((draws.choice(0, 1) * count) as usize) {
///             out.push(light, count as f32);
///         }
///     }
///     fn expected_counts(&self, _: &Receiver, counts: &mut [f32]) -> bool {
///         self.0.iter().for_each(|&light| counts[light as usize] += 1.0 / self.0.len() as f32);
///         true
///     }
///     fn heap_bytes(&self) -> usize {
///         size_of_val(&self.0[..])
///     }
/// }
///
/// let any = Registry::standard().with::<Any>().parse("any")?;
/// let scene = Scene::new(citylights::sources::small::sixteen())?;
/// assert!(verify(&any, &scene)?.iter().all(|check| check.passed));
/// # Ok::<(), Error>(())
/// ```
pub trait Strategy: Sized + Send + Sync + 'static {
    /// What it is.
    const INFO: Info;
    /// What it becomes for a scene.
    type Sampler: AnySampler + 'static;
    /// The parameters that matter, each with the values worth a try, in the syntax of sweeps: `"picks={1,2,4},cut={64,256}"`
    /// stands for six points. Tuning looks among these for the best, the defaults always among them; empty where there is
    /// nothing to choose. A dozen points at most: each costs what a row costs. See [`Registry::grid`](super::Registry::grid).
    const GRID: &'static str = "";
    /// Reads the parameters; each has a default.
    ///
    /// # Errors
    /// A parameter whose value is not allowed.
    fn configure(arguments: &mut Arguments) -> Result<Self>;
    /// What it is with its parameters: they may decide the claim.
    fn info(&self) -> Info {
        Self::INFO
    }
    /// Whether other strategies may take candidates from it: it chooses at one receiver, without a view of the frame,
    /// and takes none itself.
    fn gives_candidates(&self) -> bool {
        Self::INFO.claim.chooses()
    }
    /// Whether it chooses by the same probabilities in the same scene in another unit of length: not if these depend on a
    /// length in metres, as that which its own shadow rays keep off surfaces.
    fn scale_free(&self) -> bool {
        Self::INFO.claim != Claim::Oracle
    }
    /// Builds the sampler: the set-up phase.
    ///
    /// # Errors
    /// A scene that it cannot serve.
    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler>;
}

impl<S: Strategy> AnyStrategy for S {
    fn info(&self) -> Info {
        Strategy::info(self)
    }

    fn gives_candidates(&self) -> bool {
        Strategy::gives_candidates(self)
    }

    fn scale_free(&self) -> bool {
        Strategy::scale_free(self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>> {
        Ok(Box::new(Strategy::build(self, context)?))
    }
}
