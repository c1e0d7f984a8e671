//! What follows from the recorded figures of a strategy: how soon it gets somewhere, and where it stands among the
//! others.

use super::curve::{Curve, Point};
use crate::base::statistics::{normal_quantile, sidak, student_quantile};
use crate::record::{Claim, Interval, RunRecord, SceneRecord, Summary};
use std::cmp::Ordering;

/// Squared bias in units of relMSE, as far as it counts: 0 for what claims to have none, never negative;
/// NaN where it is not known.
pub fn bias2(summary: &Summary) -> f64 {
    match summary.claim {
        // `max` would turn NaN, a bias not known, into 0.
        Claim::Biased { .. } | Claim::External { .. } if summary.rel_bias2.mean.is_nan() => f64::NAN,
        Claim::Biased { .. } | Claim::External { .. } => summary.rel_bias2.mean.max(0.0),
        Claim::Unbiased | Claim::Floor | Claim::Ceiling | Claim::Oracle => 0.0,
    }
}

/// When a strategy gets to an error, in CPU seconds, set-up included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Arrival {
    /// At its first budget, or between two of them.
    Measured(f64),
    /// After its largest budget, if noise goes on falling as 1 / time.
    Extrapolated(f64),
    /// Its bias alone is that large.
    Never,
    /// There are no rows, or the bias is not known.
    Unknown,
}

/// When `curve`, the one of `summary`, gets to a relMSE of `error`.
///
/// Read off the measured curve and not from V: CPU time is affine in the passes, so that V / error may lie below the
/// time of the first pass, before which there is no image.
pub(super) fn time_to(summary: &Summary, curve: &Curve, error: f64) -> Arrival {
    let points = &curve.points;
    match points.iter().position(|point| point.error <= error) {
        Some(0) => Arrival::Measured(points[0].seconds),
        Some(first) => Arrival::Measured(between(&points[first - 1], &points[first], error)),
        None => points.last().map_or(Arrival::Unknown, |last| beyond(last, bias2(summary), error)),
    }
}

/// The time of `error` on a straight line from `above` to `below` in the log-log plot; that of `below` where there is
/// no such line.
fn between(above: &Point, below: &Point, error: f64) -> f64 {
    if !above.is_drawable() || !below.is_drawable() {
        return below.seconds;
    }
    let share = (above.error / error).ln() / (above.error / below.error).ln();
    above.seconds * (below.seconds / above.seconds).powf(share)
}

/// The time of `error`, which is less than that of `last`, the largest budget.
fn beyond(last: &Point, bias2: f64, error: f64) -> Arrival {
    if bias2.is_nan() {
        return Arrival::Unknown;
    }
    if error <= bias2 {
        return Arrival::Never;
    }
    let sampling = last.seconds - last.setup;
    Arrival::Extrapolated(last.setup + sampling * (last.error - bias2) / (error - bias2))
}

/// The CPU seconds of sampling at which bias and noise weigh the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Balance {
    /// t* = V / b^2.
    At(f64),
    /// No bias was told from 0 up to the longest time measured.
    After(f64),
}

/// Where bias and noise weigh the same of what may be biased; `None` for the others, and where b^2 is not known.
pub fn balance(summary: &Summary) -> Option<Balance> {
    if !summary.claim.may_be_biased() {
        return None;
    }
    let Interval { mean, half_width } = summary.rel_bias2;
    if mean.is_nan() {
        return None;
    }
    // A b^2 that may be 0 would give a t* that may be anything.
    let seen = mean - half_width > 0.0;
    Some(if seen { Balance::At(summary.variance_seconds / mean) } else { Balance::After(summary.cpu_s) })
}

/// The chance that any one of all right strategies of a run is found biased.
const LEVEL: f64 = 0.01;

/// The unbiased rows of a scene whose bias of the image mean has an interval.
pub(super) fn held_to_zero(scene: &SceneRecord) -> impl Iterator<Item = &Summary> {
    let held = |s: &&Summary| s.claim == Claim::Unbiased && measured(s) && s.mean_bias.half_width.is_finite();
    scene.summaries.iter().filter(held)
}

/// The bias of the image mean with an interval that holds for all unbiased rows of the run, on all scenes, together
/// ([`LEVEL`], Sidak 1967): Student's t for the runs, the normal law for the reference's own error.
pub(super) fn simultaneous_bias(run: &RunRecord, scene: &SceneRecord, summary: &Summary) -> Interval {
    let rows = run.scenes.iter().map(|scene| held_to_zero(scene).count()).sum();
    let p = 1.0 - 0.5 * sidak(LEVEL, rows);
    let (freedom, own) = (summary.runs.max(2) as usize - 1, scene.reference.energy_error);
    let Interval { mean, half_width } = summary.mean_bias;
    // The recorded interval: 95 % for the runs, two standard errors for the reference.
    let of_runs = (half_width.powi(2) - (2.0 * own).powi(2)).max(0.0).sqrt() / student_quantile(0.975, freedom);
    let half_width = (student_quantile(p, freedom) * of_runs).hypot(normal_quantile(p) * own);
    Interval { mean, half_width }
}

/// Whether an interval holds 0; one that is no number holds nothing.
pub(super) fn holds_zero(interval: Interval) -> bool {
    interval.mean.abs() <= interval.half_width
}

/// Whether the strategy ran to its end, so that its numbers mean something.
pub fn measured(summary: &Summary) -> bool {
    summary.error.is_none() && summary.skipped.is_none()
}

/// The group of what no strategy is to be chosen among: from here on they stand together.
pub(super) const FLOOR: u8 = 3;

/// Unbiased rows, then biased ones, then other renderers, then the floor, then the ceiling.
pub(super) fn group(summary: &Summary) -> u8 {
    match summary.claim {
        Claim::Unbiased => 0,
        Claim::Biased { .. } => 1,
        Claim::External { .. } => 2,
        Claim::Floor => FLOOR,
        Claim::Ceiling => FLOOR + 1,
        Claim::Oracle => FLOOR + 2,
    }
}

/// The order of tables and legends: by group, then by V; equal ones by error and name, those without numbers last.
pub fn order(a: &Summary, b: &Summary) -> Ordering {
    let key = |s: &Summary| (group(s), !measured(s));
    key(a)
        .cmp(&key(b))
        .then(a.variance_seconds.total_cmp(&b.variance_seconds))
        .then(a.rel_mse.mean.total_cmp(&b.rel_mse.mean))
        .then_with(|| a.strategy.cmp(&b.strategy))
}
