//! Scenes made ready as the program makes them.

use crate::base::error::Result;
use crate::sources::{Overrides, open};
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use std::path::Path;

/// The scene of a file.
pub(super) fn stage(file: &Path) -> Result<Stage> {
    Ok(Stage::new(open(file, &Overrides::default())?, LeaveOut::Yes, Offset::SCALED))
}

/// A short name of a scene's file for benchmarks: `first-night` of `scenes/first-night.toml`.
pub(super) fn name(file: &Path) -> String {
    file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}
