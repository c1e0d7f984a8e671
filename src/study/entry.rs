//! What is a study, and how is it run?

use super::options::StudyOptions;
use super::session::Session;
use crate::base::error::Result;
use crate::measure::clock::Cpu;
use crate::measure::observer::Observer;
use crate::record::ResultFolder;
use crate::record::study::Study;

/// A study that can be named.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    /// Its name, as typed.
    pub name: &'static str,
    /// What it asks.
    pub question: &'static str,
    /// What runs it.
    pub(super) run: fn(&Session<'_>) -> Result<Study>,
}

impl Entry {
    /// Runs the study; `command` is what was typed.
    ///
    /// `folder` opens the folder that it is recorded in, which holds nothing yet or the same study, interrupted; it is
    /// called once all that was asked for has been read, so that a misspelt name leaves nothing behind.
    ///
    /// # Errors
    /// A misspelt name; a recipe with a mistake, or that the study can measure nothing on; an error of `folder`;
    /// another study in it; a file that cannot be read or written; the user's wish to stop.
    pub(crate) fn run(
        &self,
        options: &StudyOptions,
        command: String,
        folder: &dyn Fn() -> Result<ResultFolder>,
        watch: &dyn Observer,
    ) -> Result<Study> {
        let Self { name, question, run } = *self;
        run(&Session { name, question, options, command, folder, watch, clock: Cpu::new() })
    }
}
