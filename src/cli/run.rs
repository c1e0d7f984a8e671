//! Which verb was typed, and which exit code does it end with?

use super::home::Home;
use super::outcome::Outcome;
use super::progress::INTERRUPTED;
use super::terminal::say;
use super::{
    compare, diff_image, explain, export, inspect, lecture, list, new_strategy, reference, render, report, stability,
    study, verify,
};
use crate::base::error::Error;
use crate::record::Program;
use crate::strategy::Registry;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::process::ExitCode;

/// Many-light strategies on night cities, measured: error against run time.
#[derive(Parser)]
#[command(name = "citylights", version, propagate_version = true, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Error against run time, all strategies in one table: the main job
    Compare(compare::Arguments),
    /// Every strategy against its contract: exit code 1 if a check fails
    Verify(verify::Arguments),
    /// The arithmetic in extreme cases against high precision: exit code 1 if an error is beyond its limit
    Stability(stability::Arguments),
    /// Render a scene with one strategy
    Render(render::Arguments),
    /// The exact image and its standard error, cached
    Reference(reference::Arguments),
    /// How far a picture is from another: MSE, relMSE, FLIP
    DiffImage(diff_image::Arguments),
    /// Each pick of a strategy at a pixel, beside what each light really adds there
    Explain(explain::Arguments),
    /// What is in a scene, and what can be left out of it
    Inspect(inspect::Arguments),
    /// Write a scene for another renderer: glTF, pbrt or Mitsuba
    Export(export::Arguments),
    /// The experiments behind results/, by name
    Study(study::Arguments),
    /// The labelled picture of a chapter of docs/LECTURE.md: shadows, area lights, many lights
    Lecture(lecture::Arguments),
    /// Write a crate with a strategy of your own
    NewStrategy(new_strategy::Arguments),
    /// Name the strategies, the scenes, the studies or the chapters of the lecture
    List(list::Arguments),
    /// Make tables and plots again from the raw rows of a result folder
    Report(report::Arguments),
}

/// Runs the command line of this process: all verbs, with the strategies of a registry, for a program of one's own.
///
/// ```no_run
/// use citylights::strategy::Registry;
///
/// fn main() -> std::process::ExitCode {
///     citylights::cli::run_with(&Registry::standard(), &citylights::program!())
/// }
/// ```
pub fn run_with(registry: &Registry, program: &Program) -> ExitCode {
    let named = Cli::command().name(program.name.clone()).bin_name(program.name.clone());
    let matches = named.version(program.version.clone()).get_matches();
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    let home = &Home { registry, program };
    let outcome = match &cli.verb {
        Verb::Compare(arguments) => compare::run(arguments, home),
        Verb::Verify(arguments) => verify::run(arguments, home),
        Verb::Stability(arguments) => stability::run(arguments),
        Verb::Render(arguments) => render::run(arguments, home),
        Verb::Reference(arguments) => reference::run(arguments),
        Verb::DiffImage(arguments) => diff_image::run(arguments),
        Verb::Explain(arguments) => explain::run(arguments, home),
        Verb::Inspect(arguments) => inspect::run(arguments),
        Verb::Export(arguments) => export::run(arguments),
        Verb::Study(arguments) => study::run(arguments, home),
        Verb::Lecture(arguments) => lecture::run(arguments, home),
        Verb::NewStrategy(arguments) => new_strategy::run(arguments, home),
        Verb::List(arguments) => list::run(arguments, home),
        Verb::Report(arguments) => report::run(arguments),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::CheckFailed) => ExitCode::from(1),
        Err(error) => {
            say(&format!("{}: {error}", program.name));
            let interrupted = matches!(error.downcast_ref::<Error>(), Some(Error::Interrupted));
            ExitCode::from(if interrupted { INTERRUPTED } else { 2 })
        }
    }
}
