//! How much work is that, in seconds that are the same on every machine?
//!
//! Plans are made in counted work: how far a strategy goes must not depend on how fast, or how busy, a machine is. Counts
//! become *nominal seconds* at the rates committed here; a real machine may be slower or faster.

use crate::base::counts::Counts;

/// Names the rates below in records: to be raised whenever one changes, since other rows follow.
pub(crate) const RATES: u32 = 1;

/// ns a receiver and pass, for the harness's own loop.
const SAMPLE: f64 = 5.0;
/// ns a pick: drawing it and shading up to an early out.
const PICK: f64 = 60.0;
/// ns a shadow ray, to shade or to choose.
const RAY: f64 = 250.0;
/// ns a node of a hierarchy.
const NODE: f64 = 10.0;
/// ns a light or node weighed.
const WEIGHED: f64 = 5.0;
/// ns a candidate drawn.
const CANDIDATE: f64 = 15.0;

/// ns of set-up a byte of the heap after it.
///
/// Set-up is not counted: what a strategy builds is what it has to show for it. Seen in the rows of five cities of 1,200 to
/// 100,000 lights (2 cores of a busy AMD EPYC), as medians over runs: 6 to 13 ns a byte of whatever has a tree or a
/// hierarchy: `light-tree`, `resampled` and `restir` 6.5 to 11.4, `visible` 7.2 to 12.9, `lightcuts` 7.3 to 12.5,
/// `stochastic-lightcuts` 7.1 to 12.7, `influence`, `influence-pick` and `influence-tail` 5.7 to 12. So these are within
/// a factor of 1.6. Others are cheaper than this says: `stochastic-cull`, 3.9 to 5.8, half of it; `power`, 2 to 4, a third;
/// `uniform` and `intensity`, 0.05 to 1.3, next to nothing, but that is 3 ms at most at 100,000 lights. One is dearer: `allocate`
/// weighs every light at every receiver and keeps little of it, so that its 90 ms on first-night count as 0.03.
///
/// A cost a light would explain no more: bytes follow lights. The points of one grid build the same or nearly so, and
/// what is off is off for all of them.
const SETUP_BYTE: f64 = 9.0;

/// Nominal seconds of building a sampler that holds so many bytes.
pub(crate) fn setup_s(heap_bytes: usize) -> f64 {
    heap_bytes as f64 * SETUP_BYTE * 1e-9
}

/// Nominal seconds of counted work.
pub(crate) fn nominal_s(counts: &Counts) -> f64 {
    let rays = counts.shadow_rays + counts.choosing_rays;
    let parts = [
        (counts.samples, SAMPLE),
        (counts.picks, PICK),
        (rays, RAY),
        (counts.nodes, NODE),
        (counts.weighed, WEIGHED),
        (counts.candidates, CANDIDATE),
    ];
    parts.iter().map(|&(count, ns)| count as f64 * ns).sum::<f64>() * 1e-9
}
