//! Which lights, near or far, are worth choosing here, in O(log n)?
//!
//! A hierarchy of clusters of lights. A node holds up to `N` slots, each a cluster or a single light, with what bounds its
//! lights: box, directions, strength. A walk from the root weighs the slots of a node at a receiver, chooses one and goes on
//! in it; the probability of a light is the product of the shares on its way. The weights are *conservative*: 0 only where
//! no light of the slot can add anything, so every light that adds something can be chosen.
//!
//! Directional lights are nowhere in space. They stand beside the root's slots and are weighed exactly.
//!
//! | question | where |
//! |---|---|
//! | what bounds a set of lights, and how much do they differ from one another? | `bounds` |
//! | which lights belong together? | `split`, `build` |
//! | what is the tree, then? | [`Tree`] |
//! | how is a cluster weighed at a receiver? | [`How`], `node`, `importance` |
//! | how is a light chosen, and with which probability? | [`Walk`], [`Memory`] |
//! | which clusters stand for all lights here? | [`Cut`] |
//! | which for all lights, whatever the receiver around here? | `partition` |
//!
//! Sources: Conty Estevez and Kulla, Proc. ACM CGIT (HPG) 1(2), 2018; wide nodes as in Dammertz, Hanika, Keller, EGSR 2008.

mod bounds;
mod build;
mod cut;
mod hierarchy;
mod how;
mod importance;
mod memory;
mod node;
mod partition;
mod split;
mod walk;

pub(crate) use cut::{Below, Cluster, Cut, Part};
pub use hierarchy::Tree;
pub use how::{Distance, Facing, How, Weighing};
pub use memory::Memory;
pub(crate) use memory::{ALMOST_ONE, LEAST_SHARE, USED_UP};
pub(crate) use partition::{Divided, Element, Region};
pub use walk::Walk;
// What `stability` holds to more digits.
#[cfg(feature = "measure")]
pub(crate) use {
    bounds::centred,
    cut::relative_variance,
    node::{STEP, steps},
};
