//! What everything else stands on: random streams, discrete distributions, numbers of double precision, triangles,
//! statistics, intervals, rankings, replicates, relative error, colour, files, errors.

pub mod claim;
pub mod colour;
pub mod counts;
pub mod discrete;
pub(crate) mod double_double;
pub mod draws;
pub mod error;
pub(crate) mod file;
#[cfg(feature = "measure")]
pub(crate) mod interval;
pub(crate) mod names;
#[cfg(feature = "gltf")]
pub(crate) mod polygon;
pub mod random;
#[cfg(feature = "measure")]
pub(crate) mod ranking;
pub(crate) mod rel_mse;
#[cfg(feature = "measure")]
pub(crate) mod replicates;
pub(crate) mod statistics;
pub(crate) mod triangle;
