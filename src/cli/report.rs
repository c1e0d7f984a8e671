//! `citylights report`: tables and plots again from raw rows.

use super::outcome::Outcome;
use super::terminal::print;
use crate::report::{self, Section, splice};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(super) struct Arguments {
    /// The result folder, of a comparison or a study
    folder: PathBuf,
    /// Write nothing; fail if what is there differs from what the rows give
    #[arg(long)]
    check: bool,
    /// A Markdown file that holds a section for each scene or study, between marks of its own: results/README.md
    #[arg(long, value_name = "FILE")]
    splice: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let folder = &arguments.folder;
    let mut drifts: Vec<String> = Vec::new();
    if arguments.check {
        drifts.extend(report::check(folder)?.iter().map(ToString::to_string));
    } else {
        report::report(folder)?.iter().try_for_each(|file| print(&format!("{}\n", file.display())))?;
    }
    if let Some(page) = &arguments.splice {
        for Section { name, body } in report::sections(folder, page)? {
            if !arguments.check {
                splice::splice(page, &name, &body)?;
            } else if !splice::is_current(page, &name, &body)? {
                drifts.push(format!("{}: section `{name}` differs from the raw rows", page.display()));
            }
        }
    }
    drifts.iter().try_for_each(|drift| print(&format!("{drift}\n")))?;
    Ok(if drifts.is_empty() { Outcome::Done } else { Outcome::CheckFailed })
}
