//! Which studies are there?

use super::entry::Entry;
use super::{cutoff, elsewhere, offsets, scaling, soft_shadows, strategies, visible};
use crate::base::error::{Error, Result};

/// Every study, in the order of `citylights list studies`.
pub(crate) const STUDIES: [Entry; 7] = [
    strategies::ENTRY,
    visible::ENTRY,
    elsewhere::ENTRY,
    cutoff::ENTRY,
    scaling::ENTRY,
    soft_shadows::ENTRY,
    offsets::ENTRY,
];

/// The study of that name.
///
/// # Errors
/// An unknown name, with those that come near it.
pub(crate) fn find(name: &str) -> Result<Entry> {
    let unknown = || Error::unknown("study", name, STUDIES.iter().map(|entry| entry.name));
    STUDIES.into_iter().find(|entry| entry.name == name).ok_or_else(unknown)
}
