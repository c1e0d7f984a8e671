//! Is a strategy right?
//!
//! Level 0, the contract, holds exactly: ids, weights, seeds, threads, expected counts, allocations. Level 1 is
//! statistics with fixed seeds, at one level for all hypotheses of a check together (Sidak 1967): every light that adds
//! something can be chosen, the weights of each light sum to 1 on average, and the mean estimate is the exact sum. Each
//! finds what the others pass: a light of little power that is never chosen does not move an estimate, a weight that is
//! 1 % off disappears in the noise of one light.
//!
//! The truth is the sum over *all* lights of the scene with a shadow ray each; what a stage leaves out is never left out
//! here. A strategy that declares itself biased is held to level 0, and its bias is measured instead.

mod contract;
mod coverage;
mod estimate;
mod observe;
mod truth;
mod weights;

pub use contract::{allocations, picks_in_range, picks_valid};
pub use truth::Truth;

use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;
use crate::strategy::erased::{AnySampler, Block, Frame};
use crate::strategy::registry::Configured;
use crate::strategy::{BuildContext, Claim};
use crate::visibility::stage::Stage;
use std::fmt;

/// What one check found.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Its name: `weights`.
    pub name: &'static str,
    /// What was found; compared with [`limit`](Self::limit).
    pub statistic: f64,
    /// The greatest statistic that passes.
    pub limit: f64,
    /// Whether it passed.
    pub passed: bool,
    /// What the statistic is, where it was greatest, what it could have found.
    pub detail: String,
}

impl Check {
    fn new(name: &'static str, statistic: f64, limit: f64, detail: String) -> Self {
        // Not a number is a failure.
        Self { name, statistic, limit, passed: statistic <= limit, detail }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.passed { "pass" } else { "FAIL" };
        write!(f, "{verdict} {:<14} {:>11.4e} (limit {:.4e})  {}", self.name, self.statistic, self.limit, self.detail)
    }
}

/// How hard to look.
#[derive(Clone, Copy)]
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
    /// The chance that a right strategy fails a check.
    pub level: f64,
    /// Allocations of this thread so far, where the program's allocator counts them.
    pub allocations: Option<fn() -> u64>,
}

impl Default for Options {
    fn default() -> Self {
        Self { receivers: 32, draws: 20_000, batches: 200, points: 64, seed: 1, level: 0.01, allocations: None }
    }
}

/// Checks a strategy on a stage.
pub fn verify(strategy: &Configured, stage: &Stage, options: &Options) -> Result<Vec<Check>> {
    let sampler = strategy.build(BuildContext { stage, seed: options.seed })?;
    Ok(verify_sampler(&*sampler, strategy.info().claim, stage, options))
}

/// Checks a sampler that was built for a stage and claims so much.
pub fn verify_sampler(sampler: &dyn AnySampler, claim: Claim, stage: &Stage, options: &Options) -> Vec<Check> {
    let receivers = spread(stage.receivers(), options.receivers);
    let subject = Subject { sampler, stage, receivers: &receivers, options };
    let mut checks = contract::exact(&subject);
    // An id that is out of range has nothing to be looked up.
    if checks.iter().any(|check| !check.passed && check.name == contract::IDS) {
        return checks;
    }
    let sites = observe::sites(&subject);
    checks.extend([contract::picks(&sites, options), contract::reciprocal(&sites)]);
    match claim {
        Claim::Unbiased => {
            checks.push(coverage::coverage(&sites));
            checks.extend(weights::weights(&sites, options));
            checks.extend(estimate::estimate(&sites, options));
        }
        Claim::Biased(why) => checks.push(estimate::bias(&sites, why)),
    }
    checks
}

/// What all checks work on.
struct Subject<'a> {
    sampler: &'a dyn AnySampler,
    stage: &'a Stage,
    receivers: &'a [Receiver],
    options: &'a Options,
}

impl Subject<'_> {
    fn key(&self) -> RunKey {
        RunKey { seed: self.options.seed, run: 0 }
    }

    /// Begins passes of run 0 of all that the stage sees.
    fn begin(&self, passes: std::ops::Range<u32>) -> Box<dyn Block + '_> {
        self.sampler.begin(Frame::new(self.stage.receivers(), self.key()), passes)
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
