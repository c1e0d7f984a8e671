//! A file whose bytes are at hand, and how it is told what is wrong with it.

use super::document::Document;
use super::source::Source;
use crate::base::error::Error;
use crate::sources::name;
use std::borrow::Cow;
use std::fmt::Display;

/// A file whose bytes are at hand.
pub(super) struct Reader<'a> {
    pub(super) source: Source<'a>,
    pub(super) document: &'a Document<'a>,
    pub(super) buffers: &'a [Cow<'a, [u8]>],
}

impl Reader<'_> {
    /// The scene's name, or the file's.
    pub(super) fn name(&self, given: Option<&str>) -> String {
        // Blender calls each scene so.
        let given = given.filter(|name| *name != "Scene").and_then(name::made_fit);
        let stem = || self.source.0.file_stem().and_then(|stem| name::made_fit(&stem.to_string_lossy()));
        given.or_else(stem).unwrap_or_else(|| "scene".into())
    }

    pub(super) fn wrong(&self, field: impl Display, message: impl Display) -> Error {
        self.source.wrong(field, message)
    }

    /// An error about a number that names nothing.
    pub(super) fn no_such(&self, what: &str, id: u32, count: usize, field: &dyn Display) -> Error {
        self.wrong(field, format_args!("there is no {what} {id}; the file has {count} of them, from 0"))
    }
}
