//! How far is an image from the truth?

use super::target::places;
use crate::base::colour::luminance;
use crate::base::interval::LARGEST;
use crate::base::rel_mse::{Means, RelMse};
use crate::record::Row;
use glam::{DVec3, Vec3};

/// The exact radiance of the measured receivers: two independent halves, equal where the sum is free of noise.
///
/// Where receivers move it is the mean over those that a number of passes visits, and there is one for each such number:
/// see [`after`](Self::after). All of them weigh a receiver's errors alike, by the radiance after the most passes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Truth {
    halves: [Vec<Vec3>; 2],
    mean: Vec<Vec3>,
    relative: RelMse,
    /// What each receiver's errors are weighed by: see [`RelMse::weight`].
    weights: Vec<DVec3>,
    /// Receivers by luminance of the truth, darkest first.
    by_luminance: Vec<u32>,
    /// Where receivers move: after each number of passes, ascending, the last of them this one's own.
    budgets: Vec<(u32, Self)>,
}

/// The errors of one image, over receivers and channels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Errors {
    /// Mean squared error, in (cd/m^2)^2.
    pub mse: f64,
    /// Mean of squared error over (squared truth + epsilon).
    pub rel_mse: f64,
    /// The same without the worst 0.1 % of the receivers.
    pub rel_mse_trimmed: f64,
    /// Share of `rel_mse` that those hold.
    pub trimmed_share: f64,
    /// What the worst receivers add to `rel_mse`, the worst first: they say how far the mean over runs can be trusted
    /// (see [`Tail`](crate::base::interval::Tail)).
    pub largest: [f64; LARGEST],
    /// Mean luminance over the truth's; 1 where both are 0.
    pub energy_ratio: f64,
    /// relMSE by tenths of the truth's luminance, darkest first.
    pub deciles: [f64; 10],
}

impl Errors {
    /// The row with these errors in it.
    pub(crate) fn written_to(self, row: Row) -> Row {
        Row {
            mse: self.mse,
            rel_mse: self.rel_mse,
            rel_mse_trimmed: self.rel_mse_trimmed,
            trimmed_share: self.trimmed_share,
            largest: self.largest,
            energy_ratio: self.energy_ratio,
            deciles: self.deciles,
            ..row
        }
    }
}

impl Truth {
    /// From two independent halves.
    pub(crate) fn new(halves: [Vec<Vec3>; 2]) -> Self {
        let mean: Vec<Vec3> =
            halves[0].iter().zip(&halves[1]).map(|(&a, &b)| if a == b { a } else { (a + b) * 0.5 }).collect();
        let mut by_luminance: Vec<u32> = (0..mean.len() as u32).collect();
        by_luminance.sort_by(|&a, &b| luminance(mean[a as usize]).total_cmp(&luminance(mean[b as usize])));
        let relative = RelMse::about(&mean);
        let weights = mean.iter().map(|&radiance| relative.weight(radiance)).collect();
        Self { halves, mean, relative, weights, by_luminance, budgets: Vec::new() }
    }

    /// Of receivers that move: from two independent halves after each number of passes, ascending.
    pub(crate) fn of_budgets(halves: Vec<(u32, [Vec<Vec3>; 2])>) -> Self {
        let budgets: Vec<(u32, Self)> =
            halves.into_iter().map(|(passes, halves)| (passes, Self::new(halves))).collect();
        let Some((_, longest)) = budgets.last().cloned() else { return Self::default() };
        let mut all = Self { budgets, ..longest.clone() };
        all.weigh(longest.relative, &longest.weights);
        all
    }

    /// The truth after so many passes: one of the target's [budgets](super::target::Target::budgets) where receivers move,
    /// any number where they stay.
    pub(crate) fn after(&self, passes: u32) -> &Self {
        if self.budgets.is_empty() {
            return self;
        }
        let known = self.budgets.iter().find(|(budget, _)| *budget == passes);
        known.map(|(_, truth)| truth).expect("a number of passes that the truth was asked for")
    }

    /// The truth at about `count` of its receivers: those of [`Target::thinned`](super::target::Target::thinned).
    pub(crate) fn thinned(&self, count: usize) -> Self {
        self.at(&places(self.mean.len(), count).collect::<Vec<usize>>())
    }

