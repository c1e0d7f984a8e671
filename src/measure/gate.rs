//! Is a strategy right enough to be timed?
//!
//! A wrong one is not worth a figure: it may be fast because it is wrong. So each takes a short look at levels 0 and 1
//! first, on the very scene it is to be measured on. `citylights verify` looks longer.

use crate::base::error::{Error, Result};
use crate::base::statistics::sidak;
use crate::strategy::registry::Configured;
use crate::verify::{BY_CHANCE, Options, Verifier};
use crate::visibility::stage::Stage;

/// The chance that any row of a table is refused although all strategies are right.
const LEVEL: f64 = 1e-4;

/// Lets right strategies pass.
pub struct Gate<'a>(Verifier<'a>);

impl<'a> Gate<'a> {
    /// A gate for so many strategies on a stage.
    pub fn new(stage: &'a Stage, strategies: usize, seed: u64) -> Self {
        // A check fails only if it fails twice.
        let level = sidak(LEVEL, strategies * BY_CHANCE.len()).sqrt();
        let options = Options { receivers: 8, draws: 2_000, batches: 32, points: 16, seed, level, allocations: None };
        Self(Verifier::new(stage, options))
    }

    /// An error that names the check that a strategy fails.
    pub fn pass(&self, strategy: &Configured) -> Result<()> {
        match self.0.verify(strategy)?.into_iter().find(|check| !check.passed) {
            None => Ok(()),
            Some(check) => Err(Error::Invalid(format!(
                "failed check `{}`: statistic {:.3e}, limit {:.3e}",
                check.name, check.statistic, check.limit
            ))),
        }
    }
}
