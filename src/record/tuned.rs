//! Which parameters were found best for each strategy, for which kind of scene, and by what?
//!
//! A file of its own beside results: what one run found, another measures with, on cities that it was not found on.

use super::check::{Checked, Fault, count, wrong};
use super::interval::Interval;
use super::number;
use super::program::Program;
use super::store::{read_record, write_record};
use crate::base::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::path::Path;

/// Version of the file's layout; a file of another is refused.
pub(crate) const TUNED_SCHEMA: u32 = 1;

/// What parameters are found for: they are of no use elsewhere.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Condition {
    /// The recipe's name.
    pub recipe: String,
    /// Hash of the recipe, whatever its seed.
    pub hash: String,
    /// How many lights its cities have.
    pub lights: u64,
    /// Where receivers are: "centre", and which they are from pass to pass.
    pub receivers: String,
}

/// A city that parameters were found on: never one that is reported.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TuningCity {
    /// Seed of its generator.
    pub seed: u64,
    /// Hash of its content.
    pub hash: String,
}

/// The parameters of some strategies for one condition: everything in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Tuned {
    /// [`TUNED_SCHEMA`] of the writer.
    pub schema: u32,
    /// The program, where it is not this crate's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<Program>,
    /// The crate's version.
    pub version: String,
    /// Revision of the source.
    pub revision: String,
    /// Which rates counted work became seconds at.
    pub rates: u32,
    /// What it was done for.
    pub condition: Condition,
    /// Nominal CPU seconds of a run, set-up in, that the least error was looked for in.
    pub time_s: f64,
    /// Independent runs on each city that a choice, and then a score, rests on.
    pub runs: u32,
    /// The seed of the runs.
    pub seed: u64,
    /// The cities.
    pub cities: Vec<TuningCity>,
    /// What was found for each strategy.
    pub strategies: Vec<TunedStrategy>,
}

/// What was found for one strategy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TunedStrategy {
    /// It with the parameters that nobody tuned: the first point of its grid.
    pub default: String,
    /// It at the point with the least score when the choice was made; none where no point could be measured.
    pub best: Option<String>,
    /// The default's score over the best's, over the cities; none where they are one, or the default could not be
    /// measured.
    pub gain: Option<Interval>,
    /// The point that came next when the choice was made, and its score over the best's; none where nothing did.
    pub second: Option<Second>,
    /// All points, the default first.
    pub points: Vec<TunedPoint>,
}

/// What came next to the best.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Second {
    /// The strategy at that point.
    pub name: String,
    /// Its score over the best's, over the cities, by runs that neither was chosen by.
    pub over_best: Interval,
    /// Whether that interval leaves 1 out.
    pub told_apart: bool,
}

/// One point of a grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TunedPoint {
    /// The strategy there.
    pub name: String,
    /// Geometric mean over the cities of relMSE times nominal CPU seconds; none where it was not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub score: Option<f64>,
    /// The same by the runs that chose, where `score` and `cities` are of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen_by: Option<f64>,
    /// Why it was not measured to the end: too dear, failed, or so much worse that it was left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub out: Option<String>,
    /// What it came to on each city; empty where it was not measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cities: Vec<OnCity>,
}

/// What a point of a grid came to on one city.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OnCity {
    /// Passes of a run.
    pub passes: u32,
    /// Nominal CPU seconds of a run, set-up in.
    pub work_s: f64,
    /// Independent runs.
    pub runs: u32,
    /// Their mean relMSE.
    #[serde(with = "number")]
    pub rel_mse: f64,
    /// V as it counts in the score: relMSE at the time, times the time.
    pub v: f64,
}

/// Writes what was found, whole or not at all.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn write(path: &Path, tuned: &Tuned) -> Result<()> {
    write_record(path, tuned)
}

/// Reads what was found.
///
/// # Errors
/// A file that cannot be read; one of another schema, that no tuning wrote, or that cannot be what it says, with where.
pub(crate) fn read(path: &Path) -> Result<Tuned> {
    read_record(path, TUNED_SCHEMA).map_err(|error| match error {
        Error::Input { file, line, field, message } => {
            let message = format!("{message}; a file that `--tune` wrote is wanted");
            Error::Input { file, line, field, message }
        }
        other => other,
    })
}

impl Checked for Tuned {
    fn check(&self) -> std::result::Result<(), Fault> {
        count("runs", self.runs, [1, MOST_RUNS])?;
        if !(self.time_s.is_finite() && self.time_s > 0.0) {
            return Err(("time_s".into(), format!("is {}; a finite number above 0 is right", self.time_s)));
        }
        if self.cities.is_empty() {
            return Err(("cities".into(), "is empty; what was found was found on some".into()));
        }
        let mut defaults = HashSet::new();
        for (at, strategy) in self.strategies.iter().enumerate() {
            let place = format!("strategies[{at}]");
            if !defaults.insert(&strategy.default) {
                return Err(wrong(&place, "default", format!("`{}` is an earlier one's, too", strategy.default)));
            }
            of_strategy(&place, strategy, self.cities.len())?;
        }
        Ok(())
    }
}

/// Most runs that a file may speak of: many times those that are ever done.
const MOST_RUNS: u32 = 1 << 16;

fn of_strategy(place: &str, strategy: &TunedStrategy, cities: usize) -> std::result::Result<(), Fault> {
    let mut names = HashSet::new();
    for (at, point) in strategy.points.iter().enumerate() {
        let place = format!("{place}.points[{at}]");
        if !names.insert(point.name.as_str()) {
            return Err(wrong(&place, "name", format!("`{}` is an earlier point's, too", point.name)));
        }
        if !(point.cities.is_empty() || point.cities.len() == cities) {
            return Err(wrong(
                &place,
                "cities",
                format!("holds {}; {cities}, one each, or none is right", point.cities.len()),
            ));
        }
    }
    if strategy.points.first().is_none_or(|point| point.name != strategy.default) {
        return Err(wrong(place, "points", format!("does not begin with the default, `{}`", strategy.default)));
    }
    let second = strategy.second.as_ref().map(|second| &second.name);
    for (field, name) in [("best", strategy.best.as_ref()), ("second", second)] {
        if let Some(name) = name.filter(|name| !names.contains(name.as_str())) {
            return Err(wrong(place, field, format!("`{name}` is none of its points")));
        }
    }
    Ok(())
}
