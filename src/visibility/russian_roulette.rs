//! Which lights have a random range that reaches a point?
//!
//! A light whose influence radius is r reaches a distance d with probability `min(1, (r/d)^2)`. A hierarchy over the
//! lights' centres knows of each node an upper bound of that, from its nearest point and its greatest radius. Going
//! down, a child is entered with its bound over its parent's, so that each light survives with exactly its own
//! probability, and a far city costs a few nodes.
//!
//! Source: hierarchical Russian roulette, Tokuyoshi and Harada, Comput. Graph. Forum 38(7), 2019.

use super::bvh::{self, Asked};
use crate::base::random::Stream;
use crate::scene::Scene;
use crate::scene::cutoff::{Cutoff, Influence};
use crate::scene::light::LightId;
use glam::Vec3;
use obvhs::bvh2::Bvh2;

/// Lights that survive with the probability that they reach a point.
pub(crate) struct RussianRoulette {
    bvh: Bvh2,
    /// In the hierarchy's order, with the lights they belong to.
    volumes: Vec<(Influence, LightId)>,
    /// Greatest squared radius below each node, in m^2.
    widest2: Vec<f32>,
    everywhere: Vec<LightId>,
}

/// Nodes to be visited, each with the bound it was entered with.
#[derive(Default)]
pub(crate) struct Stack(Vec<(u32, f32)>);

impl RussianRoulette {
    /// Builds the hierarchy over some lights of a scene.
    pub(crate) fn new(scene: &Scene, lights: &[LightId], cutoff: Cutoff) -> Self {
        let (volumes, everywhere) = cutoff.volumes(scene, lights);
        let bvh = bvh::build(volumes.iter().map(|(volume, _)| (volume.centre, volume.centre)), Asked::Points);
        let volumes: Vec<_> = bvh.primitive_indices.iter().map(|&i| volumes[i as usize]).collect();
        let mut widest2 = vec![0.0f32; bvh.nodes.len()];
        for node_id in from_the_root(&bvh).into_iter().rev() {
            let node = &bvh.nodes[node_id];
            let first = node.first_index as usize;
            widest2[node_id] = if node.is_leaf() {
                volumes[first..first + node.prim_count as usize].iter().fold(0.0, |most, (v, _)| most.max(v.radius2))
            } else {
                widest2[first].max(widest2[first + 1])
            };
        }
        Self { bvh, volumes, widest2, everywhere }
    }

    /// Shows each light that survives at `point` to `see`, with the probability that it does; gives the nodes visited.
    #[inline]
    pub(crate) fn survivors(
        &self,
        point: Vec3,
        rng: &mut Stream,
        stack: &mut Stack,
        mut see: impl FnMut(LightId, f32),
    ) -> u64 {
        self.everywhere.iter().for_each(|id| see(*id, 1.0));
        let stack = &mut stack.0;
        stack.clear();
        stack.reserve(self.bvh.max_depth + 2);
        let mut visited = 0;
        // Entered with its bound given that its parent was entered with `parent`.
        let enter = |stack: &mut Vec<(u32, f32)>, node: u32, parent: f32, rng: &mut Stream| {
            let bound = self.bound(node, point);
            if bound >= parent || rng.uniform64() * f64::from(parent) < f64::from(bound) {
                stack.push((node, bound));
            }
        };
        if !self.bvh.nodes.is_empty() {
            enter(stack, 0, 1.0, rng);
        }
        while let Some((index, bound)) = stack.pop() {
            visited += 1;
            let node = &self.bvh.nodes[index as usize];
            let first = node.first_index;
            if !node.is_leaf() {
                enter(stack, first, bound, rng);
                enter(stack, first + 1, bound, rng);
                continue;
            }
            for (volume, id) in &self.volumes[first as usize..(first + node.prim_count) as usize] {
                let chance = chance(volume, point);
                if chance > 0.0 && (chance >= bound || rng.uniform64() * f64::from(bound) < f64::from(chance)) {
                    see(*id, chance);
                }
            }
        }
        visited
    }

    /// Each light with the probability that it survives at `point`.
    pub(crate) fn chances(&self, point: Vec3) -> impl Iterator<Item = (LightId, f32)> {
        let local = self.volumes.iter().map(move |(volume, id)| (*id, chance(volume, point)));
        self.everywhere.iter().map(|id| (*id, 1.0)).chain(local)
    }

    /// Bytes on the heap.
    pub(crate) fn heap_bytes(&self) -> usize {
        size_of_val(&self.bvh.nodes[..])
            + size_of_val(&self.bvh.primitive_indices[..])
            + size_of_val(&self.volumes[..])
            + size_of_val(&self.widest2[..])
            + size_of_val(&self.everywhere[..])
    }

    /// No light below a node survives with a greater probability. Of the same operations as [`chance`], each of which
    /// keeps the order of its operands, so that this holds after rounding too.
    #[inline]
    fn bound(&self, node: u32, point: Vec3) -> f32 {
        let aabb = self.bvh.nodes[node as usize].aabb();
        let outside = (Vec3::from(aabb.min) - point).max(point - Vec3::from(aabb.max)).max(Vec3::ZERO);
        reached(self.widest2[node as usize], outside)
    }
}

/// All nodes, each after its parent.
fn from_the_root(bvh: &Bvh2) -> Vec<usize> {
    let mut order: Vec<usize> = (0..bvh.nodes.len().min(1)).collect();
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        let node = &bvh.nodes[node];
        if !node.is_leaf() {
            order.extend([node.first_index as usize, node.first_index as usize + 1]);
        }
        next += 1;
    }
    order
}

/// The probability that a light's random range reaches a point; 0 on its dark side.
#[inline]
pub(crate) fn chance(volume: &Influence, point: Vec3) -> f32 {
    let to_point = point - volume.centre;
    if volume.axis.dot(to_point) < 0.0 { 0.0 } else { reached(volume.radius2, to_point.abs()) }
}

/// `min(1, r^2 / d^2)` for a vector of length d.
#[inline]
fn reached(radius2: f32, way: Vec3) -> f32 {
    let distance2 = way.x * way.x + way.y * way.y + way.z * way.z;
    if distance2 <= radius2 { 1.0 } else { radius2 / distance2 }
}
