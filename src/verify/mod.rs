//! Is a strategy right?
//!
//! Level 0, the contract, holds exactly: ids, weights, seeds, threads, expected counts, allocations. Level 1 is
//! statistics with fixed seeds, at one level for all hypotheses of a check together (Sidak 1967): every light that adds
//! something can be chosen, the weights of each light sum to 1 on average, and the mean estimate is the exact sum. Each
//! finds what the others pass: a light of little power that is never chosen does not move an estimate, a weight that is
//! 1 % off disappears in the noise of one light. Level 2 changes the [scene](metamorphic) in ways whose effect is
//! known.
//!
//! Two more checks look at several runs ([`Verifier::verify`]): another seed gives other picks, and samplers that are
//! built alike agree whoever arrives first. The [arithmetic](independent) that strategies are held to is checked too, and
//! so are the [halves] of a reference and what a strategy is [charged](charged()).
//!
//! The truth is the sum over *all* lights of the scene with a shadow ray each; what a stage leaves out is never left
//! out here. A strategy that declares itself biased is held to level 0, and its bias is measured instead.
//!
//! A check that fails is made a second time, with other numbers and more of them, and has failed if it fails again. So
//! a wrong strategy is found at the ordinary level of the first look, and a right one fails with the *square* of its
//! chance: many checks of many strategies need a tiny level, and there the tails of a mean of finite draws are not
//! Student's.

mod arrival;
mod calls;
mod charged;
mod check;
mod contract;
mod coverage;
mod estimate;
mod halves;
pub mod independent;
pub mod metamorphic;
mod observe;
mod pool;
mod seeds;
mod truth;
mod weights;

pub use charged::charged;
pub use check::Check;
pub use contract::{allocations, picks_in_range, picks_valid};
pub use halves::halves;
pub use truth::Truth;

use crate::base::error::Result;
use crate::base::random::{RunKey, hash};
use crate::scene::receiver::Receiver;
use crate::strategy::erased::{AnySampler, Frame};
use crate::strategy::registry::Configured;
use crate::strategy::{BuildContext, Claim, Pick};
use crate::visibility::stage::Stage;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::OnceLock;

/// How hard to look.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// How many receivers, spread over the stage's.
    pub receivers: usize,
    /// Picks to draw at each receiver, about.
    pub draws: usize,
    /// Independent batches that the picks are drawn in: the sample size of the t tests.
    pub batches: u32,
    /// Stratified points for the triangles of a receiver, in each of 8 repetitions, on top of one a light.
    pub points: u32,
    /// Names all random numbers.
    pub seed: u64,
    /// The chance that a right strategy fails a check in one look. It fails [`Verifier::verify`] with the square of it.
    pub level: f64,
    /// Allocations of this thread so far, where the program's allocator counts them.
    pub allocations: Option<fn() -> u64>,
}

impl Default for Options {
    fn default() -> Self {
        Self { receivers: 32, draws: 20_000, batches: 200, points: 64, seed: 1, level: 0.01, allocations: None }
    }
}

/// The checks of levels 0 and 1 that a right strategy may fail by chance.
pub const BY_CHANCE: [&str; 6] =
    [contract::PICKS, coverage::COVERAGE, weights::WEIGHTS, weights::TOTAL, estimate::ESTIMATE, estimate::IMAGE];

/// The names of the checks of strategies and of the arithmetic of a scene.
pub fn names() -> impl Iterator<Item = &'static str> {
    let contract = contract::NAMES.into_iter().chain([seeds::ANOTHER, arrival::ORDER]);
    contract.chain(BY_CHANCE).chain([estimate::BIAS]).chain(independent::NAMES).chain(metamorphic::names())
}

/// Whether other numbers could give another verdict.
fn by_chance(check: &Check) -> bool {
    BY_CHANCE.contains(&check.name)
}

/// How many times as much the second look draws.
const MORE: usize = 4;

/// A stage and what is true at some of its receivers: checks any number of strategies, on any threads.
pub struct Verifier<'a> {
    stage: &'a Stage,
    options: Options,
    receivers: Vec<Receiver>,
    truths: Vec<Truth>,
    /// The same with other numbers and more of them, made when first needed.
    second: OnceLock<Box<Self>>,
}

impl<'a> Verifier<'a> {
    /// Finds the truth at `options.receivers` receivers of a stage.
    pub fn new(stage: &'a Stage, options: Options) -> Self {
        Self::at(stage, spread(stage.receivers(), options.receivers), options)
    }

