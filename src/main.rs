//! The `citylights` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    citylights::cli::run_with(&citylights::strategy::Registry::standard(), &citylights::program!())
}
