//! May a run go on with what an earlier one left?

use super::program::Program;
use super::run::{Machine, RunRecord};
use super::study::StudyRecord;
use crate::base::error::{Error, Result};
use std::path::Path;

/// All that decides rows: two runs that share it may fill one folder.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Origin<'a> {
    plan: &'a str,
    program: Option<&'a Program>,
    version: &'a str,
    revision: &'a str,
    compiler: &'a str,
    flags: &'a str,
    machine: &'a Machine,
}

impl RunRecord {
    pub(super) fn origin(&self) -> Origin<'_> {
        let Self { plan, program, version, revision, compiler, flags, machine, .. } = self;
        Origin { plan, program: program.as_ref(), version, revision, compiler, flags, machine }
    }
}

impl StudyRecord {
    pub(super) fn origin(&self) -> Origin<'_> {
        let Self { plan, program, version, revision, compiler, flags, machine, .. } = self;
        Origin { plan, program: program.as_ref(), version, revision, compiler, flags, machine }
    }
}

/// Refuses to go on in `folder` where `own` is not the origin of what is there: a `what`, begun by `command`.
pub(super) fn check(folder: &Path, what: &str, command: &str, earlier: &Origin<'_>, own: &Origin<'_>) -> Result<()> {
    if earlier == own {
        return Ok(());
    }
    let parts = [
        ("scenes or options", earlier.plan == own.plan),
        ("program", earlier.program == own.program),
        ("machine", earlier.machine == own.machine),
        ("version", earlier.version == own.version),
        ("revision", earlier.revision == own.revision),
        ("compiler", earlier.compiler == own.compiler),
        ("build flags", earlier.flags == own.flags),
    ];
    let others: Vec<&str> = parts.iter().filter(|(_, same)| !same).map(|(name, _)| *name).collect();
    Err(Error::Invalid(format!(
        "{} holds another {what}, begun as `{command}` (other {}); results are never overwritten: go on with that one, or \
         name another folder",
        folder.display(),
        others.join(", ")
    )))
}
