//! Where is a set of lights best cut in two?
//!
//! By buckets along each axis, at the boundary of least cost. Decisions are the same for a scene in another unit of
//! length, whose coordinates are rounded otherwise: near-ties go to the first, boundaries keep off the regular grids
//! that cities are made of, and an axis along which the lights hardly differ is left alone.

use super::bounds::{Bounds, Item};
use glam::Vec3A;

/// Buckets along an axis.
const BUCKETS: usize = 16;

/// Two costs nearer to each other than this, relatively, are equal.
pub(super) const TIE: f64 = 1e-5;

/// Reorders the items so that those of one half come first; gives their number, neither 0 nor all. Needs two items or
/// more.
pub(super) fn split(items: &mut [Item]) -> usize {
    let middle = items.len() / 2;
    if items.len() == 2 {
        return middle;
    }
    let mut low = Vec3A::INFINITY;
    let mut high = Vec3A::NEG_INFINITY;
    for item in items.iter() {
        low = low.min(item.centre());
        high = high.max(item.centre());
    }
    let extent = high - low;
    let longest = extent.max_element();
    // In one place, or apart by rounding alone: any halves are as good as others.
    if longest <= 1e-6 * low.abs().max(high.abs()).max_element() {
        return middle;
    }
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| extent[axis] > 1e-3 * longest) {
        let scale = bucket_scale(extent[axis]);
        let mut buckets = [Bounds::NONE; BUCKETS];
        items.iter().for_each(|item| buckets[bucket(item, axis, low, scale)].add(item));
        // Thin slices of a long box are penalised, as in the source.
        let shape = f64::from(longest / extent[axis]);
        for (boundary, cost) in costs(&buckets) {
            let cost = shape * cost;
            if best.is_none_or(|(least, ..)| cost < least * (1.0 - TIE)) {
                best = Some((cost, axis, boundary));
            }
        }
    }
    let Some((_, axis, boundary)) = best else { return middle };
    let scale = bucket_scale(extent[axis]);
    partition(items, |item| bucket(item, axis, low, scale) < boundary)
}

/// Buckets a metre. The last one is cut short, and [`bucket`] starts within the first: an irrational grid.
fn bucket_scale(extent: f32) -> f32 {
    (BUCKETS as f32 - 0.618) / extent
}

fn bucket(item: &Item, axis: usize, low: Vec3A, scale: f32) -> usize {
    (((item.centre()[axis] - low[axis]) * scale + 0.271) as usize).min(BUCKETS - 1)
}

/// The boundaries between buckets that have items on both sides, each with the cost of the two sides.
fn costs(buckets: &[Bounds; BUCKETS]) -> impl Iterator<Item = (usize, f64)> {
    let filled = |bounds: &Bounds| bounds.peak > 0.0;
    // The cost of all from a bucket on; 0 where none follows.
    let mut after = [0.0; BUCKETS + 1];
    let mut right = Bounds::NONE;
    for i in (1..BUCKETS).rev() {
        after[i] = if filled(&buckets[i]) {
            right.union(&buckets[i]);
            right.cost()
        } else {
            after[i + 1]
        };
    }
    let right_ends = buckets.iter().rposition(filled).unwrap_or(0);
    let mut left = Bounds::NONE;
    (1..BUCKETS).filter_map(move |boundary| {
        // Behind an empty bucket the halves are the same as before it.
        if !filled(&buckets[boundary - 1]) || boundary > right_ends {
            return None;
        }
        left.union(&buckets[boundary - 1]);
        Some((boundary, left.cost() + after[boundary]))
    })
}

/// Puts those that are `first` before the others; gives their number.
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    let mut count = 0;
    for i in 0..items.len() {
        if first(&items[i]) {
            items.swap(count, i);
            count += 1;
        }
    }
    count
}
