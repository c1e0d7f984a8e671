//! Which lights are in range of a point?
//!
//! A bounding-volume hierarchy over the lights' influence volumes lists them in O(log n + listed). Directional lights
//! have no range: they stand in a list beside it and are always in range.

use super::bvh::{self, Asked};
use crate::scene::Scene;
use crate::scene::influence::{Cutoff, Influence};
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
        let mut everywhere = Vec::new();
        let mut volumes = Vec::with_capacity(lights.len());
        for &id in lights {
            match cutoff.volume(&scene.lights()[id as usize]) {
                Some(volume) => volumes.push((volume, id)),
                None => everywhere.push(id),
            }
        }
        let bvh = bvh::build(volumes.iter().map(|(volume, _)| volume.bounds()), Asked::Points);
        let volumes = bvh.primitive_indices.iter().map(|&i| volumes[i as usize]).collect();
        Self { bvh, volumes, everywhere }
    }

    /// Appends to `out` the lights in range of `point`, each once, in an order that depends on the point alone.
    #[inline]
    pub fn list(&self, point: Vec3, out: &mut Vec<LightId>) {
        out.extend_from_slice(&self.everywhere);
        self.bvh.point_traverse(point.into(), |bvh, node| {
            let node = &bvh.nodes[node as usize];
            let first = node.first_index as usize;
            for (volume, id) in &self.volumes[first..first + node.prim_count as usize] {
                if volume.contains(point) {
                    out.push(*id);
                }
            }
            true
        });
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.bvh.nodes[..])
            + size_of_val(&self.bvh.primitive_indices[..])
            + size_of_val(&self.volumes[..])
            + size_of_val(&self.everywhere[..])
    }
}
