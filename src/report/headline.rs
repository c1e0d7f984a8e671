//! Which strategy gets how far how soon, and which are not told apart: the table that people decide by.

use super::number::{Estimate, NONE, grouped, round};
use super::order::measured;
use super::sheet::{Column, Sheet};
use crate::base::claim::Claim;
use crate::record::{Interval, Read, Reading, SceneRecord, Summary};

/// Marks the column that ranks.
const RANKS: &str = "▲";

/// The table of `summaries`, in their order.
pub(super) fn against_time(scene: &SceneRecord, summaries: &[&Summary]) -> Sheet {
    let any = |is: &dyn Fn(&Summary) -> bool| summaries.iter().any(|s| is(s));
    let ranked = any(&|s| s.rank.is_some());
    let mut columns = Vec::new();
    if any(&|s| s.claim != Claim::Unbiased) {
        columns.push(Column::new("claim", |s| claim(s).to_owned()));
    }
    if ranked {
        columns.push(Column::new("rank,\nletters", rank));
    }
    for (at, &error) in scene.errors.iter().enumerate() {
        let mark = if ranked && at == scene.ranked_by as usize { RANKS } else { "" };
        let head = format!("s to\n{mark}{}", round(error));
        columns.push(Column::new(head, move |s| reading(s, &s.seconds_to, at, Estimate::of)));
    }
    for (at, &seconds) in scene.times_s.iter().enumerate() {
        let head = format!("relMSE at\n{} s", round(seconds));
        columns.push(Column::new(head, move |s| reading(s, &s.error_at, at, Estimate::error)));
    }
    columns.push(Column::new("V", |s| unless_floor(s, Estimate::of(s.variance_seconds))));
    if any(&|s| s.times_oracle.is_some()) {
        columns.push(Column::new("x oracle", |s| Estimate::of(s.times_oracle.unwrap_or(Interval::NONE))));
    }
    Sheet::new("Error against time", summaries, &columns, below(scene, summaries))
}

/// What the table means, an idea a line.
fn below(scene: &SceneRecord, summaries: &[&Summary]) -> Vec<String> {
    let any = |is: &dyn Fn(&Summary) -> bool| summaries.iter().any(|s| measured(s) && is(s));
    let read = |how: Read| {
        any(&|s| s.claim != Claim::Floor && s.seconds_to.iter().chain(&s.error_at).any(|reading| reading.how == how))
    };
    let mut below = Vec::new();
    if let Some(error) = scene.errors.get(scene.ranked_by as usize).filter(|_| any(&|s| s.rank.is_some())) {
        below.push(format!("{RANKS} ranks the unbiased rows: by the CPU seconds until relMSE is {}.", round(*error)));
        below.push("A rank of 2-4 may be any from the 2nd to the 4th, as far as the runs tell.".to_owned());
        below.push("Rows that share a letter were not told apart (Holm over all pairs, 5 % in all).".to_owned());
    }
    below.push(
        "Times are CPU seconds of one thread from nothing to the image, set-up included, read off the measured curve; \
         the first pass is the soonest."
            .to_owned(),
    );
    if read(Read::TooSoon) {
        below.push(format!("{TOO_SOON}: its first image takes longer."));
    }
    if read(Read::Extrapolated) {
        let bias = if any(&|s| s.claim.may_be_biased()) { ", down to b² where there is a bias" } else { "" };
        below.push(format!("~: beyond the largest budget, if noise goes on falling as 1 / time{bias}."));
    }
    if read(Read::Never) {
        below.push(format!("{NEVER}: its bias alone is larger."));
    }
    let paid = match scene.visits {
        None => "It belongs to that budget: coming to a receiver is paid once, however many passes.",
        Some(_) => "Every pass comes to receivers of its own, and pays for that.",
    };
    below.push(format!(
        "V: variance in units of relMSE x CPU seconds of sampling, both at the largest budget (passes, below). {paid}"
    ));
    if let Some(receivers) = summaries.iter().find_map(|s| s.receivers) {
        below.push(format!(
            "x oracle: error per sample over that of the oracle, at the same {} receivers; the oracle is not timed.",
            grouped(receivers)
        ));
    }
    below.push(
        "±9 % or -8 +15 %: 95 % intervals over runs; upper ends hold what rare bright pixels may add, too.".to_owned(),
    );
    if any(&|s| s.unstable) {
        below.push("unstable: the two halves of the runs differ by more than their intervals.".to_owned());
    }
    if summaries.iter().any(|s| s.claim.is_external()) {
        below.push(
            "external: another renderer's image of the exported scene, its time as the notes above say.".to_owned(),
        );
    }
    for summary in summaries {
        let name = &summary.strategy;
        match (&summary.error, &summary.skipped, &summary.claim) {
            (Some(error), ..) => below.push(format!("`{name}` failed: {}.", error.trim_end_matches('.'))),
            (None, Some(skipped), _) => below.push(format!("`{name}` {}.", skipped.trim_end_matches('.'))),
            (None, None, Claim::Biased { why }) => below.push(format!("`{name}`: {why}.")),
            (None, None, Claim::External { renderer }) => below.push(format!("`{name}`: {renderer}.")),
            _ => {}
        }
    }
    below
}

const NEVER: &str = "never";
const TOO_SOON: &str = "none yet";

fn reading(summary: &Summary, readings: &[Reading], at: usize, shown: fn(Interval) -> Estimate) -> Estimate {
    let Some(reading) = readings.get(at) else { return Estimate::certain(NONE) };
    let text = match reading.how {
        Read::Measured => shown(reading.value),
        Read::Extrapolated => shown(reading.value).after("~"),
        Read::Never => Estimate::certain(NEVER),
        Read::TooSoon => Estimate::certain(TOO_SOON),
        Read::Unknown => Estimate::certain(NONE),
    };
    unless_floor(summary, text)
}

/// The floor computes no image: what says how soon it gets there means nothing.
fn unless_floor(summary: &Summary, shown: Estimate) -> Estimate {
    if summary.claim == Claim::Floor { Estimate::certain(NONE) } else { shown }
}

/// The ranks that it may have, and its letters.
fn rank(summary: &Summary) -> Estimate {
    Estimate::rank(summary.rank, &summary.letters)
}

fn claim(summary: &Summary) -> &'static str {
    summary.claim.word()
}
