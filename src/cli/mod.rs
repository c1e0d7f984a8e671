//! The command line: one file a verb.
//!
//! Data on stdout, progress on stderr. Exit code 0: done; 1: a check failed; 2: wrong usage or bad input; 130:
//! interrupted.

mod compare;
mod diff_image;
mod export;
mod inspect;
mod list;
mod progress;
mod reference;
mod render;
mod report;
mod scene;
mod stability;
mod study;
mod verify;

use crate::base::error::Error;
use clap::{Parser, Subcommand};
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
    /// What is in a scene, and what can be left out of it
    Inspect(inspect::Arguments),
    /// Write a scene for another renderer: glTF, pbrt or Mitsuba
    Export(export::Arguments),
    /// The experiments behind results/, by name
    Study(study::Arguments),
    /// Name the strategies, the scenes or the studies
    List(list::Arguments),
    /// Make tables and plots again from the raw rows of a result folder
    Report(report::Arguments),
}

/// What a verb came to.
enum Outcome {
    Done,
    /// A check that the user asked for has failed; the text was printed.
    CheckFailed,
}

/// Runs the command line of this process.
pub fn run() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match &cli.verb {
        Verb::Compare(arguments) => compare::run(arguments),
        Verb::Verify(arguments) => verify::run(arguments),
        Verb::Stability(arguments) => stability::run(arguments),
        Verb::Render(arguments) => render::run(arguments),
        Verb::Reference(arguments) => reference::run(arguments),
        Verb::DiffImage(arguments) => diff_image::run(arguments),
        Verb::Inspect(arguments) => inspect::run(arguments),
        Verb::Export(arguments) => export::run(arguments),
        Verb::Study(arguments) => study::run(arguments),
        Verb::List(arguments) => list::run(arguments),
        Verb::Report(arguments) => report::run(arguments),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::CheckFailed) => ExitCode::from(1),
        Err(error) => {
            say(&format!("citylights: {error}"));
            let interrupted = matches!(error.downcast_ref::<Error>(), Some(Error::Interrupted));
            ExitCode::from(if interrupted { 130 } else { 2 })
        }
    }
}

/// What was typed, for records.
fn command() -> String {
    let arguments = std::env::args_os().skip(1).map(|argument| argument.to_string_lossy().into_owned());
    std::iter::once("citylights".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// Tells the user something on stderr; one that has been closed is no error.
fn say(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Prints to stdout; a reader that has gone away (`| head`) is no error.
fn print(text: &str) -> anyhow::Result<()> {
    use std::io::Write;
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(e.into()),
        _ => Ok(()),
    }
}
