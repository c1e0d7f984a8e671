//! How do picks become radiance?
//!
//! A sampler fills a buffer of picks for a tile of receivers and a block of passes; one kernel, compiled for what the
//! scene needs, shades them. [`Film`](film::Film) sums in f64; [`exact`] is the reference that no sampler touches.

pub mod exact;
pub mod film;
pub(crate) mod kernel;
pub mod passes;
pub(crate) mod picture;
pub(crate) mod refined;
pub(crate) mod visit;
