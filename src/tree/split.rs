//! Where is a set of lights best cut in two?
//!
//! By buckets along each axis of their places and of the ways that they face, at the boundary of least cost. The headlights of a
//! street shine along it either way and stand among one another: places alone never tell apart those that shine here.
//! Decisions are the same for a scene in another unit of length, whose coordinates are rounded otherwise: near-ties go to the
//! first, boundaries keep off the regular grids that cities are made of, and an axis along which the lights hardly differ is
//! left alone.

use super::bounds::{Bounds, Item};
use glam::Vec3A;

/// Buckets along an axis.
const BUCKETS: usize = 16;

/// Two costs nearer to each other than this, relatively, are equal.
pub(super) const TIE: f64 = 1e-5;

/// Lights apart by less than this share of their distance from the origin are so by rounding alone.
const ROUNDING: f32 = 1e-6;

/// Lights whose unit directions differ by less face one way.
const ONE_WAY: f32 = 0.01;

/// Reorders the items so that those of one half come first; gives their number, neither 0 nor all. Needs two items or
/// more.
pub(super) fn split(items: &mut [Item]) -> usize {
    let middle = items.len() / 2;
    if items.len() == 2 {
        return middle;
    }
    let mut best: Option<(f64, Axis, usize)> = None;
    for axis in axes(items) {
        let mut buckets = [Bounds::NONE; BUCKETS];
        items.iter().for_each(|item| buckets[axis.bucket(item)].add(item));
        for (boundary, cost) in costs(&buckets) {
            let cost = axis.shape * cost;
            if best.is_none_or(|(least, ..)| cost < least * (1.0 - TIE)) {
                best = Some((cost, axis, boundary));
            }
        }
    }
    // In one place and facing one way: any halves are as good as others.
    let Some((_, axis, boundary)) = best else { return middle };
    partition(items, |item| axis.bucket(item) < boundary)
}

/// A number of each light, by which a set of them may be cut.
#[derive(Clone, Copy)]
struct Axis {
    of: Of,
    component: usize,
    low: f32,
    /// Buckets a unit.
    scale: f32,
    /// What costs are multiplied with.
    shape: f64,
}

/// What an axis is one of.
#[derive(Clone, Copy)]
enum Of {
    Place,
    Way,
}

impl Of {
    #[inline]
    fn vector(self, item: &Item) -> Vec3A {
        match self {
            Self::Place => item.centre(),
            Self::Way => item.axis,
        }
    }
}

/// The axes along which the items differ.
fn axes(items: &[Item]) -> impl Iterator<Item = Axis> {
    [Of::Place, Of::Way].into_iter().flat_map(|of| {
        let (mut low, mut high) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        for vector in items.iter().map(|item| of.vector(item)) {
            (low, high) = (low.min(vector), high.max(vector));
        }
        let extent = high - low;
        let longest = extent.max_element();
        let least = match of {
            Of::Place => ROUNDING * low.abs().max(high.abs()).max_element(),
            Of::Way => ONE_WAY,
        };
        // Thin slices of a long box are penalised, as in the source.
        let axis = move |component: usize| Axis {
            of,
            component,
            low: low[component],
            // The last one is cut short, and `bucket` starts within the first: an irrational grid.
            scale: (BUCKETS as f32 - 0.618) / extent[component],
            shape: f64::from(longest / extent[component]),
        };
        let differ = move |&component: &usize| longest > least && extent[component] > 1e-3 * longest;
        (0..3).filter(differ).map(axis)
    })
}

impl Axis {
    #[inline]
    fn bucket(&self, item: &Item) -> usize {
        let along = self.of.vector(item)[self.component] - self.low;
        ((along * self.scale + 0.271) as usize).min(BUCKETS - 1)
    }
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
