//! What does a point of a light add at a receiver?

pub(crate) mod by_angle;
pub mod contribution;
pub mod importance;
