//! The experiments behind `results/`: named, seeded, each with its question.
//!
//! A study opens its tables, fills them row by row and says in notes what a reader must know. Tables, page and plots
//! are then made from what it recorded, as for any result.
//!
//! Adding one takes a file here and a line in [`STUDIES`].

mod area;
mod cutoff;
pub mod fit;
mod offsets;
mod plane;
pub mod quality;
mod scaling;
mod soft_shadows;
mod strategies;
mod table;
pub mod trial;
mod visible;

use crate::base::error::{Error, Result};
use crate::base::names;
use crate::measure::clock::{Clock, Cpu};
use crate::measure::engine::Engine;
use crate::measure::environment;
use crate::measure::errors::Truth;
use crate::measure::observer::Observer;
use crate::measure::plan::Budget;
use crate::measure::reference::{Reference, Wanted, scene_hash};
use crate::measure::target::Target;
use crate::record::study::{STUDY_SCHEMA, Study, StudyRecord, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::record::{Machine, ResultFolder};
use crate::report;
use crate::scene::Scene;
use crate::scene::file::Overrides;
use crate::strategy::Role;
use crate::strategy::registry::{self, Configured, STRATEGIES};
use std::path::{Path, PathBuf};
use trial::{Budgets, Trial, Tried};

/// Every study, in the order of `citylights list studies`.
pub const STUDIES: [Entry; 6] =
    [strategies::ENTRY, visible::ENTRY, cutoff::ENTRY, scaling::ENTRY, soft_shadows::ENTRY, offsets::ENTRY];

/// A study that can be named.
#[derive(Clone, Copy)]
pub struct Entry {
    /// Its name, as typed.
    pub name: &'static str,
    /// What it asks.
    pub question: &'static str,
    run: fn(&Session<'_>) -> Result<Study>,
}

/// What a user may change; each study reads what makes sense for it.
#[derive(Clone, Debug)]
pub struct Options {
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
    /// Most counted work of a run, in [nominal seconds](crate::measure::work): a strategy that cannot do all passes in it
    /// does fewer.
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

impl Options {
    /// All of it that decides a study's cells, and the scenes' content.
    fn plan<'s>(&self, scenes: impl IntoIterator<Item = &'s Scene>) -> String {
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

/// Refuses scenes of one name: their rows could not be told apart.
fn told_apart(scenes: &[Scene]) -> Result<()> {
    let twice =
        scenes.iter().enumerate().find(|(i, scene)| scenes[..*i].iter().any(|other| other.name() == scene.name()));
    twice.map_or(Ok(()), |(_, scene)| {
        Err(Error::Invalid(format!("two scenes are named `{}`; rows could not be told apart", scene.name())))
    })
}

/// The study of that name.
pub fn find(name: &str) -> Result<Entry> {
    let unknown = || Error::Unknown {
        what: "study",
        name: name.to_owned(),
        near: names::near(name, STUDIES.iter().map(|entry| entry.name)),
    };
    STUDIES.into_iter().find(|entry| entry.name == name).ok_or_else(unknown)
}

impl Entry {
    /// Runs the study; `command` is what was typed.
    ///
    /// `folder` opens the folder that it is recorded in, which holds nothing yet or the same study, interrupted; it is
    /// called once all that was asked for has been read, so that a misspelt name leaves nothing behind.
    pub fn run(
        &self,
        options: &Options,
        command: String,
        folder: &dyn Fn() -> Result<ResultFolder>,
        watch: &dyn Observer,
    ) -> Result<Study> {
        (self.run)(&Session { entry: *self, options, command, folder, watch, clock: Cpu::new() })
    }
}

/// Most counted work of one reference, in nominal seconds: it takes rays for every light, so that among many lights errors
/// are taken at fewer receivers.
const REFERENCE_S: f64 = 100.0;

/// A study being run.
struct Session<'a> {
    entry: Entry,
    options: &'a Options,
    command: String,
    folder: &'a dyn Fn() -> Result<ResultFolder>,
    watch: &'a dyn Observer,
    /// From when the study began.
    clock: Cpu,
}

impl Session<'_> {
    /// Tries strategies on a target within what a run may spend.
    fn trial(
        &self,
        target: &Target<'_>,
        truth: &Truth,
        strategies: &[&Configured],
        budgets: Budgets,
    ) -> Result<Vec<Tried>> {
        let Options { passes, seconds, repeats, seed, .. } = *self.options;
        let budget = Budget::up_to(passes, seconds);
        let trial = Trial { engine: &self.engine(), target, truth, budget, runs: repeats, seed };
        trial.run(strategies, budgets, self.watch)
    }

    /// What times strategies.
    fn engine(&self) -> Engine<'_> {
        Engine { clock: &self.clock, workers: self.options.threads, seed: self.options.seed }
    }

    /// Opens the study's tables, filled as far as an interrupted study came; `scenes` are those that their cells depend
    /// on, beside what the study makes itself.
    fn open<'s>(&self, scenes: impl IntoIterator<Item = &'s Scene>, tables: Vec<TableRecord>) -> Result<StudyWriter> {
        let record = StudyRecord {
            schema: STUDY_SCHEMA,
            study: self.entry.name.to_owned(),
            question: self.entry.question.to_owned(),
            command: self.command.clone(),
            plan: self.options.plan(scenes),
            date: environment::date(),
            version: environment::version(),
            revision: environment::revision(),
            seed: self.options.seed,
            machine: Machine { cpu: environment::cpu(), cores: environment::cores(), os: environment::os() },
            compiler: environment::compiler(),
            flags: environment::flags(),
            warnings: environment::warnings(),
            finished: false,
            wall_s: 0.0,
            notes: Vec::new(),
            tables,
            pictures: Vec::new(),
        };
        StudyWriter::open((self.folder)()?, record)
    }

    /// Ends the study: page and plots first, then the word that it is finished.
    fn finish(&self, writer: StudyWriter) -> Result<Study> {
        let derive = |folder: &Path, study: &Study| report::write(folder, &report::derive_study(study)?);
        writer.finish(self.clock.wall_s(), derive)
    }

    /// How many receivers errors are taken at: what was asked for, or the study's `own`.
    fn pixels(&self, own: usize) -> usize {
        self.options.pixels.unwrap_or(own)
    }

    /// The recipes asked for, or `own`.
    fn scenes(&self, own: &[&str]) -> Vec<PathBuf> {
        if self.options.scenes.is_empty() {
            own.iter().map(PathBuf::from).collect()
        } else {
            self.options.scenes.clone()
        }
    }

    /// The strategies asked for, or every registered one that chooses, or is the floor under all that do, and
    /// `variants`.
    fn strategies(&self, variants: &[&str]) -> Result<Vec<Configured>> {
        if let Some(list) = &self.options.strategies {
            return registry::parse_list(list);
        }
        let own = STRATEGIES.iter().map(registry::Entry::info);
        let own = own.filter(|info| matches!(info.role, Role::Choosing | Role::Oracle)).map(|info| info.name);
        own.chain(variants.iter().copied()).map(registry::parse).collect()
    }

    /// What the radiance of a target is, far enough below the errors that are measured against it; of as many of its
    /// measured receivers as [`REFERENCE_S`] allow, and which those are.
    fn reference<'t>(&self, target: &Target<'t>) -> Result<(Target<'t>, Reference)> {
        // Errors lie above 1e-3, and are taken about two halves whose own noise cancels.
        Reference::bounded(target, Wanted { work_s: REFERENCE_S, ..Wanted::new(1e-4) }, &self.options.cache, self.watch)
    }
}
