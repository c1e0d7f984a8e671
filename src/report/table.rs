//! Which strategy reaches which error how soon, in one scene: the tables for the terminal.
//!
//! Five tables: error against time (the answer), other measures of error, error by brightness, work, work of choosing.
//! A column stands only where it can differ from row to row: no bias columns without biased strategies, no early outs
//! that the scene cannot cause.

use super::curve::{Curve, rows_of};
use super::figures::{self, Arrival, Balance};
use super::number::{NONE, bytes, digits, error, grouped, percent, short, signed_percent, with_share};
use super::sheet::{Column, Sheet};
use crate::record::{Claim, Row, RunRecord, SceneRecord, Summary};
use std::fmt::Write;

/// The tables of a scene in plain text, at most 140 columns wide, under a few lines on what was measured.
///
/// `rows` may hold other scenes too.
pub fn table(run: &RunRecord, scene: &SceneRecord, rows: &[Row]) -> String {
    let mut text = format!("{}\n", scene.name);
    facts(run, scene).iter().for_each(|fact| _ = writeln!(text, "  {fact}"));
    scene.notes.iter().for_each(|note| _ = writeln!(text, "  note: {note}"));
    warnings(run, scene).iter().for_each(|warning| _ = writeln!(text, "  warning: {warning}"));
    for sheet in sheets(run, scene, rows) {
        _ = write!(text, "\n{}", sheet.text());
    }
    text
}

/// What was measured against what, a line each.
pub(super) fn facts(run: &RunRecord, scene: &SceneRecord) -> Vec<String> {
    let SceneRecord { width, height, reference, .. } = scene;
    let share = |part: f64| percent(part, 1.0);
    let [red, green, blue] = scene.rel_mse_epsilon.map(short);
    let mut facts = vec![
        format!("{} (hash {}, seed {}), {} lights", scene.file, scene.hash, scene.seed, grouped(scene.lights)),
        format!(
            "{width} x {height} pixels: {} receivers, sky {} %, emitters {} %; measured on {}",
            grouped(scene.receivers),
            share(scene.sky_share),
            share(scene.emitter_share),
            grouped(scene.pixels_measured),
        ),
        format!(
            "relMSE with epsilon {red}, {green}, {blue} (red, green, blue); {} runs, ± 95 % Student-t intervals",
            run.repeats
        ),
    ];
    let mut line = format!("reference: {}, {} shadow rays", reference.kind, grouped(reference.rays));
    _ = write!(line, ", {} CPU s{}", short(reference.cpu_s), if reference.cached { " (cached)" } else { "" });
    if reference.subset {
        _ = write!(line, ", at {} of the receivers", grouped(scene.pixels_measured));
    }
    if reference.rel_mse > 0.0 {
        _ = write!(line, "; its own relMSE {}", short(reference.rel_mse));
    }
    facts.push(line);
    facts
}

/// What makes the figures of a scene doubtful.
pub(super) fn warnings(run: &RunRecord, scene: &SceneRecord) -> Vec<String> {
    let mut warnings = run.warnings.clone();
    if !run.finished {
        warnings.push("not finished: some strategies or runs are missing".to_owned());
    }
    warnings.extend(doubt(scene));
    warnings.extend(blindness(scene));
    warnings
}

/// A reference whose own noise is not far below the best row's error.
fn doubt(scene: &SceneRecord) -> Option<String> {
    let chosen = scene.summaries.iter().filter(|s| s.chooses && figures::measured(s) && s.rel_mse.mean > 0.0);
    let best = chosen.map(|s| s.rel_mse.mean).min_by(f64::total_cmp)?;
    // 100: the noise of the reference then adds at most 1 % to any error in the table.
    (100.0 * scene.reference.rel_mse > best).then(|| {
        let times = digits(best / scene.reference.rel_mse, 2);
        format!("the best error is only {times} times the reference's own: take errors near it with care")
    })
}

