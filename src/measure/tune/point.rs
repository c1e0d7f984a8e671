//! How good is one point of a grid?

use crate::base::statistics::Moments;
use crate::measure::figure::CONFIDENCE;
use crate::record::Interval;
use crate::record::tuned::{OnCity, TunedPoint};
use crate::strategy::Configured;

/// A point of a grid while it is being measured; lists are by city.
pub(super) struct Point<'g> {
    pub(super) strategy: &'g Configured,
    /// Passes of a run.
    pub(super) passes: Vec<u32>,
    /// Nominal seconds of a run, set-up in.
    pub(super) seconds: Vec<f64>,
    /// What brings the relMSE of a run to the time: see [`Work::at_time`](super::super::counted::Work::at_time).
    pub(super) at_time: Vec<f64>,
    /// The relMSE of each run.
    pub(super) errors: Vec<Vec<f64>>,
    /// The score that it was chosen by, where its errors are of fresh runs.
    pub(super) chosen_by: Option<f64>,
    /// Why it is not measured any more.
    pub(super) out: Option<String>,
    /// The city that it failed on.
    failed_on: Option<usize>,
}

/// No relMSE of f32 images is less: an exact image has one.
const LEAST: f64 = 1e-14;

impl<'g> Point<'g> {
    /// One that nothing is known of.
    pub(super) fn new(strategy: &'g Configured, cities: usize) -> Self {
        Self {
            strategy,
            passes: Vec::new(),
            seconds: Vec::new(),
            at_time: Vec::new(),
            errors: vec![Vec::new(); cities],
            chosen_by: None,
            out: None,
            failed_on: None,
        }
    }

    pub(super) fn name(&self) -> String {
        self.strategy.name().to_owned()
    }

    /// Takes it out for a reason found on a city; of several, the first city's stays.
    pub(super) fn fail(&mut self, city: usize, why: String) {
        if self.failed_on.is_none_or(|first| city < first) {
            (self.out, self.failed_on) = (Some(why), Some(city));
        }
    }

    /// Mean relMSE on a city.
    fn rel_mse(&self, city: usize) -> f64 {
        Moments::of(self.errors[city].iter().copied()).mean
    }

    /// relMSE at the time, times the time, on a city; of a biased strategy that of the run, whose error falls otherwise,
    /// times its seconds, where they are more.
    fn v(&self, city: usize, time_s: f64) -> f64 {
        let biased = self.strategy.info().claim.may_be_biased();
        let times = if biased { self.seconds[city].max(time_s) } else { self.at_time[city] * time_s };
        self.rel_mse(city).max(LEAST) * times
    }

    /// The geometric mean of V over the cities.
    pub(super) fn score(&self, time_s: f64) -> f64 {
        Moments::of((0..self.errors.len()).map(|city| self.v(city, time_s).ln())).mean.exp()
    }

    /// What is told of it.
    pub(super) fn record(&self, time_s: f64) -> TunedPoint {
        let measured = self.errors.iter().all(|runs| !runs.is_empty());
        let on = |city: usize| OnCity {
            passes: self.passes[city],
            work_s: self.seconds[city],
            runs: self.errors[city].len() as u32,
            rel_mse: self.rel_mse(city),
            v: self.v(city, time_s),
        };
        TunedPoint {
            name: self.name(),
            score: measured.then(|| self.score(time_s)),
            chosen_by: self.chosen_by,
            out: self.out.clone(),
            cities: if measured { (0..self.errors.len()).map(on).collect() } else { Vec::new() },
        }
    }
}

/// The score of a point over another's: Student's interval of the mean logarithm over the cities, so that it speaks of
/// other cities of the kind. Of one city it has no ends.
pub(super) fn over(point: &Point<'_>, other: &Point<'_>, time_s: f64) -> Interval {
    let ratio = |city: usize| (point.v(city, time_s) / other.v(city, time_s)).ln();
    let moments = Moments::of((0..point.errors.len()).map(ratio));
    let half = moments.half_width(CONFIDENCE);
    Interval { mean: moments.mean.exp(), low: (moments.mean - half).exp(), high: (moments.mean + half).exp() }
}
