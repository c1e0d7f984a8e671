//! Which rows are told apart, and what rank may each have?

use super::figure::Figure;
use crate::base::ranking::{self, Verdicts};

/// The chance that any pair of equal rows is told apart.
const LEVEL: f64 = 0.05;

/// Where a row stands.
pub(super) struct Place {
    /// First and last rank that the runs allow.
    pub(super) rank: [u32; 2],
    /// Shared with every row that it is not told apart from.
    pub(super) letters: String,
}

/// The places of rows by a figure of which less is better, in the order given.
pub(super) fn places(figures: &[Figure]) -> Vec<Place> {
    let mut order: Vec<usize> = (0..figures.len()).collect();
    order.sort_by(|&i, &j| figures[i].estimate.total_cmp(&figures[j].estimate));
    let bounds: Vec<_> = order.iter().map(|&i| move |confidence| figures[i].bounds(confidence)).collect();
    let sorted: Vec<ranking::Figure<'_>> = order
        .iter()
        .zip(&bounds)
        .map(|(&i, bounds)| ranking::Figure { estimate: figures[i].estimate, bounds })
        .collect();
    let verdicts = Verdicts::of(&sorted, LEVEL);
    let mut places: Vec<(usize, Place)> = order
        .into_iter()
        .zip(verdicts.ranks().into_iter().zip(verdicts.letters()))
        .map(|(i, ((first, last), letters))| (i, Place { rank: [first as u32, last as u32], letters }))
        .collect();
    places.sort_by_key(|(i, _)| *i);
    places.into_iter().map(|(_, place)| place).collect()
}
