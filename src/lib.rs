//! Many-light strategies on night cities, measured: error against run time.

pub mod base;
pub mod render;
pub mod scene;
pub mod shading;
pub mod strategy;
pub mod visibility;
