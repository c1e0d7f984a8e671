//! What a strategy says of itself.

use crate::base::claim::Claim;

/// What a strategy is, apart from its parameters.
#[derive(Clone, Debug)]
pub struct Info {
    /// Its name, as typed.
    pub name: &'static str,
    /// What it does, in a line.
    pub summary: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// What it promises.
    pub claim: Claim,
}
