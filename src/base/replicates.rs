//! What do many replicates say of several rows: how do they compare with one of them, and in which order do they stand?
//!
//! A replicate is one city seen from one place, one machine, one day: whatever a conclusion is to hold beyond. Rows are
//! paired by it, since what makes a replicate hard is common to all: each replicate gives a ratio of two rows, and the
//! spread of these ratios says how far another replicate may be from them.

use super::ranking::{Place, Verdicts, holm, pairs, places};
use super::statistics::{Moments, student_p};

/// The logarithms of positive figures, row by row: one a replicate, none where there is no figure.
pub(crate) struct Replicates(Vec<Vec<Option<f64>>>);

/// A row's figure over another's, over all replicates that have both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ratio {
    /// The geometric mean.
    pub mean: f64,
    /// Its interval by Student's t on the logarithms; 0 and infinity where there is but one replicate.
    pub low: f64,
    /// See [`low`](Self::low).
    pub high: f64,
    /// The least ratio, and its replicate.
    pub least: (f64, usize),
    /// The greatest ratio, and its replicate.
    pub greatest: (f64, usize),
}

impl Replicates {
    /// Of figures, row by row, with as many replicates each. One that is not finite or not above 0 counts as none.
    pub(crate) fn of(figures: Vec<Vec<Option<f64>>>) -> Self {
        let log = |figure: Option<f64>| figure.filter(|x| x.is_finite() && *x > 0.0).map(f64::ln);
        Self(figures.into_iter().map(|row| row.into_iter().map(log).collect()).collect())
    }

    /// In how many replicates a row has a figure.
    pub(crate) fn measured(&self, row: usize) -> usize {
        self.0[row].iter().flatten().count()
    }

    /// The ratios of a row to a base, each with its replicate; none where either has no figure.
    pub(crate) fn ratios(&self, row: usize, base: usize) -> impl Iterator<Item = (usize, f64)> {
        self.differences(row, base).map(|(at, log)| (at, log.exp()))
    }

