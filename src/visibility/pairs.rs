//! Which boxes of a hierarchy does a ray pass?
//!
//! A binary hierarchy, laid out for rays: the two boxes below a node stand in one line of the cache, and are asked
//! together.
//!
//! # No box is passed by that holds a triangle which the ray meets
//!
//! The distance at which a ray comes to a side of a box is rounded three times (difference, inverse, product): it is right to
//! a share of 1.5 units (of 2^-23). What [`Triangle::meet`](super::triangle::Triangle::meet) says is true of a triangle whose
//! corners are moved across the ray: of one that is wholly ahead, by two units of how far the ray has gone aside and by two
//! of its greatest coordinate. Boxes are padded by four of the latter ([`bvh::build`](super::bvh::build)). The former moves the
//! distance by a share of two units. So it is right to a share of 3.5 units, and a box counts as passed where a ray leaves
//! it, later by [`SLACK`], no sooner than it enters.
//!
//! Source: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, whose bound is that of the slabs alone.

use glam::{Vec4, Vec4Swizzles};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::fast_stack;
use obvhs::faststack::FastStack;
use obvhs::ray::Ray;
use std::ops::ControlFlow;

/// By how much later than computed a ray may leave a box: seven units, and one for its own rounding.
const SLACK: f32 = 1.0 + 8.0 * f32::EPSILON;

/// Two boxes and what is in them.
#[repr(C, align(64))]
struct Pair {
    /// On each axis the low sides of both boxes, then their high sides.
    sides: [Vec4; 3],
    below: [Below; 2],
}

/// What is in a box.
#[derive(Clone, Copy)]
struct Below {
    /// The first of its triangles, or the pair that its box is made of.
    first: u32,
    /// How many triangles, or [`PAIR`].
    count: u32,
}

const PAIR: u32 = u32::MAX;

const NOTHING: Below = Below { first: 0, count: 0 };

/// A hierarchy of boxes.
pub(super) struct Pairs {
    /// The root first.
    pairs: Vec<Pair>,
    /// How many pairs lie below one another.
    depth: usize,
}

impl Pairs {
    /// That of a library's hierarchy.
    pub(super) fn new(bvh: &Bvh2) -> Self {
        let node = |index: u32| &bvh.nodes[index as usize];
        let of = |node: &Bvh2Node| Below { first: node.first_index, count: node.prim_count };
        let mut this = Self { pairs: Vec::with_capacity(bvh.nodes.len() / 2 + 1), depth: 1 };
        let Some(root) = bvh.nodes.first() else {
            this.pairs.push(Pair { sides: [Vec4::ZERO; 3], below: [NOTHING; 2] });
            return this;
        };
        if root.is_leaf() {
            this.pairs.push(Pair { sides: sides(root, root), below: [of(root), NOTHING] });
            return this;
        }
        // Depth first, so that what a ray visits next is often near in memory.
        let mut open = vec![(root.first_index, None, 1)];
        while let Some((first, above, depth)) = open.pop() {
            let (number, both) = (this.pairs.len(), [node(first), node(first + 1)]);
            this.depth = this.depth.max(depth);
            if let Some((pair, side)) = above {
                let pair: &mut Pair = &mut this.pairs[pair];
                pair.below[side] = Below { first: number as u32, count: PAIR };
            }
            this.pairs.push(Pair { sides: sides(both[0], both[1]), below: both.map(of) });
            let inner = [1, 0].into_iter().filter(|&side| !both[side].is_leaf());
            open.extend(inner.map(|side| (both[side].first_index, Some((number, side)), depth + 1)));
        }
        this
    }

    /// Bytes on the heap.
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.pairs[..])
    }

    /// Asks each triangle whose box a ray passes, about from the nearest on, until one stops it; an answer may let the ray
    /// end sooner from then on.
    #[inline(always)]
    pub(super) fn walk(&self, ray: &Ray, ask: impl FnMut(usize, &mut f32) -> ControlFlow<()>) {
        fast_stack!(u32, (96, 192), self.depth, stack, { self.walk_with(&mut stack, ray, ask) });
    }

    #[inline(always)]
    fn walk_with(
        &self,
        stack: &mut impl FastStack<u32>,
        ray: &Ray,
        mut ask: impl FnMut(usize, &mut f32) -> ControlFlow<()>,
    ) {
        let origin = [0, 1, 2].map(|axis| Vec4::splat(ray.origin[axis]));
        let inverse = [0, 1, 2].map(|axis| Vec4::splat(ray.inv_direction[axis]));
        let (mut end, mut current) = (ray.tmax, 0);
        loop {
            let pair = &self.pairs[current as usize];
            let [x, y, z] = [0, 1, 2].map(|axis| (pair.sides[axis] - origin[axis]) * inverse[axis]);
            // Of both boxes, twice over.
            let near = smaller(x).max(smaller(y)).max(smaller(z)).max(Vec4::ZERO);
            let far = larger(x).min(larger(y)).min(larger(z)) * SLACK;
            let passed = (near.cmple(far) & near.cmplt(Vec4::splat(end))).bitmask();
            let (mut first, mut second) = ((pair.below[0], passed & 1 != 0), (pair.below[1], passed & 2 != 0));
            if near.x > near.y {
                (first, second) = (second, first);
            }
            for (below, is_open) in [&mut first, &mut second] {
                if *is_open && below.count != PAIR {
                    for i in below.first..below.first + below.count {
                        if ask(i as usize, &mut end).is_break() {
                            return;
                        }
                    }
                    *is_open = false;
                }
            }
            current = match (first.1, second.1) {
                (true, true) => {
                    stack.push(second.0.first);
                    first.0.first
                }
                (true, false) => first.0.first,
                (false, true) => second.0.first,
                (false, false) => match stack.pop() {
                    Some(next) => next,
                    None => return,
                },
            };
        }
    }
}

fn sides(left: &Bvh2Node, right: &Bvh2Node) -> [Vec4; 3] {
    let [left, right] = [left, right].map(Bvh2Node::aabb);
    [0, 1, 2].map(|axis| Vec4::new(left.min[axis], right.min[axis], left.max[axis], right.max[axis]))
}

/// Of the first and the third, and of the second and the fourth.
#[inline(always)]
fn smaller(v: Vec4) -> Vec4 {
    v.min(v.zwxy())
}

#[inline(always)]
fn larger(v: Vec4) -> Vec4 {
    v.max(v.zwxy())
}
