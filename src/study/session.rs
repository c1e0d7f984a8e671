//! What does a study have while it runs: what was asked for, who watches, and where its rows go?

use super::options::StudyOptions;
use super::trial::{Budgets, Trial, Tried};
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::measure::clock::{Clock, Cpu};
use crate::measure::engine::Engine;
use crate::measure::errors::Truth;
use crate::measure::observer::Observer;
use crate::measure::plan::Budget;
use crate::measure::reference::{Reference, Wanted};
use crate::measure::target::Target;
use crate::record::environment;
use crate::record::study::{STUDY_SCHEMA, Study, StudyRecord, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::record::{Machine, ResultFolder};
use crate::report;
use crate::scene::Scene;
use crate::strategy::Configured;
use std::path::{Path, PathBuf};

/// Most counted work of one reference, in nominal seconds: it takes rays for every light, so that among many lights
/// errors are taken at fewer receivers.
const REFERENCE_S: f64 = 100.0;

/// A study being run.
pub(super) struct Session<'a> {
    /// The study's name, as typed.
    pub(super) name: &'static str,
    /// What it asks.
    pub(super) question: &'static str,
    pub(super) options: &'a StudyOptions,
    pub(super) command: String,
    pub(super) folder: &'a dyn Fn() -> Result<ResultFolder>,
    pub(super) watch: &'a dyn Observer,
    /// From when the study began.
    pub(super) clock: Cpu,
}

impl Session<'_> {
    /// Tries strategies on a target within what a run may spend.
    pub(super) fn trial(
        &self,
        target: &Target<'_>,
        truth: &Truth,
        strategies: &[&Configured],
        budgets: Budgets,
    ) -> Result<Vec<Tried>> {
        let StudyOptions { passes, seconds, repeats, seed, .. } = *self.options;
        let budget = Budget::up_to(passes, seconds);
        let trial = Trial { engine: &self.engine(), target, truth, budget, runs: repeats, seed };
        trial.run(strategies, budgets, self.watch)
    }

    /// What times strategies.
    pub(super) fn engine(&self) -> Engine<'_> {
        Engine { clock: &self.clock, workers: self.options.threads, seed: self.options.seed }
    }

    /// Opens the study's tables, filled as far as an interrupted study came; `scenes` are those that their cells depend
    /// on, beside what the study makes itself.
    pub(super) fn open<'s>(
        &self,
        scenes: impl IntoIterator<Item = &'s Scene>,
        tables: Vec<TableRecord>,
    ) -> Result<StudyWriter> {
        let record = StudyRecord {
            schema: STUDY_SCHEMA,
            study: self.name.to_owned(),
            question: self.question.to_owned(),
            command: self.command.clone(),
            plan: self.options.plan(scenes),
            date: environment::date(),
            program: self.options.program.clone(),
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
    pub(super) fn finish(&self, writer: StudyWriter) -> Result<Study> {
        let derive = |folder: &Path, study: &Study| report::write(folder, &report::derive_study(study)?);
        writer.finish(self.clock.wall_s(), derive)
    }

    /// How many receivers errors are taken at: what was asked for, or the study's `own`.
    pub(super) fn pixels(&self, own: usize) -> usize {
        self.options.pixels.unwrap_or(own)
    }

    /// The recipes asked for, or `own`.
    pub(super) fn scenes(&self, own: &[&str]) -> Vec<PathBuf> {
        if self.options.scenes.is_empty() {
            own.iter().map(PathBuf::from).collect()
        } else {
            self.options.scenes.clone()
        }
    }

    /// The strategies asked for, or every registered one that chooses, or is the floor under all that do, and
    /// `variants`.
    pub(super) fn strategies(&self, variants: &[&str]) -> Result<Vec<Configured>> {
        if let Some(list) = &self.options.strategies {
            return self.options.registry.parse_list(list);
        }
        let own = self.options.registry.infos();
        let own = own.filter(|info| info.claim.chooses() || info.claim == Claim::Oracle).map(|info| info.name);
        own.chain(variants.iter().copied()).map(|name| self.options.registry.parse(name)).collect()
    }

    /// What the radiance of a target is, far enough below the errors that are measured against it; of as many of its
    /// measured receivers as [`REFERENCE_S`] allow, and which those are.
    pub(super) fn reference<'t>(&self, target: &Target<'t>) -> Result<(Target<'t>, Reference)> {
        // Errors lie above 1e-3, and are taken about two halves whose own noise cancels.
        Reference::bounded(target, Wanted { work_s: REFERENCE_S, ..Wanted::new(1e-4) }, &self.options.cache, self.watch)
    }
}
