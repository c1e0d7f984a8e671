//! Which raw facts does a comparison leave on disk: which values, in which units, in which schema?
//!
//! A result folder holds `run.json` (a `RunRecord`: what was run, where, and what needs all runs together) and
//! `runs.csv` (one `Row` per strategy, run and budget). Tables, pages and plots are made again from these two alone.
//! Numbers are in base units, with the unit in the name: `cpu_s`, `heap_bytes`; shares and relMSE have none. A
//! `study`'s folder holds `study.json` and a CSV file a table in the same manner.
//!
//! | question | where |
//! |---|---|
//! | where and by what is it measured? | `environment` |
//! | what was run, by what, where? | `RunRecord`, [`Program`], `Machine` |
//! | what is known of a scene? | [`SceneRecord`] |
//! | what of a strategy on it, after all runs, and how far off may it be? | [`Summary`], [`Interval`] |
//! | what did one run come to? | `Row` |
//! | what did a study come to? | `study` |
//! | which folders hold results, and who writes in one? | `ResultFolder` |
//! | how do a comparison and a study survive an interruption? | `store`, `study_store` |
//! | may a run go on with what an earlier one left? | `origin` |
//! | which version of which files is it? | `SCHEMA`, `files` |
//! | can a record that was read be what it says? | `check` |
//! | which parameters were found best, and for what? | `tuned` |
//! | how were the parameters of a comparison chosen? | `Parameters` |
//! | how does JSON hold infinity and NaN? | `number` |

mod check;
pub(crate) mod environment;
mod files;
pub(crate) mod folder;
pub(crate) mod interval;
mod number;
mod origin;
mod parameters;
mod program;
pub(crate) mod row;
pub(crate) mod run;
pub(crate) mod scene;
mod schema;
pub(crate) mod store;
pub(crate) mod study;
pub(crate) mod study_store;
pub(crate) mod summary;
pub(crate) mod tuned;

pub use crate::base::counts::Counts;
pub(crate) use folder::{Kind, ResultFolder};
pub use interval::Interval;
pub(crate) use parameters::{Parameters, TunedFamily};
pub use program::Program;
pub(crate) use row::Row;
pub(crate) use run::{Machine, RunRecord};
pub use scene::{ReferenceRecord, SceneRecord, SharedWork};
pub(crate) use schema::SCHEMA;
pub use summary::{Point, Read, Reading, Summary};
