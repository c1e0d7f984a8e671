//! What everything else stands on: random streams, discrete distributions, numbers of double precision, triangles,
//! statistics, relative error, colour, files, errors.

pub mod colour;
pub mod discrete;
pub mod double;
pub mod draws;
pub mod error;
pub mod file;
pub mod names;
pub mod random;
pub mod rel_mse;
pub mod statistics;
pub mod triangle;
