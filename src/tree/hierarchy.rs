//! The tree itself: nodes, the order of its lights, and the lights that are nowhere in it.

use super::bounds::{Item, peak};
use super::build;
use super::how::How;
use super::node::{Node, Slot};
use crate::base::colour::luminance;
use crate::scene::Scene;
use crate::scene::light::{Kind, LightId};
use glam::Vec3;

/// A light tree of `N`-wide nodes.
pub struct Tree<const N: usize> {
    /// The root first, each node before what is below it. Empty without lights.
    pub(super) nodes: Vec<Node<N>>,
    /// The lights, those of each node together.
    order: Vec<LightId>,
    pub(super) directional: Vec<Directional>,
    pub(super) how: How,
}

/// A light that is nowhere in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directional {
    pub(super) light: LightId,
    pub(super) towards: Vec3,
    /// Luminance of its irradiance, in lx.
    pub(super) strength: f32,
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
        Self { nodes, order: items.iter().map(|item| item.light).collect(), directional, how }
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
    pub(crate) fn peaks(&self, scene: &Scene) -> impl Iterator<Item = (LightId, f32)> {
        self.order.iter().map(|&light| (light, peak(&scene.lights()[light as usize])))
    }

    /// The number of nodes; the root is node 0, each node before those below it.
    pub(crate) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.order[..]) + size_of_val(&self.directional[..])
    }
}
