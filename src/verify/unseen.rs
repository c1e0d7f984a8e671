//! What may the draws not have shown?
//!
//! An event that befalls a call with probability q stays away from n calls with probability e^(-nq). So at a level p
//! events of a share of ln(1 / p) / n of the calls may be missing, and neither the mean nor its measured variance knows
//! of them. Where a sampler tells how often it picks each light, what such events are worth is known. Where it does not,
//! two things bound them: no call is worth less than 0, and the greatest calls that were seen tell how fast great ones
//! become rare.
//!
//! Sources: Hanley and Lippman-Hand, JAMA 249(13), 1983, for the share; Hill, Ann. Stat. 3(5), 1975, for the tail.

/// How many of the greatest calls are kept.
const GREATEST: usize = 32;

/// The index of a tail that has its greatest calls to show for it has this standard deviation of itself: two are
/// taken off.
const DOUBT: f64 = 2.0 / 5.66;

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
        let share = ((1.0 / level).ln() / self.calls).min(1.0);
        let index = self.index() * (1.0 - DOUBT);
        let beyond = if index > 1.0 { 1.0 / (1.0 - 1.0 / index) } else { f64::INFINITY };
        Missing { too_high: share * self.sum / self.calls, too_low: share * greatest * beyond }
    }

    /// Hill's index of the greatest calls; infinite where they are equal.
    fn index(&self) -> f64 {
        let Some(&least) = self.greatest.last() else { return f64::INFINITY };
        let logs: f64 = self.greatest.iter().map(|value| (value / least).ln()).sum();
        self.greatest.len() as f64 / logs
    }
}

/// How far a mean may be off by events that were not seen.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Missing {
    /// Too high by as much: those are worth less, at the least nothing.
    pub(super) too_high: f64,
    /// Too low by as much: those are worth more; infinite where the greatest calls show no end.
    pub(super) too_low: f64,
}

impl Missing {
    /// What is left of a difference between the mean and what it should be.
    pub(super) fn left_of(self, difference: f64) -> f64 {
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
    fn what_rare_calls_hold_is_allowed_for() {
        // One call in 2,000 is worth 1,000: nine samples of ten thousand miss it or have too much of it.
        let mut stream = Stream::keyed(&[31]);
        let (mut low, mut endless) = (0, 0);
        for _ in 0..1_000 {
            let mut pareto = |index: f64| (1.0 - stream.uniform64()).powf(-1.0 / index);
            let calls: Vec<f64> = (0..400).map(|_| pareto(3.0)).collect();
            let mean = calls.iter().sum::<f64>() / 400.0;
            low += i32::from(of(calls).missing(0.01).left_of(mean - 1.5) < 0.0);
            let heavy = of((0..400).map(|_| pareto(0.7)));
            endless += i32::from(heavy.missing(0.01).too_low == f64::INFINITY);
        }
        assert!(low < 50 && endless > 950, "{low} too low beyond doubt, {endless} without end, of 1000, seed 31");
    }
}
