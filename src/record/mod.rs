//! The raw facts of a comparison, as they lie on disk: which values, in which units, in which schema.
//!
//! A result folder holds `run.json` (a [`RunRecord`]: what was run, where, and what needs all runs together) and
//! `runs.csv` (one [`Row`] per strategy, run and budget). Tables, pages and plots are made again from these two alone.
//! Numbers are in base units, with the unit in the name: `cpu_s`, `heap_bytes`; shares and relMSE have none. A
//! [`study`]'s folder holds `study.json` and a CSV file a table in the same manner.

pub mod folder;
pub mod interval;
mod number;
mod origin;
pub mod row;
pub mod run;
pub mod scene;
pub mod store;
pub mod study;
pub mod study_store;
pub mod summary;

pub use folder::{Kind, ResultFolder};
pub use interval::Interval;
pub use row::Row;
pub use run::{Machine, RunRecord};
pub use scene::{ReferenceRecord, SceneRecord, SharedWork};
pub use summary::{Claim, Counts, Point, Read, Reading, Summary};

/// Version of the files' layout; files of another version are refused, never guessed at.
pub const SCHEMA: u32 = 2;
