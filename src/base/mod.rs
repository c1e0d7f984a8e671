//! What everything else stands on: random streams, discrete distributions, triangles, statistics, colour, files, errors.

pub mod colour;
pub mod discrete;
pub mod draws;
pub mod error;
pub mod file;
pub mod names;
pub mod random;
pub mod statistics;
pub mod triangle;