    /// The truth at some of its receivers, weighed as among all of them.
    pub(crate) fn only(&self, places: &[usize]) -> Self {
        let weights: Vec<DVec3> = places.iter().map(|&i| self.weights[i]).collect();
        let mut some = self.at(places);
        some.weigh(self.relative, &weights);
        some
    }

    fn at(&self, places: &[usize]) -> Self {
        let some = |half: &Vec<Vec3>| places.iter().map(|&i| half[i]).collect();
        let of = |truth: &Self| [some(&truth.halves[0]), some(&truth.halves[1])];
        if self.budgets.is_empty() {
            return Self::new(of(self));
        }
        Self::of_budgets(self.budgets.iter().map(|(passes, truth)| (*passes, of(truth))).collect())
    }

    fn weigh(&mut self, relative: RelMse, weights: &[DVec3]) {
        for truth in self.budgets.iter_mut().map(|(_, truth)| truth) {
            truth.weigh(relative, weights);
        }
        (self.relative, self.weights) = (relative, weights.to_vec());
    }

    /// The best estimate, in cd/m^2.
    pub(crate) fn mean(&self) -> &[Vec3] {
        &self.mean
    }

    /// How squared errors are weighed.
    pub(crate) fn relative(&self) -> RelMse {
        self.relative
    }

    /// The epsilon of relMSE, per channel.
    pub(crate) fn epsilon(&self) -> Vec3 {
        self.relative.epsilon()
    }

    /// Variance of the luminance of [`mean`](Self::mean) at a receiver, from the two halves; 0 for an exact sum.
    pub(crate) fn variance(&self, i: usize) -> f64 {
        // The variance of the mean of two is a quarter of the square of their difference, on average.
        f64::from(luminance(self.halves[0][i]) - luminance(self.halves[1][i])).powi(2) / 4.0
    }

    /// relMSE of the mean of the halves about what it estimates; 0 for an exact sum.
    pub(crate) fn own_rel_mse(&self) -> f64 {
        // The variance of the mean of two is a quarter of the square of their difference, on average.
        self.mean_over(|i| {
            let difference = (self.halves[0][i] - self.halves[1][i]).as_dvec3();
            difference * difference * 0.25 * self.weight(i)
        })
    }

    /// Standard error of the mean luminance as a share of it; 0 for an exact sum.
    pub(crate) fn own_energy_error(&self) -> f64 {
        // Receivers are sampled independently.
        let variance: f64 = (0..self.mean.len()).map(|i| self.variance(i)).sum();
        let total: f64 = self.mean.iter().map(|&x| f64::from(luminance(x))).sum();
        if total > 0.0 { variance.sqrt() / total } else { 0.0 }
    }

    /// What the squared error of a receiver is multiplied by, per channel: see [`RelMse::weight`].
    pub(crate) fn weight(&self, i: usize) -> DVec3 {
        self.weights[i]
    }

    /// Mean over receivers and channels.
    pub(crate) fn mean_over(&self, value: impl Fn(usize) -> DVec3) -> f64 {
        let n = self.mean.len();
        if n == 0 { 0.0 } else { (0..n).map(|i| value(i).element_sum()).sum::<f64>() / (3 * n) as f64 }
    }

    /// `(x - first half)(x - second half)`: its mean over runs is the squared error without the truth's own noise.
    pub(crate) fn product(&self, i: usize, x: DVec3) -> DVec3 {
        (x - self.halves[0][i].as_dvec3()) * (x - self.halves[1][i].as_dvec3())
    }

