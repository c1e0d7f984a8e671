//! How are lights chosen?
//!
//! A [`Strategy`] holds parameters; built for a scene it gives a [`LightSampler`], which returns *weighted lights*. The
//! harness shades them, so strategies differ in choice alone. The contract is one identity: for every light `l` that
//! can add anything at a receiver and every function `g` of the point on it,
//!
//! ```text
//! E[ sum over picks of l of weight * g(uv) ] = integral of g      (g = 1: the weights of l sum to 1 on average)
//! ```
//!
//! A strategy that tests points before it picks one may leave out those that add nothing there: the identity then holds
//! for every g that is 0 at them, which is all that shading asks for.
//!
//! A strategy that breaks it by design says so in its [`Claim`].
//!
//! Adding one takes a file here and a line in [`registry`].

pub mod all;
pub mod allocate;
mod candidates;
pub mod erased;
pub mod influence;
pub mod influence_pick;
pub mod influence_tail;
pub mod intensity;
pub mod light_tree;
pub mod lightcuts;
pub mod null;
pub mod oracle;
pub mod parameters;
pub mod power;
pub mod registry;
pub mod resampled;
pub mod restir;
pub mod stochastic_cull;
pub mod stochastic_lightcuts;
pub mod tally;
mod target;
pub mod tree;
pub mod uniform;
pub mod visible;

use crate::base::draws::Draws;
use crate::base::error::Result;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::visibility::stage::Stage;
use erased::AnySampler;
use parameters::Arguments;
use tally::Tally;

/// One chosen light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// Which light.
    pub light: LightId,
    /// What its contribution is multiplied with; finite and 0 or more, which `verify` checks (`weights-finite`).
    pub weight: f32,
    /// The point on it, in `[0, 1)^2`.
    pub uv: [f32; 2],
}

impl Pick {
    /// The harness draws the point.
    const DRAW: [f32; 2] = [-1.0, -1.0];

    /// Draws the point if that was left to the harness. `slot` is the place of the pick in its call.
    #[inline]
    pub(crate) fn settle(&mut self, slot: u32, draws: &mut Draws) {
        if self.uv == Self::DRAW {
            self.uv = draws.point(slot);
        }
    }
}

/// Where a sampler puts its picks and says what they took.
pub struct Picks<'a, T> {
    list: &'a mut Vec<Pick>,
    /// Counts the work of choosing.
    pub tally: &'a mut T,
}

impl<'a, T: Tally> Picks<'a, T> {
    /// Appends to `list`.
    pub fn new(list: &'a mut Vec<Pick>, tally: &'a mut T) -> Self {
        Self { list, tally }
    }

    /// Picks a light; the harness draws the point on it.
    #[inline]
    pub fn push(&mut self, light: LightId, weight: f32) {
        self.list.push(Pick { light, weight, uv: Pick::DRAW });
    }

    /// Picks a point of a light; `uv` in `[0, 1)^2`.
    #[inline]
    pub fn push_at(&mut self, light: LightId, weight: f32, uv: [f32; 2]) {
        self.list.push(Pick { light, weight, uv });
    }
}

/// What a strategy promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// The contract holds for every light.
    Unbiased,
    /// It does not, for this reason.
    Biased(&'static str),
}

/// What part a strategy plays in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It chooses among lights.
    Choosing,
    /// It does nothing: the floor of the harness's own cost.
    Floor,
    /// It takes every light: the ceiling.
    Ceiling,
    /// It chooses by what it cannot know without paying for it: the floor under every error, never timed.
    Oracle,
}

/// What a strategy is, apart from its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Info {
    /// Its name, as typed.
    pub name: &'static str,
    /// What it does, in a line.
    pub summary: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// What it promises.
    pub claim: Claim,
    /// Its part in a comparison.
    pub role: Role,
}

/// What a sampler is built from.
#[derive(Clone, Copy)]
pub struct BuildContext<'a> {
    /// The scene made ready; [`Stage::lights`] are the lights to choose from.
    pub stage: &'a Stage,
    /// For strategies that draw random numbers while building.
    pub seed: u64,
}

/// How lights are chosen: the parameters, before any scene is known.
pub trait Strategy: Sized + Send + Sync + 'static {
    /// What it is.
    const INFO: Info;
    /// What it becomes for a scene.
    type Sampler: AnySampler + 'static;
    /// Reads the parameters; each has a default.
    fn configure(arguments: &mut Arguments) -> Result<Self>;
    /// What it is with its parameters: they may decide the claim.
    fn info(&self) -> Info {
        Self::INFO
    }
    /// Whether other strategies may take candidates from it: it chooses at one receiver, without a view of the frame,
    /// and takes none itself.
    fn gives_candidates(&self) -> bool {
        Self::INFO.role == Role::Choosing
    }
    /// Whether it chooses by the same probabilities in the same scene in another unit of length: not if these depend on a
    /// length in metres, as that which its own shadow rays keep off surfaces.
    fn scale_free(&self) -> bool {
        Self::INFO.role != Role::Oracle
    }
    /// Builds the sampler: the set-up phase.
    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler>;
}

/// Lights chosen for one scene: the query phase. No allocation once the scratch is warm, no locks.
pub trait LightSampler: Send + Sync {
    /// Storage of one worker, reused from call to call.
    type Scratch: Default + Send + 'static;

    /// Called when the harness comes to a receiver, before the passes that it samples there.
    fn arrive<T: Tally>(&self, _at: &Receiver, _scratch: &mut Self::Scratch, _tally: &mut T) {}

    /// Chooses lights for one pass at the receiver that was arrived at.
    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Self::Scratch, out: &mut Picks<'_, T>);

    /// Adds to `counts` (one a light of the scene) how often each light is expected to be pushed in a call of
    /// [`sample`](Self::sample): the probability for one pick, k times it for k, 1 for a light that is listed. False if
    /// that cannot be told (resampling), never to mean zero.
    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool;

    /// Bytes on the heap, without those that the stage owns.
    fn heap_bytes(&self) -> usize;
}
