//! Can a record that was read be what it says?
//!
//! A record is a file like any other: what its numbers promise is held against one another before anything is made of it.

use super::files::file_name;
use super::parameters::{Parameters, TunedFamily};
use super::run::RunRecord;
use super::scene::SceneRecord;
use super::study::{StudyRecord, TableRecord};
use super::summary::Summary;
use std::collections::HashSet;
use std::fmt::Display;

/// A field that cannot be, and what would be right.
pub(super) type Fault = (String, String);

/// Most runs that a record may speak of: many times those that a comparison does.
const MOST_RUNS: u32 = 1 << 16;

/// Most passes, as many as can be asked for.
const MOST_PASSES: u32 = 1 << 24;

/// What can be read from a file and then be held against itself.
pub(super) trait Checked {
    /// Looks for what cannot be.
    fn check(&self) -> Result<(), Fault>;
}

impl Checked for RunRecord {
    fn check(&self) -> Result<(), Fault> {
        count("repeats", self.repeats, [1, MOST_RUNS])?;
        self.parameters.as_ref().map_or(Ok(()), of_parameters)?;
        let mut names = HashSet::new();
        for (at, scene) in self.scenes.iter().enumerate() {
            let place = format!("scenes[{at}]");
            if !names.insert(&scene.name) {
                return Err(wrong(&place, "name", format!("`{}` is an earlier scene's, too", scene.name)));
            }
            of_scene(&place, scene, self.repeats)?;
        }
        Ok(())
    }
}

impl Checked for StudyRecord {
    fn check(&self) -> Result<(), Fault> {
        let mut names = HashSet::new();
        for (at, table) in self.tables.iter().enumerate() {
            let place = format!("tables[{at}]");
            if !names.insert(&table.name) {
                return Err(wrong(&place, "name", format!("`{}` is an earlier table's, too", table.name)));
            }
            of_table(&place, table)?;
        }
        Ok(())
    }
}

/// Names of files are those that this program gives.
fn of_parameters(parameters: &Parameters) -> Result<(), Fault> {
    let (mut names, mut files) = (HashSet::new(), HashSet::new());
    for (at, TunedFamily { family, file, .. }) in parameters.tuned().iter().enumerate() {
        let place = format!("parameters.tuned[{at}]");
        if !names.insert(family) {
            return Err(wrong(&place, "family", format!("`{family}` is an earlier one's, too")));
        }
        if file_name(file) != *file || !file.ends_with(".json") || !files.insert(file) {
            return Err(wrong(&place, "file", format!("`{file}` is no name of a file of its own; `tuned.json` is")));
        }
    }
    Ok(())
}

fn of_scene(place: &str, scene: &SceneRecord, repeats: u32) -> Result<(), Fault> {
    let pixels = u64::from(scene.width) * u64::from(scene.height);
    let parts = [
        ("width", u64::from(scene.width), [1, u64::from(u32::MAX)]),
        ("height", u64::from(scene.height), [1, u64::from(u32::MAX)]),
        ("receivers", scene.receivers, [0, pixels]),
        ("pixels_measured", scene.pixels_measured, [0, scene.receivers]),
    ];
    parts.into_iter().try_for_each(|(field, value, right)| count(&format!("{place}.{field}"), value, right))?;
    let positive = [("errors", &scene.errors), ("times_s", &scene.times_s)];
    for (field, values) in positive {
        if let Some(value) = values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
            return Err(wrong(place, field, format!("holds {value}; finite numbers above 0 are right")));
        }
    }
    if !scene.errors.is_empty() {
        count(&format!("{place}.ranked_by"), scene.ranked_by as usize, [0, scene.errors.len() - 1])?;
    }
    let mut names = HashSet::new();
    for (at, summary) in scene.summaries.iter().enumerate() {
        let place = format!("{place}.summaries[{at}]");
        if !names.insert(&summary.strategy) {
            return Err(wrong(&place, "strategy", format!("`{}` is an earlier row's, too", summary.strategy)));
        }
        of_summary(&place, summary, repeats, scene.summaries.len() as u32)?;
    }
    Ok(())
}

fn of_summary(place: &str, summary: &Summary, repeats: u32, rows: u32) -> Result<(), Fault> {
    let field = |name: &str| format!("{place}.{name}");
    // The oracle's runs are its own.
    let most = if summary.receivers.is_some() { MOST_RUNS } else { repeats };
    count(&field("runs"), summary.runs, [0, most])?;
    count(&field("passes"), summary.passes, [0, MOST_PASSES])?;
    let mut least = 1;
    for (at, point) in summary.curve.iter().enumerate() {
        count(&field(&format!("curve[{at}].passes")), point.passes, [least, MOST_PASSES])?;
        least = point.passes + 1;
    }
    if let Some([first, last]) = summary.rank {
        count(&field("rank[0]"), first, [1, rows])?;
        count(&field("rank[1]"), last, [first, rows])?;
    }
    Ok(())
}

fn of_table(place: &str, table: &TableRecord) -> Result<(), Fault> {
    let mut names = HashSet::new();
    if let Some(twice) = table.columns.iter().find(|column| !names.insert(column.name.as_str())) {
        return Err(wrong(place, "columns", format!("`{}` stands twice; each name once is right", twice.name)));
    }
    for (at, plot) in table.plots.iter().enumerate() {
        let beside = plot.beside.iter().map(|(column, _)| column);
        let mut named = [&plot.series, &plot.x.column, &plot.y.column].into_iter().chain(beside);
        if let Some(column) = named.find(|column| !names.contains(column.as_str())) {
            return Err(wrong(place, &format!("plots[{at}]"), format!("there is no column `{column}` in the table")));
        }
    }
    Ok(())
}

pub(super) fn wrong(place: &str, field: &str, why: String) -> Fault {
    (format!("{place}.{field}"), why)
}

pub(super) fn count<T: Copy + PartialOrd + Display>(field: &str, value: T, [least, most]: [T; 2]) -> Result<(), Fault> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err((field.to_owned(), format!("is {value}; {least} to {most} are right")))
}
