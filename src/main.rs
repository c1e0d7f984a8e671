//! The `citylights` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    citylights::cli::run()
}
