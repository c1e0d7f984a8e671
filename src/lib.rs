//! Many-light strategies on night cities, measured: error against run time.

#![forbid(unsafe_code)]

pub mod base;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "image")]
pub mod image;
#[cfg(feature = "measure")]
pub mod measure;
#[cfg(feature = "measure")]
pub mod record;
pub mod render;
#[cfg(feature = "plots")]
pub mod report;
pub mod scene;
pub mod shading;
pub mod strategy;
#[cfg(feature = "measure")]
pub mod verify;
pub mod visibility;
