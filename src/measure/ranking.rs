//! Which rows are told apart, and what rank may each have?

use super::figure::Figure;

/// Where a row stands.
pub(super) struct Place {
    /// First and last rank that the runs allow.
    pub rank: [u32; 2],
    /// Shared with every row that it is not told apart from.
    pub letters: String,
}

/// The places of rows by a figure of which less is better.
pub(super) fn places(figures: &[Figure]) -> Vec<Place> {
    figures.iter().map(|_| Place { rank: [1, figures.len() as u32], letters: "a".into() }).collect()
}
