//! What does a point of a light add at a receiver?

pub mod contribution;
pub mod importance;
