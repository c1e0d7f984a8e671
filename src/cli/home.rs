//! Whose command line is this?

use crate::record::Program;
use crate::strategy::Registry;

/// What every verb is handed.
pub(super) struct Home<'a> {
    /// The strategies that can be named.
    pub(super) registry: &'a Registry,
    /// The program that runs.
    pub(super) program: &'a Program,
}

impl Home<'_> {
    /// What was typed, for records: as it can be typed again.
    pub(super) fn command(&self) -> String {
        let plain = |c: char| c.is_alphanumeric() || "-_./:=,+%@;".contains(c);
        let quoted = |text: String| {
            if !text.is_empty() && text.chars().all(plain) {
                text
            } else {
                format!("'{}'", text.replace('\'', "'\\''"))
            }
        };
        let arguments = std::env::args_os().skip(1).map(|argument| quoted(argument.to_string_lossy().into_owned()));
        std::iter::once(self.program.name.clone()).chain(arguments).collect::<Vec<_>>().join(" ")
    }

    /// The program for records: none where it is this crate's own.
    pub(super) fn foreign(&self) -> Option<Program> {
        self.program.is_foreign().then(|| self.program.clone())
    }
}
