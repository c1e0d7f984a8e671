//! How is a comparison done?

use super::engine::Engine;
use super::image_store::ImageStore;
use super::plan::Budget;
use crate::strategy::Configured;
use std::path::Path;

/// How a comparison is done.
pub(crate) struct ComparisonOptions<'a> {
    /// What somebody types to verify the scene, as `citylights verify scenes/first-night.toml`: to show a failure.
    pub typed: &'a str,
    /// The strategies.
    pub strategies: &'a [Configured],
    /// What each may spend in one run.
    pub budget: Budget,
    /// Independent runs.
    pub repeats: u32,
    /// Scenes that are compared in all: a right strategy must not fail on any of them.
    pub scenes: usize,
    /// The user's seed.
    pub seed: u64,
    /// Who times the runs.
    pub engine: &'a Engine<'a>,
    /// Most counted work of the reference, in nominal CPU seconds.
    pub reference_work_s: f64,
    /// Folder of cached references.
    pub cache: &'a Path,
    /// Where the last image of each finished run is kept.
    pub films: &'a ImageStore,
}
