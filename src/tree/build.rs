//! How does a set of lights become a tree?
//!
//! From the top: a node's set is cut in two, then the costliest part again, until there are `N` or each would fit a
//! node. That is the binary tree of the heuristic with the levels that matter most merged, without ever holding it.

use super::bounds::{Bounds, Item};
use super::how::Facing;
use super::node::Node;
use super::split::{TIE, split};
use std::ops::Range;

/// Sets of fewer lights are built on one thread.
const ALONE: usize = 2048;

/// Below this depth sets are halved by number. Costs alone could peel off one light a level where each is far stronger
/// than the next.
const BY_COST: u32 = 40;

/// A part of a node's set.
struct Part {
    range: Range<usize>,
    bounds: Bounds,
}

/// The nodes over `items`, which are reordered so that those of each node are together; none without items.
pub(super) fn nodes<const N: usize>(items: &mut [Item], facing: Facing) -> Vec<Node<N>> {
    if items.is_empty() {
        return Vec::new();
    }
    let mut nodes = Vec::with_capacity(items.len() / (N - 1) + 1);
    grow(&mut nodes, items, facing, 0);
    nodes
}

/// Appends the node over `items`, which start at place `first` of all, and the nodes below it.
fn grow<const N: usize>(nodes: &mut Vec<Node<N>>, items: &mut [Item], facing: Facing, depth: u32) {
    let parts = parts::<N>(items, depth);
    let at = nodes.len();
    nodes.push(Node::new(items));
    for (j, part) in parts.iter().enumerate() {
        nodes[at].bound(j, &part.bounds, &items[part.range.clone()], facing);
    }
    let large = |part: &&Part| part.range.len() > 1;
    if items.len() < ALONE {
        for (j, part) in parts.iter().enumerate().filter(|(_, part)| large(part)) {
            let offset = nodes.len() - at;
            nodes[at].descend(j, offset);
            grow(nodes, &mut items[part.range.clone()], facing, depth + 1);
        }
        return;
    }
    // Each part on its own; links are offsets, so that what is below can be moved as a whole.
    let mut rest = items;
    let mut taken = 0;
    let mut below: Vec<(usize, &mut [Item], Vec<Node<N>>)> = Vec::with_capacity(N);
    for (j, part) in parts.iter().enumerate() {
        let (own, others) = rest.split_at_mut(part.range.end - taken);
        taken = part.range.end;
        rest = others;
        if large(&part) {
            below.push((j, own, Vec::new()));
        }
    }
    rayon::scope(|scope| {
        for (_, own, nodes) in &mut below {
            scope.spawn(move |_| grow(nodes, own, facing, depth + 1));
        }
    });
    for (j, _, below) in below {
        let offset = nodes.len() - at;
        nodes[at].descend(j, offset);
        nodes.extend(below);
    }
}

/// The parts of a node's set, in order.
fn parts<const N: usize>(items: &mut [Item], depth: u32) -> Vec<Part> {
    let part = |items: &[Item], range: Range<usize>| Part { bounds: Bounds::of(&items[range.clone()]), range };
    let mut parts = Vec::with_capacity(N);
    parts.push(part(items, 0..items.len()));
    while parts.len() < N
        && let Some(costliest) = costliest::<N>(&parts)
    {
        let range = parts[costliest].range.clone();
        let own = &mut items[range.clone()];
        let middle = range.start + if depth < BY_COST { split(own) } else { own.len() / 2 };
        parts.splice(costliest..=costliest, [range.start..middle, middle..range.end].map(|range| part(items, range)));
    }
    // What is left of the room goes to parts that would fill a node of their own badly: their lights come here.
    while let Some(smallest) = smallest(&parts)
        && parts.len() + parts[smallest].range.len() - 1 <= N
    {
        let range = parts[smallest].range.clone();
        parts.splice(smallest..=smallest, range.map(|i| part(items, i..i + 1)));
    }
    parts
}

/// The part to cut next, of those that do not fit a node: the first of greatest cost, or the largest where they cost
/// nothing, being all in one place.
fn costliest<const N: usize>(parts: &[Part]) -> Option<usize> {
    let mut best: Option<(f64, usize, usize)> = None;
    for (i, part) in parts.iter().enumerate().filter(|(_, part)| part.range.len() > N) {
        let (cost, len) = (part.bounds.cost(), part.range.len());
        let better = |&(most, longest, _): &(f64, usize, usize)| {
            cost > most * (1.0 + TIE) || (most == 0.0 && cost == 0.0 && len > longest)
        };
        if best.as_ref().is_none_or(better) {
            best = Some((cost, len, i));
        }
    }
    best.map(|(_, _, i)| i)
}

/// The first smallest part of several lights.
fn smallest(parts: &[Part]) -> Option<usize> {
    let several = parts.iter().enumerate().filter(|(_, part)| part.range.len() > 1);
    several.min_by_key(|(_, part)| part.range.len()).map(|(i, _)| i)
}
