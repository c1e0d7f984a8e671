//! One parameter of a strategy.

/// A parameter that a strategy has read: what it is and what it became.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// The value in use.
    pub value: String,
    /// The value where none is given.
    pub default: String,
    /// What may be given: `1 to 1024`, `linear|srgb`.
    pub allowed: String,
    /// What it means, with its unit.
    pub meaning: &'static str,
}
