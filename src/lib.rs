//! Many-light strategies on night cities, measured: error against run time.

#![forbid(unsafe_code)]

pub mod base;
pub mod render;
pub mod scene;
pub mod shading;
pub mod strategy;
#[cfg(feature = "measure")]
pub mod verify;
pub mod visibility;
