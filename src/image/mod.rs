//! What is a picture, in which files does one lie, and how far are two apart?
//!
//! PNG is for the eye (exposure and the sRGB curve, 8 bits), EXR for numbers (linear, 32-bit floats, no exposure).
//!
//! | question | where |
//! |---|---|
//! | what is a picture, and how large may one be? | [`Picture`], [`MOST_PIXELS`] |
//! | and how many pixels may a file have? | `bound` |
//! | which format does a file's name ask for? | [`Format`] |
//! | how is a picture read and written, in any format? | [`read`], [`write`](write()) |
//! | and in one of them? | [`png`], [`exr`] |
//! | how far are two pictures apart, in figures? | [`metrics`] |
//! | and to an eye that flips between them? | [`flip`] |
//! | how are the errors of all pixels shown? | [`map`] |

mod bound;
pub(crate) mod exr;
mod file;
pub(crate) mod flip;
mod format;
pub(crate) mod map;
pub(crate) mod metrics;
mod picture;
pub(crate) mod png;

pub(crate) use file::read_within;
pub use file::{read, write};
pub use format::Format;
pub use picture::{MOST_PIXELS, Picture};
