//! Is a strategy right enough to be timed?
//!
//! A wrong one is not worth a figure: it may be fast because it is wrong. So each takes a short look at levels 0 and 1
//! first, on the very scene it is to be measured on; and so does the program's own arithmetic, since all errors are taken
//! against it. `citylights verify` looks longer, and with `--gate` as shortly.

use super::engine::Account;
use crate::base::error::{Error, Result};
use crate::base::statistics::sidak;
use crate::strategy::Configured;
use crate::verify::independent::{Own, independent};
use crate::verify::{BY_CHANCE, Check, Verifier, VerifyOptions, charged};
use crate::visibility::stage::Stage;
use std::sync::OnceLock;

/// The chance that any row of a table is refused although all strategies are right.
const LEVEL: f64 = 1e-4;

/// Lets right strategies pass.
pub(crate) struct Gate<'a> {
    stage: &'a Stage,
    verifier: Verifier<'a>,
    /// What somebody types to verify the scene.
    typed: String,
    seed: u64,
    /// The check of the scene that failed, once it was looked at.
    arithmetic: OnceLock<Option<Check>>,
}

/// How hard the gate looks at so many strategies.
pub(crate) fn options(strategies: usize, seed: u64) -> VerifyOptions {
    // A check fails only if it fails twice.
    let level = sidak(LEVEL, strategies * BY_CHANCE.len()).sqrt();
    VerifyOptions { receivers: 8, draws: 2_000, batches: 32, points: 16, seed, level, allocations: None }
}

/// The program's arithmetic on a stage against an independent one.
pub(crate) fn arithmetic(stage: &Stage, seed: u64) -> Vec<Check> {
    independent(stage, &Own(stage), seed, LEVEL)
}

impl<'a> Gate<'a> {
    /// A gate for so many strategies on a stage; `typed` is what somebody types to verify the scene.
    pub(crate) fn new(stage: &'a Stage, typed: &str, strategies: usize, seed: u64) -> Self {
        let verifier = Verifier::new(stage, options(strategies, seed));
        Self { stage, verifier, typed: typed.to_owned(), seed, arithmetic: OnceLock::new() }
    }

    /// Looks at a strategy, and once at the arithmetic of its scene.
    ///
    /// # Errors
    /// The check that the strategy fails, or its scene: one line, with the command that shows it. A strategy that
    /// cannot serve the scene.
    pub(crate) fn pass(&self, strategy: &Configured) -> Result<()> {
        let first = |checks: Vec<Check>| checks.into_iter().find(|check| !check.passed);
        let arithmetic = self.arithmetic.get_or_init(|| first(arithmetic(self.stage, self.seed)));
        let failed = match arithmetic {
            Some(check) => Some(check.clone()),
            None => first(self.verifier.verify(strategy)?),
        };
        failed.map_or(Ok(()), |check| Err(Error::Invalid(self.line(&check, strategy.name()))))
    }

    fn line(&self, check: &Check, strategy: &str) -> String {
        let Check { name, statistic, limit, .. } = check;
        format!(
            "failed check `{name}`{}: statistic {statistic:.3e}, limit {limit:.3e}; {} --gate --seed {} \
             --strategies {strategy} --only {name}",
            check.place(),
            self.typed,
            self.seed
        )
    }

    /// An error if a strategy was charged for other work than the process did meanwhile.
    pub(super) fn charged(&self, strategy: &Configured, account: Account) -> Result<()> {
        let check = charged(account.threads_s, account.process_s);
        if check.passed { Ok(()) } else { Err(Error::Invalid(self.line(&check, strategy.name()))) }
    }
}
