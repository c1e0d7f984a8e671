//! What does a sample take in a whole frame, when only some of its receivers are measured?

use super::table::measured;
use crate::base::error::Result;
use crate::measure::trials::Trials;
use crate::record::{Claim, Summary};
use crate::strategy::registry::Configured;

/// The time of a strategy's samples in frames of one size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// CPU seconds of the state of a pass.
    state_s: f64,
    /// CPU seconds of a sample without it.
    sample_s: f64,
    /// Receivers that share it.
    frame: usize,
}

impl Timing {
    /// The time of a measured strategy in frames of `frame` receivers; `None` for one without a time of its own.
    pub(super) fn of(
        trials: &Trials<'_>,
        strategy: &Configured,
        summary: &Summary,
        frame: usize,
    ) -> Result<Option<Self>> {
        // The oracle pays for what it knows with a ray for every light: its time says nothing.
        if !measured(summary) || summary.claim == Claim::Oracle {
            return Ok(None);
        }
        let state_s = trials.pass_state_s(strategy)?;
        let passes = f64::from(summary.passes);
        let samples = passes * trials.target.frame.len() as f64;
        let sample_s = ((summary.cpu_s - passes * state_s) / samples).max(0.0);
        Ok(Some(Self { state_s, sample_s, frame }))
    }

    /// CPU seconds of a sample.
    pub(super) fn sample_s(&self) -> f64 {
        self.sample_s + self.state_s / self.frame as f64
    }
}

/// What the notes say of it.
pub(super) fn note(frame: &str) -> String {
    format!(
        "CPU ns a sample: what a strategy draws anew for each pass (stochastic-cull:draw=pass) is shared by {frame}, as when a whole \
         frame is rendered, and not by the measured receivers alone."
    )
}