    /// All errors of an image.
    pub(crate) fn errors(&self, image: &[Vec3]) -> Errors {
        let n = self.mean.len();
        if n == 0 {
            return Errors { energy_ratio: 1.0, ..Errors::default() };
        }
        let squares: Vec<DVec3> = (0..n).map(|i| self.product(i, image[i].as_dvec3())).collect();
        let relative: Vec<f64> = (0..n).map(|i| (squares[i] * self.weight(i)).element_sum() / 3.0).collect();
        let Means { all: rel_mse, trimmed: rel_mse_trimmed, trimmed_share } = Means::of(&relative);
        let energy = |image: &[Vec3]| image.iter().map(|&x| f64::from(luminance(x))).sum::<f64>();
        let (energy, expected) = (energy(image), energy(&self.mean));
        Errors {
            mse: squares.iter().map(|s| s.element_sum()).sum::<f64>() / (3 * n) as f64,
            rel_mse,
            rel_mse_trimmed,
            trimmed_share,
            largest: largest(&relative).map(|error| error / n as f64),
            energy_ratio: if expected > 0.0 { energy / expected } else { 1.0 },
            deciles: std::array::from_fn(|d| {
                let part = &self.by_luminance[d * n / 10..(d + 1) * n / 10];
                part.iter().map(|&i| relative[i as usize]).sum::<f64>() / part.len().max(1) as f64
            }),
        }
    }
}

/// The largest of these numbers above 0, largest first; 0 where there are fewer.
fn largest(values: &[f64]) -> [f64; LARGEST] {
    let mut found = [0.0; LARGEST];
    // Written so that a NaN is none of them.
    for &value in values.iter().filter(|x| **x > 0.0) {
        let place = found.partition_point(|&x| x >= value);
        if place < LARGEST {
            found[place..].rotate_right(1);
            found[place] = value;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(values: &[f32]) -> Truth {
        let image: Vec<Vec3> = values.iter().map(|&v| Vec3::splat(v)).collect();
        Truth::new([image.clone(), image])
    }

    #[test]
    fn the_truth_itself_has_no_error() {
        let truth = truth(&[0.0, 1.0, 2.0, 5.0]);
        let errors = truth.errors(truth.mean());
        assert_eq!((errors.mse, errors.rel_mse, errors.energy_ratio), (0.0, 0.0, 1.0));
        assert_eq!(truth.own_rel_mse(), 0.0);
    }

    #[test]
    fn errors_of_a_known_image() {
        // Mean 2: epsilon is 0.01 * 4 = 0.04.
        let truth = truth(&[1.0, 3.0]);
        let errors = truth.errors(&[Vec3::splat(2.0), Vec3::splat(3.0)]);
        assert!((errors.mse - 0.5).abs() < 1e-7);
        assert!((errors.rel_mse - 0.5 / 1.04).abs() < 1e-7, "{}", errors.rel_mse);
        assert!((errors.energy_ratio - 1.25).abs() < 1e-7);
    }

    #[test]
    fn the_largest_parts_are_kept_in_order() {
        assert_eq!(largest(&[1.0, 5.0, f64::NAN, 2.0, 4.0, -1.0, 3.0]), [5.0, 4.0, 3.0, 2.0]);
        assert_eq!(largest(&[1.0]), [1.0, 0.0, 0.0, 0.0]);
        let truth = truth(&[1.0, 3.0]);
        let errors = truth.errors(&[Vec3::splat(2.0), Vec3::splat(3.0)]);
        assert!((errors.largest[0] - errors.rel_mse).abs() < 1e-12 && errors.largest[1] == 0.0);
    }

    #[test]
    fn noise_of_the_truth_is_seen_and_taken_out() {
        let n = 20_000;
        let noise = |seed: u64| {
            let mut rng = crate::base::random::Stream::keyed(&[seed]);
            (0..n).map(|_| Vec3::splat(1.0 + 0.1 * (rng.uniform() - 0.5))).collect::<Vec<_>>()
        };
        let truth = Truth::new([noise(1), noise(2)]);
        // Uniform noise of width 0.1 has variance 0.1^2 / 12; the mean of two has half of it.
        assert!((truth.own_rel_mse() * 1.01 * 2.0 / (0.01 / 12.0) - 1.0).abs() < 0.05, "{}", truth.own_rel_mse());
        let errors = truth.errors(&vec![Vec3::splat(1.0); n]);
        assert!(errors.mse.abs() < 0.01 / 12.0 * 0.05, "{}", errors.mse);
    }

    #[test]
    fn a_black_scene_divides_nothing_by_nothing() {
        let truth = truth(&[0.0, 0.0]);
        let errors = truth.errors(&[Vec3::ZERO; 2]);
        assert_eq!((errors.rel_mse, errors.energy_ratio), (0.0, 1.0));
    }
}
