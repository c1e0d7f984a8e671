//! Are the rows of a comparison all there, each once?

use super::order::measured;
use crate::record::study::Study;
use crate::record::{Point, Row, RunRecord, Summary};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// What is wrong with the rows, by what the record says: those that stand more than once, those that are missing, and
/// those of nothing that it names.
///
/// Every measured strategy has a row for each of its runs at each of its budgets.
pub(super) fn faults(run: &RunRecord, rows: &[Row]) -> Vec<String> {
    let mut faults = Vec::new();
    let mut times: BTreeMap<_, u32> = BTreeMap::new();
    rows.iter().for_each(|row| *times.entry(row.key()).or_default() += 1);
    for ((scene, strategy, run, passes), times) in times.iter().filter(|(_, times)| **times > 1) {
        faults.push(format!("{scene}, `{strategy}`, run {run}, {passes} passes: stands {times} times"));
    }
    let mut by_strategy: HashMap<(&str, &str), Vec<&Row>> = HashMap::new();
    rows.iter().for_each(|row| by_strategy.entry((&row.scene, &row.strategy)).or_default().push(row));
    let mut named = BTreeSet::new();
    for scene in &run.scenes {
        for summary in &scene.summaries {
            let of = (scene.name.as_str(), summary.strategy.as_str());
            named.insert(of);
            let own = by_strategy.get(&of).map_or(&[][..], Vec::as_slice);
            faults.extend(missing(summary, own).into_iter().map(|what| format!("{}, `{}`, {what}", of.0, of.1)));
        }
    }
    if faults.is_empty() {
        faults = other_means(run, &by_strategy);
    }
    // Of a scene that is not finished there is no summary yet.
    let stray: BTreeSet<_> = by_strategy.keys().filter(|of| run.finished && !named.contains(*of)).collect();
    faults.extend(stray.into_iter().map(|(scene, strategy)| format!("{scene}, `{strategy}`: the record names none")));
    faults
}

/// What a strategy's rows lack or have too many of.
fn missing(summary: &Summary, rows: &[&Row]) -> Vec<String> {
    // An oracle is run off the clock and has no rows.
    if !measured(summary) || summary.receivers.is_some() || summary.runs == 0 {
        return Vec::new();
    }
    let mut runs: BTreeMap<u32, BTreeSet<u32>> =
        summary.curve.iter().map(|point| (point.passes, BTreeSet::new())).collect();
    rows.iter().for_each(|row| _ = runs.entry(row.passes).or_default().insert(row.run));
    let mut faults = Vec::new();
    for (passes, found) in runs {
        // Never run by run: a record may say that there are four thousand million.
        let mut next = 0;
        for run in found.range(..summary.runs).copied().chain([summary.runs]) {
            match run - next {
                0 => {}
                1 => faults.push(format!("{passes} passes: run {next} is missing")),
                _ => faults.push(format!("{passes} passes: runs {next} to {} are missing", run - 1)),
            }
            next = run.saturating_add(1);
        }
        let beyond = found.range(summary.runs..);
        faults.extend(beyond.map(|run| format!("{passes} passes: run {run} where there are {}", summary.runs)));
    }
    faults
}

/// Where the rows, which are all there, come to other means than the record's.
fn other_means(run: &RunRecord, by_strategy: &HashMap<(&str, &str), Vec<&Row>>) -> Vec<String> {
    let mut faults = Vec::new();
    for scene in &run.scenes {
        for summary in &scene.summaries {
            let Some(rows) = by_strategy.get(&(scene.name.as_str(), summary.strategy.as_str())) else { continue };
            let found = summary.curve.iter().filter_map(|point| other_mean(point, rows));
            faults.extend(found.map(|what| format!("{}, `{}`, {what}", scene.name, summary.strategy)));
        }
    }
    faults
}

/// What the rows of a budget come to where that is not what the record says of it.
fn other_mean(point: &Point, rows: &[&Row]) -> Option<String> {
    let of: Vec<&&Row> = rows.iter().filter(|row| row.passes == point.passes).collect();
    let mean = |value: fn(&Row) -> f64| of.iter().map(|row| value(row)).sum::<f64>() / of.len() as f64;
    let differs = |found: f64, recorded: f64| (found - recorded).abs() > 1e-9 * recorded.abs();
    let figures =
        [("relMSE", mean(|r| r.rel_mse), point.rel_mse.mean), ("CPU s", mean(Row::total_cpu_s), point.cpu_s.mean)];
    let (what, found, recorded) = figures.into_iter().find(|&(_, found, recorded)| differs(found, recorded))?;
    Some(format!("{} passes: the mean {what} is {found:e} where the record says {recorded:e}", point.passes))
}

/// Rows of a study that stand more than once, and the table that they stand in.
pub(super) fn doubled(study: &Study) -> Vec<(String, String)> {
    let mut faults = Vec::new();
    for (table, rows) in study.record.tables.iter().zip(&study.rows) {
        let mut times: BTreeMap<String, u32> = BTreeMap::new();
        rows.iter().for_each(|cells| *times.entry(format!("{cells:?}")).or_default() += 1);
        faults.extend(
            times
                .into_iter()
                .filter(|(_, times)| *times > 1)
                .map(|(cells, times)| (table.name.clone(), format!("stands {times} times: {cells}"))),
        );
    }
    faults
}
