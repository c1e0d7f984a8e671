//! Boxes that `obvhs` builds well: padded, and never many alike.

use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;

use crate::base::random::Stream;
use std::time::Duration;

/// A binary hierarchy over boxes given by their corners; leaves hold up to `leaf` boxes.
///
/// Boxes are padded by a few units in the last place, since the slab test has no error bound of its own. The builder
/// merges one pair of equal boxes a pass: thousands of coincident lights or triangles would take quadratic time and
/// build a list instead of a tree. So boxes that occur more than [`ALIKE`] times are grown a little, each in its own directions.
pub(super) fn build(corners: impl Iterator<Item = (Vec3, Vec3)>, leaf: u32) -> Bvh2 {
    let mut boxes: Vec<Aabb> = corners.map(|(low, high)| pad(low, high)).collect();
    let alike = separate(&mut boxes);
    let preset = match boxes.len() {
        // Thousands of boxes around one place overlap whatever the tree: the slow builds search them for nothing
        // (30 s for 50,000).
        _ if alike > 4_096 => BvhBuildParams::fast_build(),
        // Measured on 10,000 lights: a slow build makes shadow rays 1.4 times as fast and takes 0.1 s; beyond 200,000
        // boxes it would take seconds.
        0..200_000 => BvhBuildParams::very_slow_build(),
        200_000..1_000_000 => BvhBuildParams::medium_build(),
        _ => BvhBuildParams::fast_build(),
    };
    build_bvh2(&boxes, BvhBuildParams { max_prims_per_leaf: leaf, ..preset }, &mut Duration::default())
}

/// How often a box may occur as it is: the two triangles of a quad share one.
const ALIKE: usize = 4;

fn pad(low: Vec3, high: Vec3) -> Aabb {
    let size = low.abs().max(high.abs()).max_element();
    // 2^-21 of the coordinate is about four units in the last place.
    let margin = Vec3A::splat(size * 4.8e-7 + 1e-7);
    Aabb::new(Vec3A::from(low) - margin, Vec3A::from(high) + margin)
}

/// Grows the boxes that occur too often; gives how many they are.
fn separate(boxes: &mut [Aabb]) -> usize {
    let key = |b: &Aabb| (b.min.to_array().map(f32::to_bits), b.max.to_array().map(f32::to_bits));
    let mut order: Vec<_> = boxes.iter().map(key).zip(0u32..).collect();
    order.sort_unstable();
    let mut stream = Stream::keyed(&[u64::from_le_bytes(*b"separate")]);
    let mut grown = 0;
    for alike in order.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() > ALIKE) {
        grown += alike.len();
        for &(_, i) in alike {
            let b = &mut boxes[i as usize];
            let scale = (b.max - b.min).max_element() * 1e-3 + b.min.abs().max(b.max.abs()).max_element() * 1e-5 + 1e-6;
            // All grow by the same, shared out between the low and the high side: the union of two boxes then exceeds
            // each by how far apart their shares are, and the builder sees points spread in space.
            let share = Vec3A::new(stream.uniform(), stream.uniform(), stream.uniform());
            b.min -= share * scale;
            b.max += (1.0 - share) * scale;
        }
    }
    grown
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    #[test]
    fn coincident_boxes_build_a_shallow_tree_quickly() {
        let start = Instant::now();
        let bvh = build((0..50_000).map(|_| (Vec3::splat(1.0), Vec3::splat(2.0))), 1);
        assert!(start.elapsed().as_secs_f32() < 5.0, "{:?}", start.elapsed());
        assert!(bvh.max_depth <= 96, "depth {}: each query would allocate its stack", bvh.max_depth);
    }
}