/// Strategies measured in so few or so noisy runs that a large bias of theirs would go unseen.
fn blindness(scene: &SceneRecord) -> Option<String> {
    // 10,000, the size of `downtown`: on larger scenes runs are dear, and the column of detectable bias has to do.
    if scene.lights > 10_000 {
        return None;
    }
    // 5 % of the image mean: what a strategy that drops one of twenty equal lights loses.
    let blind = |s: &&Summary| figures::measured(s) && s.detectable_bias > 0.05;
    let mut blind: Vec<&Summary> = scene.summaries.iter().filter(blind).collect();
    blind.sort_by(|a, b| figures::order(a, b));
    let names: Vec<String> = blind.iter().map(|s| format!("`{}`", s.strategy)).collect();
    (!names.is_empty())
        .then(|| format!("a bias of 5 % of the image mean could go unseen, for want of runs: {}", names.join(", ")))
}

/// All tables of a scene.
pub(super) fn sheets(run: &RunRecord, scene: &SceneRecord, rows: &[Row]) -> Vec<Sheet> {
    let mut summaries: Vec<&Summary> = scene.summaries.iter().collect();
    summaries.sort_by(|a, b| figures::order(a, b));
    let rows = rows_of(rows, &scene.name);
    let measured: Vec<&Summary> = summaries.iter().copied().filter(|s| figures::measured(s)).collect();
    let mut sheets = vec![against_time(&summaries, &rows)];
    // The oracle is run on a few receivers and off the clock: no more is known of it than its error and its work.
    let timed: Vec<&Summary> = measured.iter().copied().filter(|s| s.claim != Claim::Oracle).collect();
    if !timed.is_empty() {
        let below = vec![bias_of_all(run, scene)];
        let counted: Vec<&Summary> = timed.iter().copied().filter(|s| !s.claim.is_external()).collect();
        sheets.extend([other_measures(&timed, &rows, below), by_brightness(&timed, &rows)]);
        sheets.extend((!counted.is_empty()).then(|| work(&counted)));
    }
    sheets.extend(work_of_choosing(&measured));
    sheets
}

fn against_time(summaries: &[&Summary], rows: &[&Row]) -> Sheet {
    let arrival = |s: &Summary, error| figures::time_to(s, &Curve::of(rows, &s.strategy), error);
    let is_biased = |s: &Summary| s.claim.may_be_biased();
    let mut columns = Vec::new();
    if summaries.iter().any(|s| s.claim != Claim::Unbiased) {
        columns.push(Column::new("claim", |s| claim(s).to_owned()));
    }
    columns.extend([
        Column::new("V", |s| unless_floor(s, short(s.variance_seconds))),
        Column::new("s to\n0.1", move |s| time(s, arrival(s, 0.1))),
        Column::new("s to\n0.01", move |s| time(s, arrival(s, 0.01))),
        Column::new("relMSE", |s| error(s.rel_mse)),
    ]);
    if summaries.iter().any(|s| s.times_oracle.is_some()) {
        columns.push(Column::new("x\noracle", |s| s.times_oracle.map_or_else(|| NONE.to_owned(), short)));
    }
    if summaries.iter().any(|s| is_biased(s)) {
        let only_biased = move |s: &Summary, text: String| if is_biased(s) { text } else { NONE.to_owned() };
        columns.push(Column::new("b²", move |s| only_biased(s, with_share(s.rel_bias2))));
        columns.push(Column::new("t*, s", |s| match figures::balance(s) {
            Some(Balance::At(t)) => short(t),
            Some(Balance::After(t)) => format!("> {}", short(t)),
            None => NONE.to_owned(),
        }));
    }
    columns.extend([
        Column::new("passes", |s| s.passes.to_string()),
        Column::new("set-up\nms", |s| short(1e3 * s.setup_cpu_s)),
        Column::new("CPU s", |s| short(s.cpu_s)),
    ]);
    let mut below = vec![
        "V is relMSE variance x CPU seconds at the budget shown (passes). It belongs to that budget: some costs are per block of passes."
            .to_owned(),
        "s to 0.1: CPU seconds, set-up included, until relMSE is 0.1 on the measured curve; the first pass is the soonest.".to_owned(),
    ];
    let is_extrapolated = |s: &Summary| [0.1, 0.01].iter().any(|&e| matches!(arrival(s, e), Arrival::Extrapolated(_)));
    if summaries.iter().any(|s| s.claim != Claim::Floor && figures::measured(s) && is_extrapolated(s)) {
        let (law, unbiased) = if summaries.iter().any(|s| is_biased(s)) {
            ("(relMSE - b²) / (0.1 - b²)", ", b² = 0 if unbiased")
        } else {
            ("relMSE / 0.1", "")
        };
        below
            .push(format!("~: not reached; extrapolated from the largest budget as set-up + CPU s x {law}{unbiased}."));
    }
    if summaries.iter().any(|s| is_biased(s)) {
        below.push("b² is squared bias in units of relMSE; from t* = V / b² on, bias outweighs noise.".to_owned());
        below.push(
            "t* > the longest time measured: b² cannot be told from 0. never: b² alone is that large.".to_owned(),
        );
    }
    if let Some(receivers) = summaries.iter().find_map(|s| s.receivers) {
        below.push(format!(
            "x oracle: error per sample over that of the oracle, both at the same {} receivers, which its row is for; it is not timed.",
            grouped(receivers)
        ));
    }
    if summaries.iter().any(|s| s.unstable) {
        below.push("unstable: the two halves of the runs differ by more than their intervals.".to_owned());
    }
    if summaries.iter().any(|s| s.claim.is_external()) {
        below.push(
            "external: another renderer's image of the exported scene, its time as the notes above say.".to_owned(),
        );
    }
    for summary in summaries {
        match &summary.claim {
            Claim::Biased { why } => below.push(format!("{}: {why}.", summary.strategy)),
            Claim::External { renderer } if figures::measured(summary) => {
                below.push(format!("{}: {renderer}.", summary.strategy));
            }
            _ => {}
        }
    }
    Sheet::new("Error against time", summaries, &columns, below)
}

