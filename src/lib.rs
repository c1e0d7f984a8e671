//! Many-light strategies on night cities, measured: error against run time.

pub mod base;
#[cfg(feature = "image")]
pub mod image;
#[cfg(feature = "measure")]
pub mod record;
#[cfg(feature = "plots")]
pub mod report;
pub mod scene;
