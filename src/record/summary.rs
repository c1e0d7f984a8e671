//! What is known of a strategy once all its runs are done.

use super::interval::Interval;
use super::number;
use crate::base::claim::Claim;
use crate::base::counts::Counts;
use serde::{Deserialize, Serialize};

/// One budget of a strategy: a point of its curve of error against time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Passes, done in one block.
    pub passes: u32,
    /// CPU seconds from nothing to the image: set-up, arrival and passes.
    pub cpu_s: Interval,
    /// relMSE of the image.
    pub rel_mse: Interval,
}

/// How a figure was found on a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Read {
    /// At a budget, or between two of them.
    Measured,
    /// Beyond the largest budget, if noise goes on falling as 1 / time.
    Extrapolated,
    /// An error that its bias alone exceeds.
    Never,
    /// A time before the first image is there.
    TooSoon,
    /// Nothing was measured, or the bias is not known.
    Unknown,
}

/// A figure read off a strategy's curve of error against time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reading {
    /// Where it was read: a relMSE, or CPU seconds.
    #[serde(with = "number")]
    pub at: f64,
    /// What was found there: CPU seconds, or a relMSE.
    pub value: Interval,
    /// How.
    pub how: Read,
}

/// One strategy on one scene.
///
/// Errors are over the measured receivers against the scene's reference, and those of the largest budget where no other
/// is named. With [`error`](Self::error) or [`skipped`](Self::skipped) set the numbers mean nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Summary {
    /// Name and parameters: `light-tree:arity=8,split=0.5`.
    pub strategy: String,
    /// What it says about its bias.
    pub claim: Claim,
    /// Whether it chooses lights; `all` and `null` do not.
    pub chooses: bool,
    /// Independent runs.
    pub runs: u32,
    /// Its curve, smallest budget first.
    pub curve: Vec<Point>,
    /// Passes at the largest budget.
    pub passes: u32,
    /// CPU seconds of building.
    pub setup_cpu_s: Interval,
    /// CPU seconds of coming to every receiver once, whatever the number of passes; not known from one budget.
    pub arrival_cpu_s: Interval,
    /// CPU seconds of each pass after that.
    pub pass_cpu_s: Interval,
    /// CPU seconds of sampling at the largest budget, without set-up.
    pub cpu_s: Interval,
    /// Wall seconds of the same, mean over runs.
    #[serde(with = "number")]
    pub wall_s: f64,
    /// Bytes on the heap after building.
    pub heap_bytes: u64,
    /// relMSE.
    pub rel_mse: Interval,
    /// MSE, in the square of the image's unit.
    pub mse: Interval,
    /// relMSE without each run's worst 0.1 % of pixels.
    pub rel_mse_trimmed: Interval,
    /// Squared bias b^2 in units of relMSE, freed of noise; may come out negative.
    pub rel_bias2: Interval,
    /// Energy ratio less 1: the bias of the image's mean, as a share of it.
    pub mean_bias: Interval,
    /// The same with an interval that holds for all unbiased rows of the scene together, at 99 % (Sidak 1967).
    pub simultaneous_bias: Interval,
    /// The bias of the image's mean that a 5 % test would find with 80 % power, as a share of it.
    #[serde(with = "number")]
    pub detectable_bias: f64,
    /// V: variance in units of relMSE times CPU seconds, set-up left out, both at the largest budget
    /// ([`passes`](Self::passes)).
    ///
    /// It belongs to that budget: arriving at a receiver is paid once per block of passes, so that CPU time is affine
    /// in the passes and V is not the same at every budget.
    pub variance_seconds: Interval,
    /// t* = V / b^2: CPU seconds of sampling from which on bias outweighs noise; none where no bias may be.
    #[serde(default)]
    pub balance_s: Option<Interval>,
    /// CPU seconds, set-up included, to each of [`SceneRecord::errors`](super::SceneRecord::errors).
    pub seconds_to: Vec<Reading>,
    /// relMSE after each of [`SceneRecord::times_s`](super::SceneRecord::times_s).
    pub error_at: Vec<Reading>,
    /// Its rank among the unbiased rows by [`SceneRecord::ranked_by`](super::SceneRecord::ranked_by), first and last that
    /// the runs allow; none where it has none.
    #[serde(default)]
    pub rank: Option<[u32; 2]>,
    /// Rows that share a letter were not told apart (Holm 1979 over all pairs, 5 % in all; Piepho 2004).
    #[serde(default)]
    pub letters: String,
    /// Error per sample, relMSE times passes, over that of the oracle at the receivers that this was run on; none where
    /// no oracle was run.
    #[serde(default)]
    pub times_oracle: Option<Interval>,
    /// The receivers that its figures are for, where they are not all that were measured: an oracle's.
    #[serde(default)]
    pub receivers: Option<u64>,
    /// Work, from the counting pass.
    pub counts: Counts,
    /// Whether the two halves of the runs differ by more than their intervals.
    pub unstable: bool,
    /// Why it was not run: "skipped: one pass is 40 s of counted work".
    pub skipped: Option<String>,
    /// Why it failed: a check, a bias, a scene that it cannot serve.
    pub error: Option<String>,
}

impl Summary {
    /// A summary without figures: of what was skipped or failed, or before its runs.
    pub(crate) fn blank(strategy: String, claim: Claim) -> Self {
        Self {
            strategy,
            chooses: claim.chooses(),
            claim,
            runs: 0,
            curve: Vec::new(),
            passes: 0,
            setup_cpu_s: Interval::NONE,
            arrival_cpu_s: Interval::NONE,
            pass_cpu_s: Interval::NONE,
            cpu_s: Interval::NONE,
            wall_s: f64::NAN,
            heap_bytes: 0,
            rel_mse: Interval::NONE,
            mse: Interval::NONE,
            rel_mse_trimmed: Interval::NONE,
            rel_bias2: Interval::NONE,
            mean_bias: Interval::NONE,
            simultaneous_bias: Interval::NONE,
            detectable_bias: f64::NAN,
            variance_seconds: Interval::NONE,
            balance_s: None,
            seconds_to: Vec::new(),
            error_at: Vec::new(),
            rank: None,
            letters: String::new(),
            times_oracle: None,
            receivers: None,
            counts: Counts::default(),
            unstable: false,
            skipped: None,
            error: None,
        }
    }
}
