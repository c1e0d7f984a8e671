//! Which layout do the files of a comparison have?

/// Version of the files' layout; files of another version are refused, never guessed at.
pub(crate) const SCHEMA: u32 = 2;
