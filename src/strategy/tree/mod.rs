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
//! | how is a cluster weighed at a receiver? | `node`, [`importance`] |
//! | how is a light chosen, and with which probability? | `walk` |
//! | which clusters stand for all lights here? | `cut` |
//! | which for all lights, whatever the receiver around here? | `partition` |
//!
//! Sources: Conty Estevez and Kulla, Proc. ACM CGIT (HPG) 1(2), 2018; wide nodes as in Dammertz, Hanika, Keller, EGSR 2008.

mod bounds;
mod build;
pub mod cut;
pub mod importance;
mod node;
pub(super) mod partition;
mod split;
pub mod walk;

use crate::base::colour::luminance;
use crate::scene::Scene;
use crate::scene::light::{Kind, LightId};
use bounds::{Item, peak};
use glam::Vec3;
use importance::How;
use node::{Node, Slot};

// What `stability` holds to more digits.
#[cfg(feature = "measure")]
pub(crate) use {
    bounds::centred,
    cut::relative_variance,
    node::{STEP, steps},
};

/// A light tree of `N`-wide nodes.
pub struct Tree<const N: usize> {
    /// The root first, each node before what is below it. Empty without lights.
    nodes: Vec<Node<N>>,
    /// The lights, those of each node together.
    order: Vec<LightId>,
    directional: Vec<Directional>,
    /// Whole-number weights of the lights by peak intensity, in `order`, summed up to each and over all; empty where
    /// nothing is far.
    sums: Vec<u64>,
    how: How,
}

/// A light that is nowhere in the tree.
#[derive(Clone, Copy, Debug)]
struct Directional {
    light: LightId,
    towards: Vec3,
    /// Luminance of its irradiance, in lx.
    strength: f32,
}

impl<const N: usize> Tree<N> {
    /// The tree over `lights` of a scene. Lights of no intensity are left out: they add nothing anywhere.
    ///
    /// Uses all threads; the tree does not depend on how many. Nor does it on the scene's unit of length.
    pub fn new(scene: &Scene, lights: &[LightId], how: How) -> Self {
        let table = scene.lights();
        let directional = lights
            .iter()
            .map(|&light| (light, &table[light as usize]))
            .filter(|(_, of)| of.kind() == Kind::Directional)
            .map(|(light, of)| Directional { light, towards: of.position, strength: luminance(of.colour) })
            .collect();
        let mut items: Vec<Item> = lights.iter().filter_map(|&id| Item::new(id, &table[id as usize])).collect();
        let mut nodes = build::nodes(&mut items, how.facing);
        nodes.shrink_to_fit();
        let sums = if how.far > 0.0 { whole_sums(&items) } else { Vec::new() };
        Self { nodes, order: items.iter().map(|item| item.light).collect(), directional, sums, how }
    }

    /// Most nodes on a way from the root to a light.
    pub fn depth(&self) -> usize {
        fn below<const N: usize>(nodes: &[Node<N>], at: usize) -> usize {
            let deepest = (0..N).map(|j| match nodes[at].slot(j) {
                Slot::Node(offset) => below(nodes, at + offset as usize),
                Slot::Light(_) | Slot::Empty => 0,
            });
            1 + deepest.max().unwrap_or(0)
        }
        if self.nodes.is_empty() { 0 } else { below(&self.nodes, 0) }
    }

    /// The number of lights in the tree, without directional ones.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The lights in the tree's order, each with its peak intensity.
    pub(in crate::strategy) fn peaks(&self, scene: &Scene) -> impl Iterator<Item = (LightId, f32)> {
        self.order.iter().map(|&light| (light, peak(&scene.lights()[light as usize])))
    }

    /// The number of nodes; the root is node 0, each node before those below it.
    pub(in crate::strategy) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.order[..])
            + size_of_val(&self.directional[..])
            + size_of_val(&self.sums[..])
    }
}

/// Sums of the peaks as whole numbers, each 1 or more: differences of f64 sums would lose the weakest lights.
fn whole_sums(items: &[Item]) -> Vec<u64> {
    let total: f64 = items.iter().map(|item| f64::from(item.peak)).sum();
    let mut sum = 0;
    let ends = items.iter().map(|item| {
        sum += ((f64::from(item.peak) / total * 2f64.powi(62)) as u64).max(1);
        sum
    });
    std::iter::once(0).chain(ends).collect()
}
