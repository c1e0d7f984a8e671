//! Error against time as a picture: log-log, one curve per strategy, its interval as a band.

use super::chart::{Chart, Dot, Scale, Series};
use super::curve::{Curve, Point, rows_of};
use super::figures;
use super::mark::{Line, Mark};
use crate::base::error::Result;
use crate::record::{Claim, Row, SceneRecord, Summary};

/// The plot of a scene as SVG: relMSE over receivers against CPU seconds, set-up included, means over runs with 95 %
/// intervals.
///
/// Biased strategies are dashed and hollow, other renderers dotted. What a logarithmic axis cannot show (an error of
/// exactly 0) is named under the legend. `rows` may hold other scenes too.
pub fn plot(scene: &SceneRecord, rows: &[Row]) -> Result<String> {
    let mut summaries: Vec<&Summary> = scene.summaries.iter().collect();
    summaries.sort_by(|a, b| figures::order(a, b));
    let rows = rows_of(rows, &scene.name);
    let mut exact: Vec<String> = Vec::new();
    let mut series = Vec::new();
    for summary in summaries {
        // By name and not by rank: a strategy keeps its look from scene to scene of a run.
        let of = |group: fn(&Claim) -> bool| scene.summaries.iter().filter(move |s| group(&s.claim));
        let before = |s: &&Summary| s.strategy < summary.strategy;
        let nth = if summary.claim.is_external() {
            // After all strategies: they look the same with and without other renderers.
            of(is_strategy).count() + of(Claim::is_external).filter(before).count()
        } else {
            of(is_strategy).filter(before).count()
        };
        let curve = Curve::of(&rows, &summary.strategy);
        if curve.is_exact() {
            exact.push(format!("exact, not drawn: {}", summary.strategy));
        }
        let dot = |p: &Point| Dot { x: p.seconds, y: p.error, half_width: p.half_width };
        let points = curve.points.iter().filter(|p| p.is_drawable()).map(dot).collect();
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
    let runs = scene.summaries.iter().map(|s| s.runs).max().unwrap_or(0);
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
