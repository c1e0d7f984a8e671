//! Many-light strategies on night cities, measured: error against run time.

pub mod base;
pub mod scene;