    /// A row over a base, with an interval at a confidence within (0, 1); none where no replicate has both.
    pub(crate) fn over(&self, row: usize, base: usize, confidence: f64) -> Option<Ratio> {
        let ratios = || self.ratios(row, base).map(|(at, ratio)| (ratio, at));
        let by_ratio = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0);
        let (least, greatest) = (ratios().min_by(by_ratio)?, ratios().max_by(by_ratio)?);
        let moments = Moments::of(self.differences(row, base).map(|(_, log)| log).collect::<Vec<f64>>());
        let half_width = moments.half_width(confidence);
        let [mean, low, high] = [0.0, -half_width, half_width].map(|off| (moments.mean + off).exp());
        Some(Ratio { mean, low, high, least, greatest })
    }

    /// Where each row stands, the least figure first, by paired t tests of every pair over the replicates: the chance that
    /// any two equal rows are told apart is `level`. A row without a figure in some replicate has no place.
    pub(crate) fn places(&self, level: f64) -> Vec<Option<Place>> {
        let whole: Vec<usize> = (0..self.0.len()).filter(|&row| self.0[row].iter().all(Option::is_some)).collect();
        let means: Vec<f64> =
            whole.iter().map(|&row| Moments::of(self.0[row].iter().flatten().copied()).mean).collect();
        let mut sorted: Vec<usize> = (0..whole.len()).collect();
        sorted.sort_by(|&i, &j| means[i].total_cmp(&means[j]));
        let p_value = |(i, j): (usize, usize)| self.p_value(whole[sorted[i]], whole[sorted[j]]);
        let p_values: Vec<f64> = pairs(whole.len()).map(p_value).collect();
        let verdicts = Verdicts::new(whole.len(), &holm(&p_values, level));
        let mut all = vec![None; self.0.len()];
        for (row, place) in whole.into_iter().zip(places(&sorted, &verdicts)) {
            all[row] = Some(place);
        }
        all
    }

    /// That two rows are equal, by the t test of their paired logarithms; 1 where nothing can be said.
    fn p_value(&self, a: usize, b: usize) -> f64 {
        let moments = Moments::of(self.differences(a, b).map(|(_, log)| log).collect::<Vec<f64>>());
        let t = moments.mean / moments.standard_error();
        if moments.n < 2 || t.is_nan() { 1.0 } else { student_p(t, moments.n - 1) }
    }

    fn differences(&self, row: usize, base: usize) -> impl Iterator<Item = (usize, f64)> {
        let pairs = self.0[row].iter().zip(&self.0[base]).enumerate();
        pairs.filter_map(|(at, (row, base))| Some((at, row.as_ref()? - base.as_ref()?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    fn whole(rows: &[&[f64]]) -> Replicates {
        Replicates::of(rows.iter().map(|row| row.iter().copied().map(Some).collect()).collect())
    }

    fn normal(stream: &mut Stream) -> f64 {
        (-2.0 * (1.0 - stream.uniform64()).ln()).sqrt() * (std::f64::consts::TAU * stream.uniform64()).cos()
    }

    #[test]
    fn a_ratio_is_that_of_the_hand() {
        // Ratios 2, 4 and 8: logarithms 1, 2 and 3 times ln 2, whose mean is 2 and whose standard error is 1 / sqrt 3.
        let found = whole(&[&[2.0, 12.0, 8.0], &[1.0, 3.0, 1.0]]).over(0, 1, 0.95).expect("three replicates");
        // Student's 97.5 % of two degrees of freedom is 4.302653.
        let far = 2f64.powf(4.302_653 / 3f64.sqrt());
        assert!((found.mean - 4.0).abs() < 1e-12, "{found:?}");
        assert!((found.low - 4.0 / far).abs() < 1e-5 && (found.high - 4.0 * far).abs() < 1e-3, "{found:?}");
        assert!((found.least.0 - 2.0).abs() < 1e-12 && found.least.1 == 0, "{found:?}");
        assert!((found.greatest.0 - 8.0).abs() < 1e-12 && found.greatest.1 == 2, "{found:?}");
    }

    #[test]
    fn only_replicates_that_have_both_are_paired() {
        let figures = vec![vec![Some(6.0), None, Some(5.0), Some(0.0)], vec![Some(2.0), Some(1.0), None, Some(1.0)]];
        let replicates = Replicates::of(figures);
        assert_eq!([replicates.measured(0), replicates.measured(1)], [2, 3]);
        let found = replicates.over(0, 1, 0.95).expect("one replicate");
        assert!((found.mean - 3.0).abs() < 1e-12 && found.low == 0.0 && found.high == f64::INFINITY, "{found:?}");
        assert_eq!(replicates.places(0.05), [None, None]);
        assert_eq!(Replicates::of(vec![vec![None], vec![Some(1.0)]]).over(0, 1, 0.95), None);
    }

    #[test]
    fn rows_stand_in_the_order_that_their_pairs_tell() {
        // What makes a replicate hard is common to all rows: by their own spread, none could be told from another.
        let hard = [1.0, 10.0, 100.0, 1000.0];
        let scaled = |by: [f64; 4]| std::array::from_fn::<f64, 4, _>(|i| hard[i] * by[i]);
        let rows = [scaled([4.0, 4.1, 3.9, 4.0]), scaled([1.0, 1.02, 0.99, 1.0]), scaled([1.0, 1.0, 1.01, 0.99])];
        let places = whole(&rows.each_ref().map(|row| &row[..])).places(0.05);
        let of = |row: usize| places[row].clone().expect("measured everywhere");
        assert_eq!((of(0).rank, of(1).rank, of(2).rank), ([3, 3], [1, 2], [1, 2]));
        assert!(of(1).letters == of(2).letters && of(0).letters != of(1).letters, "{places:?}");
        // The same in all replicates: nothing can be said. By the same factor: nothing could be surer.
        let [a, b, c] = [[1.0, 2.0], [1.0, 2.0], [2.0, 4.0]];
        let places = whole(&[&a, &b, &c]).places(0.05);
        assert_eq!(places.iter().flatten().map(|place| place.rank).collect::<Vec<_>>(), [[1, 2], [1, 2], [3, 3]]);
    }

    #[test]
    fn the_interval_covers_and_equal_rows_are_seldom_told_apart() {
        let mut stream = Stream::keyed(&[33]);
        const TRIALS: u32 = 4_000;
        let (mut held, mut told) = (0u32, 0u32);
        for _ in 0..TRIALS {
            // Six replicates of four equal rows: a factor that all share, and one of each.
            let hard: Vec<f64> = (0..6).map(|_| 2.0 * normal(&mut stream)).collect();
            let row = |stream: &mut Stream| hard.iter().map(|h| Some((h + 0.5 * normal(stream)).exp())).collect();
            let replicates = Replicates::of((0..4).map(|_| row(&mut stream)).collect());
            let found = replicates.over(0, 1, 0.95).expect("six replicates");
            held += u32::from((found.low..=found.high).contains(&1.0));
            told += u32::from(replicates.places(0.05).iter().flatten().any(|place| place.rank != [1, 4]));
        }
        // 3,800 and at most 200 are expected; four standard deviations are 55.
        assert!((3_745..=3_855).contains(&held), "{held} of {TRIALS} held, seed 33");
        assert!((60..=255).contains(&told), "{told} of {TRIALS} told apart, seed 33");
    }
}
