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
pub mod precise;
mod reach;
mod tally;
pub mod textbook;
#[cfg(feature = "study")]
pub(crate) mod tracer;
mod trees;
pub mod triangles;
pub mod vectors;

pub use cases::{CASES, Case};
pub use tally::{Finding, Tally};
