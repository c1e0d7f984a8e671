//! Which rows are told apart, and what rank may each have?

use super::figure::Figure;
use crate::base::ranking::{self, Place, Verdicts};

/// The chance that any pair of equal rows is told apart.
const LEVEL: f64 = 0.05;

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
    ranking::places(&order, &Verdicts::of(&sorted, LEVEL))
}
