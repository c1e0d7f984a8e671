//! What a sampler is built from.

use crate::visibility::stage::Stage;

/// What a sampler is built from.
#[derive(Clone, Copy)]
pub struct BuildContext<'a> {
    /// The scene made ready; [`Stage::lights`] are the lights to choose from.
    pub stage: &'a Stage,
    /// For strategies that draw random numbers while building.
    pub seed: u64,
}
