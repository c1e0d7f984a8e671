//! The same as a Markdown page, with the command and the conditions that it came from.

use super::table::{facts, sheets};
use crate::record::{Row, RunRecord, SceneRecord};
use std::fmt::Write;

/// The page of a scene in GitHub's Markdown; `plot` is the file name of its plot, in the same folder.
pub fn page(run: &RunRecord, scene: &SceneRecord, rows: &[Row], plot: &str) -> String {
    let mut text = format!("# {}\n\n", scene.name);
    facts(run, scene).iter().for_each(|fact| _ = writeln!(text, "- {fact}"));
    if !run.finished {
        text.push_str("- **not finished: some strategies or runs are missing**\n");
    }
    for note in scene.notes.iter().chain(&run.warnings) {
        _ = writeln!(text, "- **{note}**");
    }
    _ = write!(text, "\n![relMSE against CPU seconds]({plot})\n");
    for sheet in sheets(scene, rows) {
        _ = write!(text, "\n{}", sheet.markdown());
    }
    _ = write!(text, "\n## Made by\n\n```\n{}\n```\n\n", run.command);
    let machine = &run.machine;
    for (what, value) in [
        ("date", run.date.clone()),
        ("revision", run.revision.clone()),
        ("machine", format!("{}, {} cores, {}", machine.cpu, machine.cores, machine.os)),
        ("compiler", format!("{}; {}", run.compiler, run.flags)),
        ("seed", run.seed.to_string()),
    ] {
        _ = writeln!(text, "- {what}: {value}");
    }
    text
}