/// Whether the image means of all unbiased rows are right, as far as the runs can tell.
fn bias_of_all(run: &RunRecord, scene: &SceneRecord) -> String {
    let rows: usize = run.scenes.iter().map(|scene| figures::held_to_zero(scene).count()).sum();
    let here = figures::held_to_zero(scene).count();
    let off: Vec<String> = figures::held_to_zero(scene)
        .map(|s| (s, figures::simultaneous_bias(run, scene, s)))
        .filter(|(_, bias)| !figures::holds_zero(*bias))
        .map(|(s, bias)| format!("`{}` {}", s.strategy, signed_percent(bias)))
        .collect();
    let verdict = match (here, off.is_empty()) {
        (0, _) => "none of them is here".to_owned(),
        (_, true) => format!("all {here} here contain 0"),
        (_, false) => format!("of {here} here these do not contain 0: {}", off.join(", ")),
    };
    format!("simultaneous 99 % intervals of that bias, over the {rows} unbiased rows of the run (Sidak): {verdict}.")
}

fn other_measures(summaries: &[&Summary], rows: &[&Row], more: Vec<String>) -> Sheet {
    let columns = [
        Column::new("relMSE without\nworst 0.1 %", |s| error(s.rel_mse_trimmed)),
        Column::new("share of\nthose, %", |s| percent(mean_at_end(rows, s, |r| r.trimmed_share), 1.0)),
        Column::new("MSE", |s| error(s.mse)),
        Column::new("bias of the\nimage mean, %", |s| signed_percent(s.mean_bias)),
        Column::new("detectable\nbias, %", |s| short(100.0 * s.detectable_bias)),
    ];
    let mut below = vec!["detectable: a bias of the image mean that a 5 % test would find 8 times in 10.".to_owned()];
    below.extend(more);
    Sheet::new("Other measures of error", summaries, &columns, below)
}

fn by_brightness(summaries: &[&Summary], rows: &[&Row]) -> Sheet {
    let heads = ["darkest\ntenth", "2nd", "3rd", "4th", "5th", "6th", "7th", "8th", "9th", "brightest\ntenth"];
    let decile = |at: usize| {
        move |s: &Summary| match mean_at_end(rows, s, |r| r.deciles[at]) {
            0.0 => "exact".to_owned(),
            value => digits(value, 2),
        }
    };
    let columns: Vec<Column> = heads.iter().enumerate().map(|(at, head)| Column::new(head, decile(at))).collect();
    Sheet::new("relMSE by brightness of the reference", summaries, &columns, Vec::new())
}

