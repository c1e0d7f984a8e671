//! What is recorded of a comparison before anything is measured?

use super::home::Home;
use crate::record::environment;
use crate::record::{Machine, RunRecord, SCHEMA};

/// The record of a comparison by `plan`, with nothing in it yet.
pub(super) fn record(home: &Home<'_>, plan: String, seed: u64, repeats: u32) -> RunRecord {
    RunRecord {
        plan,
        schema: SCHEMA,
        command: home.command(),
        program: home.foreign(),
        date: environment::date(),
        version: environment::version(),
        revision: environment::revision(),
        seed,
        repeats,
        machine: Machine { cpu: environment::cpu(), cores: environment::cores(), os: environment::os() },
        compiler: environment::compiler(),
        flags: environment::flags(),
        base: None,
        parameters: None,
        warnings: environment::warnings(),
        finished: false,
        scenes: Vec::new(),
    }
}
