//! What are the checks called?

use super::by_chance::BY_CHANCE;
use super::{arrival, contract, estimate, independent, metamorphic, seeds};

/// The names of the checks of strategies and of the arithmetic of a scene.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    let contract = contract::NAMES.into_iter().chain([seeds::ANOTHER, arrival::ORDER]);
    contract.chain(BY_CHANCE).chain([estimate::BIAS]).chain(independent::NAMES).chain(metamorphic::names())
}
