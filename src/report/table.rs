//! All tables of a scene, and those for the terminal.
//!
//! Error against time comes first: it is the answer. Then what an image costs, what bias was found, other measures of
//! error, error by brightness, work, work of choosing. A column stands only where it can differ from row to row: no
//! claims where all are unbiased, no early outs that the scene cannot cause.

use super::facts::{facts, warnings};
use super::headline::against_time;
use super::number::{Estimate, NONE, bytes, digits, percent, short};
use super::order::{measured, ordered};
use super::rows::Rows;
use super::sheet::{Column, Sheet, broken};
use crate::base::claim::Claim;
use crate::record::{Interval, Row, RunRecord, SceneRecord, Summary};
use std::fmt::Write;

/// The tables of a scene in plain text, at most so many columns wide, under a few lines on what was measured.
///
/// `rows` may hold other scenes too.
pub(crate) fn table(run: &RunRecord, scene: &SceneRecord, rows: &[Row], width: usize) -> String {
    let mut text = format!("{}\n", scene.name);
    let notes = scene.notes.iter().map(|note| format!("note: {note}"));
    let warnings = warnings(run, scene).into_iter().map(|warning| format!("warning: {warning}"));
    let lines = facts(run, scene).into_iter().chain(notes).chain(warnings).flat_map(|line| broken(&line, width - 2));
    lines.for_each(|line| _ = writeln!(text, "  {line}"));
    for sheet in sheets(scene, rows) {
        _ = write!(text, "\n{}", sheet.text(width));
    }
    text
}

/// All tables of a scene.
pub(super) fn sheets(scene: &SceneRecord, rows: &[Row]) -> Vec<Sheet> {
    let summaries = ordered(scene);
    let rows = Rows::of(rows, &scene.name);
    let measured: Vec<&Summary> = summaries.iter().copied().filter(|s| measured(s)).collect();
    let mut sheets = vec![against_time(scene, &summaries)];
    // The oracle is run on a few receivers and off the clock: no more is known of it than its error and its work.
    let timed: Vec<&Summary> = measured.iter().copied().filter(|s| s.claim != Claim::Oracle).collect();
    if !timed.is_empty() {
        let counted: Vec<&Summary> = timed.iter().copied().filter(|s| !s.claim.is_external()).collect();
        sheets.extend([
            cost(&timed, scene.visits.is_some()),
            bias(&timed),
            other_measures(&timed, &rows),
            by_brightness(&timed, &rows),
        ]);
        sheets.extend((!counted.is_empty()).then(|| work(&counted)));
    }
    sheets.extend(work_of_choosing(&measured));
    sheets
}

fn cost(summaries: &[&Summary], moving: bool) -> Sheet {
    let ms = |seconds: Interval| Estimate::of(seconds.times(1e3));
    let columns = [
        Column::new("set-up, ms", move |s| ms(s.setup_cpu_s)),
        Column::new("arrival, ms", move |s| ms(s.arrival_cpu_s)),
        Column::new("a pass, ms", move |s| ms(s.pass_cpu_s)),
        Column::new("passes", |s| s.passes.to_string()),
        Column::new("CPU s\nof those", |s| Estimate::of(s.curve.last().map_or(Interval::NONE, |point| point.cpu_s))),
        Column::new("wall s\nof sampling", |s| short(s.wall_s)),
        Column::new("memory", |s| if s.claim.is_external() { NONE.to_owned() } else { bytes(s.heap_bytes) }),
    ];
    let below = vec![
        "An image of n passes takes set-up + arrival + n x a pass, in CPU time of one thread.".to_owned(),
        match moving {
            false => "arrival: coming to every receiver once, however many passes; with a pass, from the least and the largest budget.",
            true => "arrival: what is paid once, as for what is learned; with a pass, which pays for coming to its own receivers, from \
                     the least and the largest budget.",
        }
        .to_owned(),
    ];
    Sheet::new("Cost", summaries, &columns, below)
}

fn bias(summaries: &[&Summary]) -> Sheet {
    let held = |s: &Summary| s.simultaneous_bias.is_bounded();
    let rows = summaries.iter().filter(|s| held(s)).count();
    let mut columns = Vec::new();
    let mut below = Vec::new();
    if summaries.iter().any(|s| s.claim.may_be_biased()) {
        columns.push(Column::new("b²", |s| match s.claim.may_be_biased() {
            true => Estimate::of(s.rel_bias2),
            false => Estimate::certain(NONE),
        }));
        columns.push(Column::new("t*, s", |s| match s.balance_s {
            Some(Interval { mean, low, .. }) if mean == f64::INFINITY => Estimate::certain(format!("> {}", short(low))),
            balance => Estimate::of(balance.unwrap_or(Interval::NONE)),
        }));
        below.push("b² is squared bias in units of relMSE, freed of noise; it may come out below 0.".to_owned());
        below.push("From t* = V / b² on, in CPU seconds of sampling, bias outweighs noise.".to_owned());
        below.push("t* > the longest time measured: b² cannot be told from 0.".to_owned());
    }
    columns.push(Column::new("bias of the\nimage mean, %", |s| Estimate::signed_percent(s.mean_bias)));
    if rows > 0 {
        columns.push(Column::new("simultaneous\n%", |s| Estimate::signed_percent(s.simultaneous_bias)));
        below.push(format!(
            "simultaneous: the same with an interval that holds for all {rows} unbiased rows here together, at 99 % \
             (Sidak). A row whose interval does not hold 0 has failed."
        ));
    }
    columns.push(Column::new("detectable\nbias, %", |s| short(100.0 * s.detectable_bias)));
    below.push("detectable: a bias of the image mean that a 5 % test would find 8 times in 10.".to_owned());
    Sheet::new("Bias", summaries, &columns, below)
}

fn other_measures(summaries: &[&Summary], rows: &Rows<'_>) -> Sheet {
    let columns = [
        Column::new("passes", |s| s.passes.to_string()),
        Column::new("relMSE", |s| Estimate::error(s.rel_mse)),
        Column::new("relMSE without\nworst 0.1 %", |s| Estimate::error(s.rel_mse_trimmed)),
        Column::new("share of\nthose, %", |s| percent(rows.mean_at_end(s, |r| r.trimmed_share), 1.0)),
        Column::new("MSE", |s| Estimate::error(s.mse)),
    ];
    Sheet::new("Other measures of error", summaries, &columns, Vec::new())
}

fn by_brightness(summaries: &[&Summary], rows: &Rows<'_>) -> Sheet {
    let heads = ["darkest\ntenth", "2nd", "3rd", "4th", "5th", "6th", "7th", "8th", "9th", "brightest\ntenth"];
    let decile = |at: usize| {
        move |s: &Summary| match rows.mean_at_end(s, |r| r.deciles[at]) {
            0.0 => "exact".to_owned(),
            value => digits(value, 2),
        }
    };
    let columns: Vec<Column> = heads.iter().enumerate().map(|(at, &head)| Column::new(head, decile(at))).collect();
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
