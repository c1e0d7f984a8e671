//! How far apart are two pictures to an eye that flips between them?
//!
//! FLIP gives each pixel a difference from 0 to 1: of colour, after what the eye cannot resolve at this distance is
//! filtered away, raised where edges or points differ.
//!
//! Sources: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for
//! Alternating Images", HPG 2020; for high dynamic range Andersson, Nilsson, Shirley and Akenine-Möller, "Visualizing
//! Errors in Rendered High Dynamic Range Images", Eurographics 2021. `tests/exchange/flip.rs` holds figures of the authors' own
//! program.
//!
//! | question | where |
//! |---|---|
//! | what does the eye see of the colours at this distance, and how far are two of them apart? | `filter`, `colour` |
//! | where are edges and points? | `feature` |
//! | how far apart are two pictures as they are displayed? | [`ldr`](ldr()), [`PIXELS_PER_DEGREE`] |
//! | and at every exposure that shows the reference? | [`hdr`], [`Exposures`] |
//! | what does a map of differences come to? | [`Pooled`] |

mod colour;
mod exposure;
mod feature;
mod filter;
mod ldr;
mod pooled;

pub(crate) use exposure::{Exposures, hdr};
pub(crate) use ldr::{MOST_PIXELS_PER_DEGREE, PIXELS_PER_DEGREE, ldr};
pub(crate) use pooled::Pooled;