    /// Finds the truth at receivers of a stage.
    fn at(stage: &'a Stage, receivers: Vec<Receiver>, options: Options) -> Self {
        let truths = receivers.par_iter().map(|at| Truth::new(stage, at, options.points, options.seed)).collect();
        Self { stage, options, receivers, truths, second: OnceLock::new() }
    }

    /// What each light adds, at each receiver.
    pub fn truths(&self) -> &[Truth] {
        &self.truths
    }

    /// Checks a strategy: levels 0 and 1.
    pub fn verify(&self, strategy: &Configured) -> Result<Vec<Check>> {
        let build = || strategy.build(BuildContext { stage: self.stage, seed: self.options.seed });
        let sampler = build()?;
        let mut checks = self.verify_sampler(&*sampler, strategy.info().claim);
        if checks.iter().all(|check| check.passed || !contract::POSSIBLE.contains(&check.name)) {
            checks.push(arrival::order(self.stage.receivers(), &self.receivers, self.options.seed, build)?);
        }
        Ok(checks)
    }

    /// Checks a sampler that was built for the stage and claims so much. What takes more than one sampler to see,
    /// [`verify`](Self::verify) checks.
    pub fn verify_sampler(&self, sampler: &dyn AnySampler, claim: Claim) -> Vec<Check> {
        let mut checks = self.look(sampler, claim);
        if checks.iter().any(|check| !check.passed && by_chance(check)) {
            let second = self.second().look(sampler, claim);
            for check in checks.iter_mut().filter(|check| !check.passed && by_chance(check)) {
                if let Some(again) = second.iter().find(|again| again.name == check.name) {
                    check.clone_from(again);
                }
            }
        }
        checks
    }

    /// One look: every check fails a right sampler with the chance `options.level`.
    pub fn look(&self, sampler: &dyn AnySampler, claim: Claim) -> Vec<Check> {
        let subject = Subject { verifier: self, sampler };
        let mut impossible = contract::impossible(&subject);
        // An id that is out of range has nothing to be looked up, and no number is near one that is none.
        if impossible.any() {
            return contract::possible(&impossible).into();
        }
        let sites = observe::sites(&subject);
        sites.iter().for_each(|site| impossible.add(&site.impossible));
        let mut checks = Vec::from(contract::possible(&impossible));
        if impossible.any() {
            return checks;
        }
        checks.extend(contract::exact(&subject));
        checks.push(seeds::another(&subject));
        checks.push(contract::picks(&sites, &self.options));
        match claim {
            Claim::Unbiased => {
                // A biased strategy's pick may stand for other lights than itself, as those of lightcuts do.
                checks.push(contract::reciprocal(&sites));
                checks.push(coverage::coverage(self.stage.scene(), &sites));
                checks.extend(weights::weights(&sites, &self.options));
                checks.extend(estimate::estimate(&sites, &self.options));
            }
            Claim::Biased(why) => checks.push(estimate::bias(&sites, why)),
        }
        checks
    }

    fn second(&self) -> &Self {
        self.second.get_or_init(|| {
            let options = Options {
                draws: self.options.draws * MORE,
                points: self.options.points * MORE as u32,
                seed: hash(&[self.options.seed, u64::from_le_bytes(*b"2nd look")]),
                ..self.options
            };
            Box::new(Self::at(self.stage, self.receivers.clone(), options))
        })
    }
}

/// A sampler and what it is checked against.
struct Subject<'v, 's> {
    verifier: &'v Verifier<'s>,
    sampler: &'v dyn AnySampler,
}

impl Subject<'_, '_> {
    fn stage(&self) -> &Stage {
        self.verifier.stage
    }

    fn receivers(&self) -> &[Receiver] {
        &self.verifier.receivers
    }

    /// Names the numbers of an independent run.
    fn key(&self, run: u32) -> RunKey {
        RunKey { seed: self.verifier.options.seed, run }
    }

    /// The picks of run 0 at receivers of a frame, by receiver and pass, points on lights drawn.
    fn calls(&self, frame: &[Receiver], receivers: &[Receiver], passes: Range<u32>) -> Vec<Vec<Pick>> {
        calls::calls(self.sampler, Frame::new(frame, self.key(0)), receivers, passes, true)
    }
}

/// `wanted` of the receivers, in golden-ratio steps, so that no regular street pattern is met in step.
fn spread(receivers: &[Receiver], wanted: usize) -> Vec<Receiver> {
    let n = receivers.len();
    if n <= wanted {
        return receivers.to_vec();
    }
    (0..wanted).map(|i| receivers[((0.5 + i as f64 * 0.618_033_988_749_895).fract() * n as f64) as usize]).collect()
}
