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
