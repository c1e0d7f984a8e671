//! Is the arithmetic right where it is hardest?
//!
//! Named [`CASES`], each an extreme that breaks some renderer: what ours gives against the same in more digits, beside the
//! textbook's formula in f32 where there is one. [`vectors`] does the same for a file of triangles whose exact values are
//! known from elsewhere.
//!
//! Adding a case takes a function that returns a [`Finding`] and a line in [`CASES`].

mod bounds;
mod cases;
mod choices;
pub(crate) mod precise;
mod reach;
mod tally;
pub(crate) mod textbook;
#[cfg(feature = "study")]
pub(crate) mod tracer;
mod trees;
pub(crate) mod triangles;
pub(crate) mod vectors;

pub(crate) use cases::CASES;
pub(crate) use tally::{Finding, Tally};
