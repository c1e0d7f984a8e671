//! What can be seen from where: occluders and shadow rays, the points that the camera sees, the lights in range.

mod bvh;
pub mod influence_tree;
pub mod occluders;
pub mod offset;
mod pairs;
pub(crate) mod reach;
pub(crate) mod russian_roulette;
pub mod stage;
mod triangle;
pub mod view;
pub(crate) mod visits;
