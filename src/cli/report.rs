//! `citylights report`: tables and plots again from raw rows.

use super::{Outcome, print};
use crate::report;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(super) struct Arguments {
    /// The result folder
    folder: PathBuf,
    /// Write nothing; fail if what is there differs from what the rows give
    #[arg(long)]
    check: bool,
    /// Put the tables into this Markdown file too, between its marks
    #[arg(long, value_name = "FILE")]
    splice: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    todo_report(arguments)
}
