//! What everything else stands on: random streams, discrete distributions, numbers of double precision, triangles,
//! statistics, intervals, rankings, relative error, colour, files, errors.

pub mod claim;
pub mod colour;
pub mod counts;
pub mod discrete;
pub mod double_double;
pub mod draws;
pub mod error;
pub mod file;
#[cfg(feature = "measure")]
pub mod interval;
pub mod names;
pub mod random;
#[cfg(feature = "measure")]
pub mod ranking;
pub mod rel_mse;
pub mod statistics;
pub mod triangle;
