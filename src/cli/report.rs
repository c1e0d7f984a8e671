//! `citylights report`: tables and plots again from raw rows.

use super::{Outcome, print};
use crate::record::store::{file_name, read_rows, read_run};
use crate::report::{self, section, splice};
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct Arguments {
    /// The result folder
    folder: PathBuf,
    /// Write nothing; fail if what is there differs from what the rows give
    #[arg(long)]
    check: bool,
    /// A Markdown file that holds a section for each scene, between marks of its own: results/README.md
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
        let (run, rows) = (read_run(folder)?, read_rows(folder)?.rows);
        for scene in &run.scenes {
            let plot = seen_from(page, &folder.join(format!("{}.svg", file_name(&scene.name))));
            let body = section(&run, scene, &rows, &plot);
            if !arguments.check {
                splice::splice(page, &scene.name, &body)?;
            } else if !splice::is_current(page, &scene.name, &body)? {
                drifts.push(format!("{}: section `{}` differs from the raw rows", page.display(), scene.name));
            }
        }
    }
    drifts.iter().try_for_each(|drift| print(&format!("{drift}\n")))?;
    Ok(if drifts.is_empty() { Outcome::Done } else { Outcome::CheckFailed })
}

/// The address of `file` in a page: relative where both share the page's folder.
fn seen_from(page: &Path, file: &Path) -> String {
    let near = page.parent().and_then(|folder| file.strip_prefix(folder).ok()).unwrap_or(file);
    near.display().to_string()
}
