//! What was run, by what, where.

use super::parameters::Parameters;
use super::program::Program;
use super::scene::SceneRecord;
use serde::{Deserialize, Serialize};

/// Where the figures come from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// Cores that the run could use.
    pub cores: u32,
    /// Operating system and its version.
    pub os: String,
}

/// One call of the tool: everything in `run.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunRecord {
    /// [`SCHEMA`](super::SCHEMA) of the writer.
    pub schema: u32,
    /// The command line.
    pub command: String,
    /// All that decides the rows, in canonical form: content of the scenes, strategies, budgets, options. An
    /// interrupted run is resumed only by one that asks for the same.
    pub plan: String,
    /// Day of the run, `2026-11-22`.
    pub date: String,
    /// The program, where it is not this crate's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<Program>,
    /// The crate's version; empty in records that are older than this field.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub version: String,
    /// Revision of the source.
    pub revision: String,
    /// The user's seed.
    pub seed: u64,
    /// Independent runs asked for.
    pub repeats: u32,
    /// Where it ran.
    pub machine: Machine,
    /// The compiler and its version.
    pub compiler: String,
    /// Flags that change the code: target features, profile.
    pub flags: String,
    /// The strategy that others are held against over many cities and views; none where there was one of each, or no
    /// unbiased strategy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<String>,
    /// How the strategies' parameters were chosen; none where no strategy has any to choose among, and in records that are
    /// older than this field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameters: Option<Parameters>,
    /// What makes the figures doubtful: a busy machine, a debug build.
    pub warnings: Vec<String>,
    /// Whether it came to its end; otherwise some rows are missing.
    pub finished: bool,
    /// The scenes, in the order asked for.
    pub scenes: Vec<SceneRecord>,
}
