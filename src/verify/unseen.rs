//! What may the draws not have shown?
//!
//! An event that befalls a call with probability q stays away from n calls with probability e^(-nq). So at a level p
//! events of a share of ln(1 / p) / n of the calls may be missing, and neither the mean nor its measured variance knows
//! of them. Where a sampler tells how often it picks each light, what such events are worth is known. Where it does not, no
//! call is worth less than 0, and how fast great calls become rare says what still greater ones may hold. That is an
//! estimate and no bound: a kind of event that is far greater than all that were seen, with nothing between, is not allowed for.
//!
//! Sources: Hanley and Lippman-Hand, JAMA 249(13), 1983, for the share; Hill, Ann. Stat. 3(5), 1975, for the tail.

/// How many of the greatest calls are kept.
const GREATEST: usize = 32;

/// With fewer the tail is not estimated.
const FEW: usize = 8;

/// Beyond the greatest call, for each event that may be missing, at most so many times as much as it is worth: as a tail holds
/// in which every doubling of the size halves the rate, over four decades.
const MOST: f64 = 10.0;

/// About this share of calls, and no more, may be of events that were not seen, or a sampler of twice the weights might be right.
const SHARE: f64 = 0.125;

/// How many calls it takes for that at a level.
pub(super) fn calls_to_tell(level: f64) -> f64 {
    // Each receiver has a part of the level.
    (1e2 / level).ln() / SHARE
}

/// The values of calls at one receiver, as far as they say what may be missing.
#[derive(Clone, Debug, Default)]
pub(super) struct Unseen {
    /// The greatest values, greatest first.
    greatest: Vec<f64>,
    sum: f64,
    calls: f64,
}

impl Unseen {
    /// Takes the value of a call, 0 or more.
    pub(super) fn add(&mut self, value: f64) {
        self.calls += 1.0;
        self.sum += value;
        let full = self.greatest.len() == GREATEST;
        if value > 0.0 && !(full && self.greatest[GREATEST - 1] >= value) {
            let place = self.greatest.partition_point(|&greater| greater >= value);
            self.greatest.insert(place, value);
            self.greatest.truncate(GREATEST);
        }
    }

    /// What may be missing from the mean of the calls at a level; nothing without a call.
    ///
    /// Beyond the greatest call x a tail of index a holds x a / (a - 1) for each event.
    pub(super) fn missing(&self, level: f64) -> Missing {
        let Some(greatest) = self.greatest.first() else { return Missing::default() };
        let share = (1.0 / level).ln() / self.calls;
        Missing { too_high: share * self.sum / self.calls, too_low: share * greatest * self.beyond() }
    }

    /// What calls that were not seen are worth on average, in units of the greatest one.
    fn beyond(&self) -> f64 {
        let (n, Some(&least)) = (self.greatest.len(), self.greatest.last()) else { return MOST };
        if n < FEW {
            return MOST;
        }
        let logs: f64 = self.greatest.iter().map(|value| (value / least).ln()).sum();
        // Hill's index, which has a standard deviation of one in the root of n of itself: two are taken off.
        let index = (n - 1) as f64 / logs * (1.0 - 2.0 / (n as f64).sqrt());
        if index > 1.0 { (1.0 / (1.0 - 1.0 / index)).min(MOST) } else { MOST }
    }
}

/// How far a mean may be off by events that were not seen.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Missing {
    /// Too high by as much: those are worth less, at the least nothing.
    pub(super) too_high: f64,
    /// Too low by as much: those are worth more.
    pub(super) too_low: f64,
}

impl Missing {
    /// What is left of a difference between the mean and what it should be.
    pub(super) fn left_of(self, difference: f64) -> f64 {
        if difference.is_nan() {
            return difference;
        }
        if difference > 0.0 { (difference - self.too_high).max(0.0) } else { (difference + self.too_low).min(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    fn of(values: impl IntoIterator<Item = f64>) -> Unseen {
        let mut unseen = Unseen::default();
        values.into_iter().for_each(|value| unseen.add(value));
        unseen
    }

    #[test]
    fn equal_calls_may_miss_one_kind_of_event() {
        let (missing, share) = (of([2.0; 1_000]).missing(0.01), 100f64.ln() / 1_000.0);
        assert!((missing.too_high - 2.0 * share).abs() < 1e-12 && (missing.too_low - 2.0 * share).abs() < 1e-12);
        // Too few to tell more.
        assert!((of([2.0; 5]).missing(0.9).too_low - 2.0 * MOST * 0.9f64.recip().ln() / 5.0).abs() < 1e-12);
        assert_eq!([0.1, 0.005, -0.005, -0.1].map(|off| missing.left_of(off) != 0.0), [true, false, false, true]);
        for none in [of([]), of([0.0; 5])] {
            assert_eq!(none.missing(0.01).left_of(1e-9), 1e-9);
        }
    }

    #[test]
    fn the_greatest_calls_are_kept_in_any_order() {
        let rising = of((0..100).map(f64::from));
        let falling = of((0..100).rev().map(f64::from));
        assert_eq!(rising.greatest, falling.greatest);
        assert!(rising.greatest[0] == 99.0 && rising.greatest[GREATEST - 1] == 68.0);
    }

    #[test]
    fn few_calls_tell_a_sampler_of_twice_the_weights_from_a_right_one() {
        let level = 1e-3;
        let calls = calls_to_tell(level).ceil() as usize;
        for level in [level, level / 50.0] {
            assert!(of(vec![2.0; calls]).missing(level).left_of(1.0) > 0.7, "twice as bright, in {calls} calls");
            assert!(of(vec![0.5; 8 * calls]).missing(level).left_of(-0.5) < -0.4, "half as bright");
        }
        assert!(of([1.0; 9]).missing(0.01).left_of(f64::NAN).is_nan());
    }

    #[test]
    fn what_great_calls_hold_is_allowed_for() {
        // The mean of a Pareto law of index 2 is 2: that of 400 is lower by more than its error oftener than it seems.
        let mut stream = Stream::keyed(&[31]);
        let (mut low, mut student, mut wide) = (0, 0, 0);
        for _ in 0..1_000 {
            let mut pareto = |index: f64| (1.0 - stream.uniform64()).powf(-1.0 / index);
            let calls: Vec<f64> = (0..400).map(|_| pareto(2.0)).collect();
            let found = crate::base::statistics::Moments::of(calls.iter().copied());
            let unseen = of(calls);
            low += i32::from(unseen.missing(0.01).left_of(found.mean - 2.0) < 0.0);
            student += i32::from(found.mean - 2.0 < -2.6 * found.standard_error());
            wide += i32::from(of((0..400).map(|_| pareto(0.7))).beyond() == MOST);
        }
        assert!(low < 5 && student > 30 && wide > 950, "{low} and {student} too low, {wide} wide, of 1000, seed 31");
    }
}
