//! What several contestants are made of; no strategy by itself.
//!
//! | question | where |
//! |---|---|
//! | lights drawn by fixed weights? | [`LightTable`] |
//! | lights drawn by what arrives from each? | `weighed` |
//! | which lights are in range, and picks among those? | `range`, `in_range` |
//! | a few of any number of lights, seen once each? | [`Reservoir`] |
//! | candidates of another strategy, and a choice among them? | `candidates`, `target_function` |
//! | walks down a light tree that begin among opened clusters? | `walks` |

pub(super) mod candidates;
pub(super) mod in_range;
pub(super) mod light_table;
pub(super) mod range;
pub(super) mod reservoir;
pub(super) mod target_function;
pub(super) mod walks;
pub(super) mod weighed;

pub use light_table::LightTable;
pub use reservoir::Reservoir;
