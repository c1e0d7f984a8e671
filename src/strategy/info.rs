//! What a strategy says of itself.

/// What a strategy promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// The contract holds for every light.
    Unbiased,
    /// It does not, for this reason.
    Biased(&'static str),
}

/// What part a strategy plays in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It chooses among lights.
    Choosing,
    /// It does nothing: the floor of the harness's own cost.
    Floor,
    /// It takes every light: the ceiling.
    Ceiling,
    /// It chooses by what it cannot know without paying for it: the floor under every error, never timed.
    Oracle,
}

/// What a strategy is, apart from its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Info {
    /// Its name, as typed.
    pub name: &'static str,
    /// What it does, in a line.
    pub summary: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// What it promises.
    pub claim: Claim,
    /// Its part in a comparison.
    pub role: Role,
}
