//! Which lights are in range of a point?
//!
//! A bounding-volume hierarchy over the lights' influence volumes lists them in O(log n + listed). Directional lights
//! have no range: they stand in a list beside it and are always in range.

use super::bvh::{self, Asked};
use crate::scene::Scene;
use crate::scene::cutoff::{Cutoff, Influence};
use crate::scene::light::LightId;
use glam::Vec3;
use obvhs::bvh2::Bvh2;

/// The hierarchy over influence volumes.
pub struct InfluenceTree {
    bvh: Bvh2,
    /// In the hierarchy's order, with the lights they belong to.
    volumes: Vec<(Influence, LightId)>,
    everywhere: Vec<LightId>,
}

impl InfluenceTree {
    /// Builds the hierarchy over some lights of a scene.
    pub fn new(scene: &Scene, lights: &[LightId], cutoff: Cutoff) -> Self {
        let (volumes, everywhere) = cutoff.volumes(scene, lights);
        let bvh = bvh::build(volumes.iter().map(|(volume, _)| volume.bounds()), Asked::Points);
        let volumes = bvh.primitive_indices.iter().map(|&i| volumes[i as usize]).collect();
        Self { bvh, volumes, everywhere }
    }

    /// The same lights with other squared radii, in the same hierarchy, refitted: O(n), without a build.
    pub(crate) fn resized(&self, radius2: impl Fn(&Influence, LightId) -> f32) -> Self {
        let resize = |&(volume, id): &(Influence, LightId)| (Influence { radius2: radius2(&volume, id), ..volume }, id);
        let volumes: Vec<(Influence, LightId)> = self.volumes.iter().map(resize).collect();
        let mut bvh = self.bvh.clone();
        for node in bvh.nodes.iter_mut().filter(|node| node.is_leaf()) {
            let first = node.first_index as usize;
            let leaf = &volumes[first..first + node.prim_count as usize];
            node.set_aabb(bvh::around(leaf.iter().map(|(volume, _)| volume.bounds())));
        }
        bvh.refit_all();
        Self { bvh, volumes, everywhere: self.everywhere.clone() }
    }

    /// Appends to `out` the lights in range of `point`, each once, in an order that depends on the point alone.
    #[inline]
    pub fn list(&self, point: Vec3, out: &mut Vec<LightId>) {
        out.extend_from_slice(&self.everywhere);
        self.visit(point, |_, id| out.push(id));
    }

    /// Shows each light whose volume holds `point` to `see`; gives the leaves visited.
    #[inline]
    pub fn visit(&self, point: Vec3, mut see: impl FnMut(&Influence, LightId)) -> u64 {
        let mut leaves = 0;
        self.bvh.point_traverse(point.into(), |bvh, node| {
            leaves += 1;
            let node = &bvh.nodes[node as usize];
            let first = node.first_index as usize;
            for (volume, id) in &self.volumes[first..first + node.prim_count as usize] {
                if volume.contains(point) {
                    see(volume, *id);
                }
            }
            true
        });
        leaves
    }

    /// The lights that have a range, with their volumes.
    pub fn lights(&self) -> impl Iterator<Item = (&Influence, LightId)> {
        self.volumes.iter().map(|(volume, id)| (volume, *id))
    }

    /// The lights that are in range everywhere: they have no volume.
    pub fn everywhere(&self) -> &[LightId] {
        &self.everywhere
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.bvh.nodes[..])
            + size_of_val(&self.bvh.primitive_indices[..])
            + size_of_val(&self.volumes[..])
            + size_of_val(&self.everywhere[..])
    }
}
