//! Strategies that differ in one parameter, as a picture: what is best against its value.

use super::chart::{Chart, Dot, Scale, Series};
use super::mark::{Line, Mark};
use super::number::short;
use crate::base::error::Result;
use crate::record::{Read, SceneRecord, Summary};
use std::collections::BTreeMap;

/// Fewest values that make a curve.
const FEWEST: usize = 3;

/// The values of one parameter, and what was measured at each.
type Curve<'a> = Vec<(f64, &'a Summary)>;

/// A plot for each parameter of which strategies have three values or more, with the rest of their parameters the same: the
/// parameter's name, and the SVG of the CPU seconds to the error that ranks are by, against its value.
pub(super) fn sweeps(scene: &SceneRecord) -> Result<Vec<(String, String)>> {
    let mut by_parameter: BTreeMap<String, BTreeMap<String, Curve<'_>>> = BTreeMap::new();
    for summary in scene.summaries.iter().filter(|s| s.error.is_none() && s.skipped.is_none() && s.runs > 0) {
        for (family, parameter, value) in families(&summary.strategy) {
            by_parameter.entry(parameter).or_default().entry(family).or_default().push((value, summary));
        }
    }
    let mut plots = Vec::new();
    for (parameter, mut curves) in by_parameter {
        curves.retain(|_, curve| curve.len() >= FEWEST);
        if !curves.is_empty() {
            let svg = chart(scene, &parameter, &curves).svg()?;
            plots.push((parameter, svg));
        }
    }
    Ok(plots)
}

/// Every numeric parameter of a name, with the name less that parameter.
fn families(name: &str) -> Vec<(String, String, f64)> {
    let Some((strategy, parameters)) = name.split_once(':') else { return Vec::new() };
    let parameters: Vec<&str> = parameters.split(',').collect();
    let one = |(at, parameter): (usize, &&str)| {
        let (key, value) = parameter.split_once('=')?;
        let rest: Vec<&str> =
            parameters.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, other)| *other).collect();
        let family = if rest.is_empty() { strategy.to_owned() } else { format!("{strategy}:{}", rest.join(",")) };
        Some((family, key.to_owned(), value.parse().ok()?))
    };
    parameters.iter().enumerate().filter_map(one).collect()
}

fn chart(scene: &SceneRecord, parameter: &str, curves: &BTreeMap<String, Curve<'_>>) -> Chart {
    let values = || curves.values().flatten().map(|(value, _)| *value);
    let (least, most) = values().fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
    // Values that span more than a factor of 8 were most likely chosen by factors.
    let x = Scale { label: parameter.to_owned(), logarithmic: least > 0.0 && most > 8.0 * least };
    let y = Scale { label: "CPU seconds".to_owned(), logarithmic: true };
    let series = curves.iter().enumerate().map(|(nth, (family, curve))| {
        let dot = |&(value, summary): &(f64, &Summary)| {
            let reading = summary.seconds_to.get(scene.ranked_by as usize)?;
            let found = matches!(reading.how, Read::Measured | Read::Extrapolated).then_some(reading.value)?;
            let dot = Dot { x: value, y: found.mean, low: found.low, high: found.high };
            (x.shows(dot.x) && y.shows(dot.y)).then_some(dot)
        };
        let mut points: Vec<Dot> = curve.iter().filter_map(dot).collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        let biased = curve.iter().any(|(_, summary)| summary.claim.may_be_biased());
        Series { name: family.clone(), mark: Mark::nth(nth, biased), points }
    });
    let series: Vec<Series> = series.collect();
    let error = scene.errors.get(scene.ranked_by as usize).copied().unwrap_or(f64::NAN);
    let mut remarks = Vec::new();
    if series.iter().any(|s| s.mark.line == Line::Dashed && !s.points.is_empty()) {
        remarks.push((34, "dashed and hollow: biased".to_owned()));
    }
    let beyond = |summary: &&Summary| {
        summary.seconds_to.get(scene.ranked_by as usize).is_some_and(|reading| reading.how == Read::Extrapolated)
    };
    if curves.values().flatten().any(|(_, summary)| beyond(summary)) {
        remarks.push((25, "some lie beyond the largest budget: ~ in the table".to_owned()));
    }
    Chart {
        title: format!("{}: {parameter}", scene.name),
        subtitle: format!("CPU seconds to a relMSE of {}, set-up included; bands: 95 % intervals", short(error)),
        x,
        y,
        series,
        remarks,
    }
}

#[cfg(test)]
mod tests {
    use super::families;

    #[test]
    fn a_name_belongs_to_a_family_for_each_of_its_numbers() {
        assert_eq!(families("light-tree:arity=2"), [("light-tree".into(), "arity".into(), 2.0)]);
        let of = |family: &str, parameter: &str, value| (family.to_owned(), parameter.to_owned(), value);
        assert_eq!(
            families("visible:cut=64,picks=2,points=sobol"),
            [of("visible:picks=2,points=sobol", "cut", 64.0), of("visible:cut=64,points=sobol", "picks", 2.0)]
        );
        assert!(families("light-tree").is_empty() && families("light-tree:importance=classic").is_empty());
    }
}
