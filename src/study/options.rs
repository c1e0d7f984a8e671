//! What may a user change of a study?

use crate::measure::reference::scene_hash;
use crate::record::Program;
use crate::scene::Scene;
use crate::sources::Overrides;
use crate::strategy::Registry;
use std::path::PathBuf;

/// What a user may change; each study reads what makes sense for it.
#[derive(Clone)]
pub(crate) struct StudyOptions {
    /// The strategies that can be named.
    pub registry: Registry,
    /// The program that runs, where it is not this crate's own.
    pub program: Option<Program>,
    /// Scene files instead of the study's own.
    pub scenes: Vec<PathBuf>,
    /// What is set in place of the files' own words.
    pub overrides: Overrides,
    /// The strategies, as a list with parameters, instead of the study's own.
    pub strategies: Option<String>,
    /// Receivers drawn by area, for what needs no rays or only a few.
    pub receivers: usize,
    /// Receivers of the frame that errors are taken at, instead of as many as each study takes.
    pub pixels: Option<usize>,
    /// Passes of a run.
    pub passes: u32,
    /// Most counted work of a run, in [nominal seconds](crate::measure::work): a strategy that cannot do all passes in
    /// it does fewer.
    pub seconds: f64,
    /// Independent runs.
    pub repeats: u32,
    /// The most lights of a series of growing scenes.
    pub max_lights: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Runs side by side.
    pub threads: usize,
    /// Folder of cached references.
    pub cache: PathBuf,
}

impl StudyOptions {
    /// All of it that decides a study's cells, and the scenes' content.
    pub(super) fn plan<'s>(&self, scenes: impl IntoIterator<Item = &'s Scene>) -> String {
        let Self { overrides, strategies, receivers, pixels, passes, seconds, repeats, max_lights, seed, .. } = self;
        let scenes = scenes.into_iter().map(|scene| format!(" {}={}", scene.name(), scene_hash(scene)));
        format!(
            "scenes{}; {overrides:?}; strategies {}; {receivers} receivers, {pixels:?} pixels; {passes} passes, {seconds} s; \
             {repeats} runs; at most {max_lights} lights; seed {seed}",
            scenes.collect::<String>(),
            strategies.as_deref().unwrap_or("its own"),
        )
    }
}
