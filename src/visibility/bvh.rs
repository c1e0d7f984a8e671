//! Boxes that `obvhs` builds well: padded, and never many alike.

use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;

use crate::base::random::Stream;
use std::time::Duration;

/// What a hierarchy is asked, which decides how much work its build is worth and how many boxes share a leaf.
///
/// Measured on one thread of an EPYC (Zen 5) at x86-64's baseline, by the library's own walk; `downtown`, in brackets
/// `metropolis`:
///
/// | asked | leaf | fast | medium | very slow |
/// |---|---|---|---|---|
/// | rays, million/s | 1 | 3.55 (2.40) | 3.57 (2.61) | 4.18 (3.05) |
/// | | 4 | 3.73 (2.56) | 3.71 (2.60) | **4.30 (3.18)** |
/// | | 8 | 3.69 (2.64) | 3.65 (2.65) | 4.23 (3.16) |
/// | build, ms | 4 | 4 (34) | 6 (50) | 40 (511) |
/// | points, ns | 1 | 573 (548) | 591 (519) | 577 (536) |
/// | | 8 | 331 (372) | 380 (365) | 362 (350) |
/// | | 16 | 315 (354) | **327 (334)** | 328 (342) |
/// | build, ms | 16 | 1 (28) | 2 (34) | 21 (446) |
///
/// The library's 32-byte nodes (`small_bvh2_node`) gave 4.24 million rays/s and 323 ns a point: no gain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asked {
    /// What does a segment meet? Rays are most of a pass: the slowest build pays, up to 200,000 boxes, where it would
    /// take seconds.
    Rays,
    /// Which boxes hold a point? A query mostly writes its list: no build is better than a medium one, a wide leaf is.
    Points,
}

/// A binary hierarchy over boxes given by their corners.
///
/// Boxes are padded by a few units in the last place, since rounding moves a triangle as a ray sees it. The builder
/// merges boxes that are nearest to each other. Of equal boxes, or of a straight even row in which each finds its left
/// neighbour as near as any, it merges one pair a pass: thousands would take quadratic time and become a list instead of a
/// tree. So all are grown a little, each in its own directions, and more where they occur more than [`ALIKE`] times.
///
/// No padding reaches farther than a shadow ray's start keeps off its surface, or nearly: rays that start within the boxes of
/// their own surface took a fifth longer. What grows with the distance is up to the ray ([`Pairs`](super::pairs)).
pub(super) fn build(corners: impl Iterator<Item = (Vec3, Vec3)>, asked: Asked) -> Bvh2 {
    let mut boxes: Vec<Aabb> = corners.map(|(low, high)| pad(low, high)).collect();
    let alike = separate(&mut boxes);
    unsettle(&mut boxes);
    let (leaf, preset) = match (asked, boxes.len()) {
        // Thousands of boxes around one place overlap whatever the tree: the slow builds search them for nothing
        // (30 s for 50,000).
        (Asked::Rays, _) if alike > 4_096 => (4, BvhBuildParams::fast_build()),
        (Asked::Points, _) if alike > 4_096 => (16, BvhBuildParams::fast_build()),
        (Asked::Rays, 0..200_000) => (4, BvhBuildParams::very_slow_build()),
        (Asked::Rays, 200_000..1_000_000) => (4, BvhBuildParams::medium_build()),
        (Asked::Rays, _) => (4, BvhBuildParams::fast_build()),
        (Asked::Points, 0..1_000_000) => (16, BvhBuildParams::medium_build()),
        (Asked::Points, _) => (16, BvhBuildParams::fast_build()),
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

/// The padded box around boxes given by their corners; empty around none.
pub(super) fn around(corners: impl Iterator<Item = (Vec3, Vec3)>) -> Aabb {
    corners.fold(Aabb::empty(), |all, (low, high)| all.union(&pad(low, high)))
}

/// Grows each box by up to a quarter of what it was padded by, so that no two neighbours are as near as the next two.
fn unsettle(boxes: &mut [Aabb]) {
    let mut stream = Stream::keyed(&[u64::from_le_bytes(*b"unsettle")]);
    for b in boxes {
        let grow = b.min.abs().max(b.max.abs()).max_element() * 1.2e-7;
        b.min -= grow * Vec3A::new(stream.uniform(), stream.uniform(), stream.uniform());
        b.max += grow * Vec3A::new(stream.uniform(), stream.uniform(), stream.uniform());
    }
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

#[cfg(all(test, feature = "cli"))]
mod tests {
    use super::*;
    use crate::promises::common::{IN_PROPORTION, times_as_long};

    #[test]
    fn an_even_row_builds_in_proportion_to_its_length() {
        for asked in [Asked::Rays, Asked::Points] {
            let low = |i: u32| Vec3::X * (2 * i) as f32;
            let built = |count| build((0..count).map(|i| (low(i), low(i) + Vec3::ONE)), asked);
            let times = times_as_long(|| drop(built(40_000)), || drop(built(4_000)));
            assert!(times < IN_PROPORTION, "{asked:?}: ten times as many take {times} times as long");
        }
    }

    #[test]
    fn coincident_boxes_build_a_shallow_tree_in_proportion_to_their_number() {
        for asked in [Asked::Rays, Asked::Points] {
            let built = |count| build((0..count).map(|_| (Vec3::splat(1.0), Vec3::splat(2.0))), asked);
            let times = times_as_long(|| drop(built(50_000)), || drop(built(5_000)));
            assert!(times < IN_PROPORTION, "{asked:?}: ten times as many take {times} times as long");
            let depth = built(50_000).max_depth;
            assert!(depth <= 96, "{asked:?}: depth {depth}: each query would allocate its stack");
        }
    }
}
