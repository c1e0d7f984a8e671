//! What is known of a strategy once all its runs at its largest budget are done.

use super::number;
use serde::{Deserialize, Serialize};

/// A mean over runs and half the width of its 95 % Student-t interval, in the same unit; the half is infinite for a
/// single run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// The mean over runs.
    #[serde(with = "number")]
    pub mean: f64,
    /// From the mean to either end.
    #[serde(with = "number")]
    pub half_width: f64,
}

/// What a strategy says about its own estimate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Claim {
    /// Right on average.
    Unbiased,
    /// Off on average, by design.
    Biased {
        /// What is left out or approximated.
        why: String,
    },
    /// Does nothing (`null`): its time is the harness's own.
    Floor,
    /// Takes every light (`all`): no choice, no noise from choosing.
    Ceiling,
    /// Chooses by what it cannot know without paying for it (`oracle`): the least error of any choice, never timed.
    Oracle,
    /// Another renderer's image of the exported scene: it says nothing here, its bias is measured.
    External {
        /// Its name and version, as far as they are known.
        renderer: String,
    },
}

impl Claim {
    /// Whether its bias is measured and printed: it claims one, or claims nothing.
    pub fn may_be_biased(&self) -> bool {
        matches!(self, Self::Biased { .. }) || self.is_external()
    }

    /// Whether another renderer makes it.
    pub fn is_external(&self) -> bool {
        matches!(self, Self::External { .. })
    }
}

/// Work counted in a separate pass of the same code; counts carry over between machines, times do not.
///
/// Each pick ends in exactly one of the three early outs or in a shadow ray, if its contribution is not zero for
/// another reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counts {
    /// Estimates of a receiver: receivers times passes.
    pub samples: u64,
    /// Lights that the strategy gave.
    pub picks: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Shadow rays that met an occluder.
    pub blocked: u64,
    /// Picks dropped because the light sends nothing in that direction (outside a spot's cone).
    pub zero_intensity: u64,
    /// Picks dropped because the light is below the receiver's horizon.
    pub behind_surface: u64,
    /// Picks dropped because the receiver is behind a one-sided emitter.
    pub behind_light: u64,
    /// Nodes of a hierarchy visited to choose.
    #[serde(default)]
    pub nodes: u64,
    /// Lights or nodes weighed at a receiver to choose.
    #[serde(default)]
    pub weighed: u64,
    /// Candidates drawn to choose from.
    #[serde(default)]
    pub candidates: u64,
    /// Shadow rays cast to choose, beside [`shadow_rays`](Self::shadow_rays).
    #[serde(default)]
    pub choosing_rays: u64,
}

/// One strategy on one scene at its largest budget.
///
/// Errors are over receiver pixels against the scene's reference. With [`error`](Self::error) or
/// [`skipped`](Self::skipped) set the numbers mean nothing.
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
    /// Passes at the largest budget.
    pub passes: u32,
    /// CPU seconds of building, mean over runs.
    #[serde(with = "number")]
    pub setup_cpu_s: f64,
    /// CPU seconds of sampling all passes, without set-up, mean over runs.
    #[serde(with = "number")]
    pub cpu_s: f64,
    /// Wall seconds of sampling, mean over runs.
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
    /// The bias of the image's mean that a 5 % test would find with 80 % power, as a share of it.
    #[serde(with = "number")]
    pub detectable_bias: f64,
    /// V: variance in units of relMSE times CPU seconds, set-up left out, both at the largest budget
    /// ([`passes`](Self::passes)).
    ///
    /// It belongs to that budget: arriving at a receiver is paid once per block of passes, so that CPU time is affine
    /// in the passes and V is not the same at every budget.
    #[serde(with = "number")]
    pub variance_seconds: f64,
    /// Error per sample, relMSE times passes, over that of the oracle at the receivers that this was run on; none where
    /// no oracle was run.
    #[serde(default)]
    pub times_oracle: Option<f64>,
    /// The receivers that its figures are for, where they are not all that were measured: an oracle's.
    #[serde(default)]
    pub receivers: Option<u64>,
    /// Work, from the counting pass.
    pub counts: Counts,
    /// Whether the two halves of the runs differ by more than their intervals.
    pub unstable: bool,
    /// Why it was not run: "skipped: about 40 s".
    pub skipped: Option<String>,
    /// Why it failed.
    pub error: Option<String>,
}

impl Summary {
    /// A summary without figures: of what was skipped or failed, or before its runs.
    pub fn blank(strategy: String, claim: Claim, chooses: bool) -> Self {
        let none = Interval { mean: f64::NAN, half_width: f64::NAN };
        Self {
            strategy,
            claim,
            chooses,
            runs: 0,
            passes: 0,
            setup_cpu_s: f64::NAN,
            cpu_s: f64::NAN,
            wall_s: f64::NAN,
            heap_bytes: 0,
            rel_mse: none,
            mse: none,
            rel_mse_trimmed: none,
            rel_bias2: none,
            mean_bias: none,
            detectable_bias: f64::NAN,
            variance_seconds: f64::NAN,
            times_oracle: None,
            receivers: None,
            counts: Counts::default(),
            unstable: false,
            skipped: None,
            error: None,
        }
    }
}
