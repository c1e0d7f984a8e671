//! Which checks may a right strategy fail by chance?

use super::check::Check;
use super::{contract, coverage, estimate, weights};

/// The checks of levels 0 and 1 that a right strategy may fail by chance.
pub(crate) const BY_CHANCE: [&str; 6] =
    [contract::PICKS, coverage::COVERAGE, weights::WEIGHTS, weights::TOTAL, estimate::ESTIMATE, estimate::IMAGE];

/// Whether other numbers could give another verdict.
pub(super) fn by_chance(check: &Check) -> bool {
    BY_CHANCE.contains(&check.name)
}
