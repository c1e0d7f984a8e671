//! What do people decide by? Time to equal error, error at equal time, and which rows the runs tell apart.

use super::curve::Curve;
use super::figure::Figure;
use super::summary::Jackknife;
use crate::base::claim::Claim;
use crate::record::{Interval, Read, Reading, Summary};

/// The relMSE that times are given to.
pub(crate) const ERRORS: [f64; 3] = [0.1, 0.01, 0.001];

/// A row that is being summarised.
pub(crate) struct Entry<'a> {
    /// What is known of it so far.
    pub summary: &'a mut Summary,
    /// Its budgets.
    pub curve: Curve<'a>,
    /// Its bias and variance.
    pub jackknife: Jackknife,
}

/// What the readings of a scene were taken at.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Headline {
    /// CPU seconds at which errors are given.
    pub times_s: Vec<f64>,
    /// Which of [`ERRORS`] ranks the rows.
    pub ranked_by: usize,
}

/// Reads every row's curve, and ranks the unbiased ones.
pub(crate) fn settle(entries: &mut [Entry<'_>]) -> Headline {
    let times_s = times(entries);
    entries.iter_mut().for_each(|entry| entry.read_at(&times_s));
    let ranked_by = ranked_by(entries);
    let ranked: Vec<usize> = (0..entries.len()).filter(|&i| entries[i].is_ranked(ranked_by)).collect();
    let figures: Vec<Figure> = ranked.iter().map(|&i| entries[i].seconds_to(ERRORS[ranked_by]).1).collect();
    for (place, &i) in super::ranking::places(&figures).into_iter().zip(&ranked) {
        entries[i].summary.rank = Some(place.rank);
        entries[i].summary.letters = place.letters;
    }
    Headline { times_s, ranked_by }
}

impl Entry<'_> {
    /// Reads its curve at [`ERRORS`] and at `times_s`: all that a row takes which is ranked among no others, another
    /// renderer's.
    pub(crate) fn read_at(&mut self, times_s: &[f64]) {
        self.summary.seconds_to = ERRORS.map(|error| self.seconds_to(error).0).to_vec();
        self.summary.error_at = times_s.iter().map(|&seconds| self.error_at(seconds)).collect();
    }

    /// CPU seconds to an error.
    fn seconds_to(&self, error: f64) -> (Reading, Figure) {
        let (how, figure) = self.curve.seconds_to(error, self.jackknife.counted_bias2(&self.summary.claim));
        (reading(error, how, &figure), figure)
    }

    fn error_at(&self, seconds: f64) -> Reading {
        let (how, figure) = self.curve.error_at(seconds, self.jackknife.counted_bias2(&self.summary.claim));
        reading(seconds, how, &figure)
    }

    /// Whether it stands among those that are ranked: unbiased, and with a time to the error.
    fn is_ranked(&self, by: usize) -> bool {
        let reading = self.summary.seconds_to[by];
        self.is_candidate() && reading.value.mean.is_finite()
    }

    fn is_candidate(&self) -> bool {
        self.summary.claim == Claim::Unbiased && self.summary.error.is_none() && !self.curve.is_empty()
    }
}

fn reading(at: f64, how: Read, figure: &Figure) -> Reading {
    let value = match how {
        Read::Measured | Read::Extrapolated if figure.estimate > 0.0 => figure.interval(),
        Read::Measured => Interval::certain(figure.estimate),
        _ => Interval::NONE,
    };
    Reading { at, value, how }
}

/// The least error that at least half of the unbiased rows reach within what was measured, as a place in [`ERRORS`].
fn ranked_by(entries: &[Entry<'_>]) -> usize {
    let reached = |by: usize| {
        let there = |entry: &&Entry<'_>| entry.is_candidate() && entry.summary.seconds_to[by].how == Read::Measured;
        2 * entries.iter().filter(there).count() >= entries.iter().filter(|entry| entry.is_candidate()).count()
    };
    (0..ERRORS.len()).rev().find(|&by| reached(by)).unwrap_or(0)
}

/// Three times, a factor of about 3 apart, about what the middle one of the strategies that choose took in all.
fn times(entries: &[Entry<'_>]) -> Vec<f64> {
    let chosen = entries.iter().filter(|entry| entry.summary.chooses);
    let mut longest: Vec<f64> =
        chosen.filter_map(|entry| entry.summary.curve.last().map(|point| point.cpu_s.mean)).collect();
    longest.sort_by(f64::total_cmp);
    let Some(&middle) = longest.get(longest.len() / 2).filter(|&&s| s > 0.0) else { return Vec::new() };
    // 1, 3, 10, 30 and so on.
    let step = (2.0 * middle.log10()).floor() as i32;
    let round = |step: i32| 10f64.powi(step.div_euclid(2)) * [1.0, 3.0][step.rem_euclid(2) as usize];
    (step - 1..=step + 1).map(round).collect()
}
