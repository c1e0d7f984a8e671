//! The same in Markdown: a page for a scene, and a shorter section for a page that people write.

use super::facts::{facts, warnings};
use super::markdown;
use super::table::sheets;
use crate::record::{Program, Row, RunRecord, SceneRecord};
use std::fmt::Write;

/// The page of a scene in GitHub's Markdown, with the command and the conditions that it came from.
///
/// `plot` is the address of its plot as seen from the page; `rows` may hold other scenes too.
pub(crate) fn page(run: &RunRecord, scene: &SceneRecord, rows: &[Row], plot: &str) -> String {
    let mut text = opening("#", run, scene, plot);
    for sheet in sheets(scene, rows) {
        _ = write!(text, "\n{}", sheet.markdown(2));
    }
    text + &made_by(run)
}

/// The command and the conditions that figures came from.
pub(super) fn made_by(run: &RunRecord) -> String {
    let machine = &run.machine;
    let mut text = format!("\n## Made by\n\n{}\n\n", markdown::block(&run.command));
    let made = [
        format!("date: {}", run.date),
        format!("revision: {}", built(run.program.as_ref(), &run.version, &run.revision)),
        format!("machine: {}, {} cores, {}", machine.cpu, machine.cores, machine.os),
        format!("compiler: {}; {}", run.compiler, run.flags),
        format!("seed: {}", run.seed),
    ];
    made.iter().for_each(|line| _ = writeln!(text, "- {}", markdown::plain(line)));
    text
}

/// A scene in short, for [`splice`](super::splice::splice): what was measured, the plot, error against time, the
/// command.
///
/// `plot` is the address of its plot as seen from the page.
pub(crate) fn section(run: &RunRecord, scene: &SceneRecord, rows: &[Row], plot: &str) -> String {
    let mut text = opening("##", run, scene, plot);
    if let Some(answer) = sheets(scene, rows).first() {
        _ = write!(text, "\n{}", answer.markdown(3));
    }
    let place = format!("({}, revision {}, {})", run.date, run.revision, run.machine.cpu);
    _ = writeln!(text, "\nMade by {} {}.", markdown::code(&run.command), markdown::plain(&place));
    text
}

/// What a program was built from; older records know no version.
pub(super) fn built(program: Option<&Program>, version: &str, revision: &str) -> String {
    let version = if version.is_empty() { String::new() } else { format!(", version {version}") };
    let of = |program: &Program| {
        let Program { name, version, revision } = program;
        format!("{revision} of `{name}`, version {version}; of citylights ")
    };
    format!("{}{revision}{version}", program.map(of).unwrap_or_default())
}

/// Name, facts, notes, warnings and plot.
fn opening(heading: &str, run: &RunRecord, scene: &SceneRecord, plot: &str) -> String {
    let mut text = format!("{heading} {}\n\n", markdown::plain(&scene.name));
    let facts = facts(run, scene);
    facts.iter().chain(&scene.notes).for_each(|fact| _ = writeln!(text, "- {}", markdown::plain(fact)));
    warnings(run, scene).iter().for_each(|warning| _ = writeln!(text, "- **{}**", markdown::plain(warning)));
    _ = write!(text, "\n![{}: relMSE against CPU seconds]({plot})\n", markdown::label(&scene.name));
    text
}
