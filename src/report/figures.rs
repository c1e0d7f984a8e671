//! What follows from the recorded figures of a strategy: how soon it gets somewhere, and where it stands among the others.

use crate::record::{Claim, Summary};
use std::cmp::Ordering;

/// Squared bias in units of relMSE, as far as it counts: 0 for a strategy without a bias of its own, never negative.
pub fn bias2(summary: &Summary) -> f64 {
    match summary.claim {
        Claim::Biased { .. } => summary.rel_bias2.mean.max(0.0),
        Claim::Unbiased | Claim::Floor | Claim::Ceiling => 0.0,
    }
}

/// CPU seconds, set-up included, until relMSE is `error`: set-up + V / (error - b^2), and at least one pass; infinite for never,
/// NaN where V is not known.
pub fn time_to(summary: &Summary, error: f64) -> f64 {
    let room = error - bias2(summary);
    if room <= 0.0 || summary.claim == Claim::Floor {
        return f64::INFINITY;
    }
    if summary.variance_seconds.is_nan() {
        return f64::NAN;
    }
    let one_pass = summary.cpu_s / f64::from(summary.passes.max(1));
    summary.setup_cpu_s + (summary.variance_seconds / room).max(one_pass)
}

/// The CPU seconds of sampling at which bias and noise weigh the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Balance {
    /// t* = V / b^2.
    At(f64),
    /// No bias was seen up to the longest time measured.
    After(f64),
}

/// Where bias and noise of a biased strategy weigh the same; `None` for the others.
pub fn balance(summary: &Summary) -> Option<Balance> {
    if !matches!(summary.claim, Claim::Biased { .. }) {
        return None;
    }
    let bias2 = summary.rel_bias2.mean;
    Some(if bias2 <= 0.0 { Balance::After(summary.cpu_s) } else { Balance::At(summary.variance_seconds / bias2) })
}

/// Whether the strategy ran to its end, so that its numbers mean something.
pub fn measured(summary: &Summary) -> bool {
    summary.error.is_none() && summary.skipped.is_none()
}

/// Unbiased rows, then biased ones, then the floor, then the ceiling.
pub fn group(summary: &Summary) -> u8 {
    match summary.claim {
        Claim::Unbiased => 0,
        Claim::Biased { .. } => 1,
        Claim::Floor => 2,
        Claim::Ceiling => 3,
    }
}

/// The order of tables and legends: by group, then by V; equal ones by error and name, those without numbers last.
pub fn order(a: &Summary, b: &Summary) -> Ordering {
    let key = |s: &Summary| (group(s), !measured(s));
    key(a)
        .cmp(&key(b))
        .then(a.variance_seconds.total_cmp(&b.variance_seconds))
        .then(a.rel_mse.mean.total_cmp(&b.rel_mse.mean))
        .then_with(|| a.strategy.cmp(&b.strategy))
}
