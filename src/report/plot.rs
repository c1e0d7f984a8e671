//! Error against time as a picture: log-log, one curve per strategy, its interval as a band.

use super::chart::{Chart, Dot, Scale, Series};
use super::mark::{Line, Mark};
use super::order::{measured, ordered};
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::record::{Point, SceneRecord, Summary};

/// The plot of a scene as SVG: relMSE over receivers against CPU seconds, set-up included, means over runs with 95 %
/// intervals.
///
/// Biased strategies are dashed and hollow, other renderers dotted. What a logarithmic axis cannot show (an error of
/// exactly 0) is named under the legend.
///
/// # Errors
/// A plot that cannot be drawn.
pub(crate) fn plot(scene: &SceneRecord) -> Result<String> {
    let mut exact: Vec<String> = Vec::new();
    let mut series = Vec::new();
    for summary in ordered(scene).into_iter().filter(|s| measured(s)) {
        // By name and not by rank: a strategy keeps its look from scene to scene of a run.
        let of = |group: fn(&Claim) -> bool| scene.summaries.iter().filter(move |s| group(&s.claim));
        let before = |s: &&Summary| s.strategy < summary.strategy;
        let nth = if summary.claim.is_external() {
            // After all strategies: they look the same with and without other renderers.
            of(is_strategy).count() + of(Claim::is_external).filter(before).count()
        } else {
            of(is_strategy).filter(before).count()
        };
        if summary.curve.iter().any(|point| point.rel_mse.mean == 0.0) {
            exact.push(format!("exact, not drawn: {}", summary.strategy));
        }
        let is_drawable = |p: &&Point| [p.cpu_s.mean, p.rel_mse.mean].iter().all(|&v| v.is_finite() && v > 0.0);
        let dot = |p: &Point| Dot { x: p.cpu_s.mean, y: p.rel_mse.mean, low: p.rel_mse.low, high: p.rel_mse.high };
        let points = summary.curve.iter().filter(is_drawable).map(dot).collect();
        series.push(Series { name: summary.strategy.clone(), mark: Mark::new(&summary.claim, nth), points });
    }
    let mut remarks = Vec::new();
    if series.iter().any(|s| s.mark.line == Line::Dashed && !s.points.is_empty()) {
        remarks.push((34, "dashed and hollow: biased".to_owned()));
    }
    if series.iter().any(|s| s.mark.line == Line::Dotted && !s.points.is_empty()) {
        remarks.push((if remarks.is_empty() { 34 } else { 25 }, "dotted: other renderers".to_owned()));
    }
    remarks.extend(exact.into_iter().enumerate().map(|(at, text)| (if at == 0 { 25 } else { 19 }, text)));
    let runs = scene.summaries.iter().filter(|s| !s.curve.is_empty()).map(|s| s.runs).max().unwrap_or(0);
    let scale = |label: &str| Scale { label: label.to_owned(), logarithmic: true };
    Chart {
        title: scene.name.clone(),
        subtitle: format!("relMSE against CPU seconds, set-up included; mean of {runs} runs, bands: 95 % intervals"),
        x: scale("CPU seconds"),
        y: scale("relMSE"),
        series,
        remarks,
    }
    .svg()
}

/// Whether a strategy has a colour of its own.
fn is_strategy(claim: &Claim) -> bool {
    matches!(claim, Claim::Unbiased | Claim::Biased { .. })
}