fn work(summaries: &[&Summary]) -> Sheet {
    let occurs = |count: Count| summaries.iter().any(|s| count(s) > 0);
    let of_picks = |part: u64, s: &Summary| percent(part as f64, s.counts.picks as f64);
    let mut columns = vec![
        Column::new("picks\nper sample", move |s| per_sample(s.counts.picks, s)),
        Column::new("shadow rays\nper sample", move |s| per_sample(s.counts.shadow_rays, s)),
    ];
    if occurs(|s| s.counts.blocked) {
        let blocked = |s: &Summary| percent(s.counts.blocked as f64, s.counts.shadow_rays as f64);
        columns.push(Column::new("blocked\n% of rays", blocked));
    }
    if occurs(|s| s.counts.zero_intensity) {
        columns.push(Column::new("dark direction\n% of picks", move |s| of_picks(s.counts.zero_intensity, s)));
    }
    if occurs(|s| s.counts.behind_surface) {
        columns.push(Column::new("behind surface\n% of picks", move |s| of_picks(s.counts.behind_surface, s)));
    }
    if occurs(|s| s.counts.behind_light) {
        columns.push(Column::new("behind light\n% of picks", move |s| of_picks(s.counts.behind_light, s)));
    }
    columns.push(Column::new("memory", |s| bytes(s.heap_bytes)));
    columns.push(Column::new("wall s", |s| short(s.wall_s)));
    Sheet::new("Work", summaries, &columns, Vec::new())
}

type Count = fn(&Summary) -> u64;

fn per_sample(part: u64, summary: &Summary) -> String {
    match summary.counts.samples {
        0 => NONE.to_owned(),
        samples => short(part as f64 / samples as f64),
    }
}

/// What choosing took, where it was more than drawing a number.
fn work_of_choosing(summaries: &[&Summary]) -> Option<Sheet> {
    let kinds: [(&str, Count); 4] = [
        ("nodes\nper sample", |s| s.counts.nodes),
        ("lights weighed\nper sample", |s| s.counts.weighed),
        ("candidates\nper sample", |s| s.counts.candidates),
        ("choosing rays\nper sample", |s| s.counts.choosing_rays),
    ];
    let occurs = |count: Count| summaries.iter().any(|s| count(s) > 0);
    let columns: Vec<Column> = kinds
        .into_iter()
        .filter(|(_, count)| occurs(*count))
        .map(|(head, count)| Column::new(head, move |s| per_sample(count(s), s)))
        .collect();
    let note = "counted over 4 passes: what is done once a receiver is shared out over them.";
    (!columns.is_empty()).then(|| Sheet::new("Work of choosing", summaries, &columns, vec![note.to_owned()]))
}

fn claim(summary: &Summary) -> &'static str {
    match summary.claim {
        Claim::Unbiased => "unbiased",
        Claim::Biased { .. } => "biased",
        Claim::Floor => "floor",
        Claim::Ceiling => "ceiling",
        Claim::Oracle => "oracle",
        Claim::External { .. } => "external",
    }
}

fn time(summary: &Summary, arrival: Arrival) -> String {
    let text = match arrival {
        Arrival::Measured(seconds) => short(seconds),
        Arrival::Extrapolated(seconds) => format!("~{}", short(seconds)),
        Arrival::Never => "never".to_owned(),
        Arrival::Unknown => NONE.to_owned(),
    };
    unless_floor(summary, text)
}

/// The floor computes no image: what says how soon it gets there means nothing.
fn unless_floor(summary: &Summary, text: String) -> String {
    if summary.claim == Claim::Floor { NONE.to_owned() } else { text }
}

/// Mean over the runs of a strategy at its largest budget; NaN of none.
fn mean_at_end(rows: &[&Row], summary: &Summary, value: impl Fn(&Row) -> f64) -> f64 {
    let at_end = rows.iter().filter(|r| r.strategy == summary.strategy && r.passes == summary.passes);
    let (n, sum) = at_end.fold((0u32, 0.0), |(n, sum), row| (n + 1, sum + value(row)));
    sum / f64::from(n)
}
