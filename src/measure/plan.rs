//! How far can each strategy go within its budget?
//!
//! A pilot on a few receivers times one pass, counts its work and guesses its error; budgets then double from one pass
//! up to the last that fits. The guess says how good the reference must be.

use super::clock::timed;
use super::errors::Truth;
use super::target::Target;
use crate::base::colour::luminance;
use crate::base::draws::Points;
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::render::counts::Counts;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::BuildContext;
use crate::strategy::registry::Configured;
use glam::Vec3;

/// What one strategy may spend in one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Passes that suffice if they make the image's mean certain enough to see a bias of [`DETECTABLE`] in it.
    pub usual_passes: u32,
    /// Most passes, if they do not.
    pub most_passes: u32,
    /// Most CPU seconds of sampling.
    pub seconds: f64,
}

/// What a pilot found.
#[derive(Clone, Debug)]
pub struct Pilot {
    /// Expected CPU seconds of coming to every receiver once, whatever the number of passes.
    arrive_s: f64,
    /// Expected CPU seconds of a pass over all receivers.
    pass_s: f64,
    /// relMSE that more passes take away, times passes.
    variance: f64,
    /// relMSE that stays.
    bias2: f64,
    /// Whether numbers are spread over a pixel's passes.
    spread: bool,
    /// Relative variance of the image's mean luminance, times passes.
    energy_variance: f64,
    /// What became of the samples.
    pub counts: Counts,
}

/// Receivers of a pilot.
pub(super) const RECEIVERS: usize = 512;

/// A bias of the image's mean that runs should be able to see.
pub const DETECTABLE: f64 = 0.05;

/// Passes of a pilot, and passes that work is counted over.
pub(super) const PASSES: u32 = 4;

impl Pilot {
    /// Tries a strategy on `RECEIVERS` of the target's receivers, with their truth.
    ///
    /// One that draws state for a pass or looks at its whole frame gets the whole frame: on a few receivers that cost
    /// would be out of proportion, and neighbours too far apart to be any.
    pub fn run(target: &Target<'_>, truth: &Truth, strategy: &Configured, seed: u64) -> Result<Self> {
        let sampler = strategy.build(BuildContext { stage: target.stage, seed })?;
        let all = target.frame.len();
        let Target { places, .. } = target.thinned(RECEIVERS);
        let few: Vec<Receiver> = places.iter().map(|&i| target.frame[i]).collect();
        let whole = sampler.most_passes() == 1;
        let frame: &[Receiver] = if whole { &target.frame } else { &few };
        let plan = |run| Plan {
            stage: target.stage,
            receivers: frame,
            sampler: sampler.as_ref(),
            key: RunKey { seed: !seed, run },
        };
        let film = |run, passes| {
            let mut film = Film::new(frame.len());
            let ((), spent) = timed(|| plan(run).run(passes, &mut film));
            let image = film.image();
            let image: Vec<Vec3> = if whole { places.iter().map(|&i| image[i]).collect() } else { image };
            (image, spent.cpu)
        };
        let scale = all as f64 / frame.len().max(1) as f64;
        film(0, 1); // Warms the caches.
        let one = film(0, 1).1 * scale;
        let (first, several) = film(1, PASSES);
        let (second, _) = film(2, PASSES);
        let pass_s = ((several * scale - one) / f64::from(PASSES - 1)).max(0.0);
        let errors = truth.errors(&first).rel_mse;
        let both = |i: usize| {
            let r = truth.mean()[i].as_dvec3();
            (first[i].as_dvec3() - r) * (second[i].as_dvec3() - r) * truth.weight(i)
        };
        let bias2 = truth.mean_over(both).max(0.0);
        let mean = |value: &dyn Fn(usize) -> f64| (0..first.len()).map(value).sum::<f64>() / first.len().max(1) as f64;
        let energy = mean(&|i| f64::from(luminance(truth.mean()[i])));
        let of_pixel = f64::from(PASSES) * mean(&|i| f64::from(luminance(first[i] - second[i])).powi(2) / 2.0);
        // Receivers are independent of one another: their mean has an n-th of their variance.
        let energy_variance = if energy > 0.0 { of_pixel / (all as f64 * energy * energy) } else { 0.0 };
        let counts = plan(3).run_counting(PASSES, &mut Film::new(frame.len()));
        Ok(Self {
            arrive_s: (one - pass_s).max(0.0),
            pass_s,
            variance: (errors - bias2).max(0.0) * f64::from(PASSES),
            bias2,
            spread: strategy.points() != Points::Random,
            energy_variance,
            counts,
        })
    }

    /// The budgets that fit, in passes: 1, 2, 4 and so on; none if one pass is too long.
    pub fn ladder(&self, budget: Budget, runs: u32) -> Vec<u32> {
        // 3 standard errors: Student's 97.5 % and 80 % points at 15 degrees of freedom; four times the variance, since
        // a pilot mostly misses the rare bright picks.
        let certain = 4.0 * self.energy_variance * (3.0 / DETECTABLE).powi(2) / f64::from(runs);
        let certain = (certain.min(1e9) as u32).next_power_of_two();
        let passes = certain.clamp(budget.usual_passes, budget.most_passes);
        let seconds = |rung: u32| f64::from(rung + 1) * self.arrive_s + f64::from(1u32 << rung) * self.pass_s;
        (0..31)
            .take_while(|&rung| 1 << rung <= passes && seconds(rung) <= budget.seconds)
            .map(|rung| 1 << rung)
            .collect()
    }

    /// The most passes, a power of two and no more than usual, that fit where they are done in one block.
    pub fn at_once(&self, budget: Budget) -> Option<u32> {
        let seconds = |passes: u32| self.arrive_s + f64::from(passes) * self.pass_s;
        let powers = (0..31).map(|power| 1 << power);
        powers.take_while(|&passes| passes <= budget.usual_passes && seconds(passes) <= budget.seconds).last()
    }

    /// Expected CPU seconds of the first pass.
    pub fn first_pass_s(&self) -> f64 {
        self.arrive_s + self.pass_s
    }

    /// Least relMSE that is to be expected after so many passes: it says how good a reference must be.
    ///
    /// Numbers that are spread over a pixel's passes make it fall faster than 1/n. Seen: 4 to 5 times lower than that
    /// after 64 passes, where most lights are seen; the square root of what they add to the pilot's passes gives 4
    /// there.
    pub fn expected_rel_mse(&self, passes: u32) -> f64 {
        let passes = f64::from(passes.max(1));
        let spread = if self.spread { (passes / f64::from(PASSES)).max(1.0).sqrt() } else { 1.0 };
        self.bias2 + self.variance / (passes * spread)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ladders_double_within_passes_and_seconds() {
        let pilot = Pilot {
            arrive_s: 0.1,
            pass_s: 0.1,
            variance: 1.0,
            bias2: 0.0,
            spread: false,
            energy_variance: 0.0,
            counts: Counts::default(),
        };
        assert_eq!(pilot.ladder(Budget { usual_passes: 20, most_passes: 20, seconds: 100.0 }, 16), [1, 2, 4, 8, 16]);
        // 8 passes in 4 blocks take 0.4 + 0.8 s.
        assert_eq!(pilot.ladder(Budget { usual_passes: 64, most_passes: 64, seconds: 1.25 }, 16), [1, 2, 4, 8]);
        assert!(pilot.ladder(Budget { usual_passes: 64, most_passes: 64, seconds: 0.1 }, 16).is_empty());
        // A relative variance of 0.225 a pass, with 16 runs: 4 * 0.225 * 3600 / 16 = 202 passes are needed.
        let noisy = Pilot { arrive_s: 0.0, pass_s: 1e-3, energy_variance: 0.225, ..pilot };
        assert_eq!(
            noisy.ladder(Budget { usual_passes: 64, most_passes: 1 << 20, seconds: 1.0 }, 16).last(),
            Some(&256)
        );
        assert_eq!(
            noisy.ladder(Budget { usual_passes: 64, most_passes: 1 << 20, seconds: 0.15 }, 16).last(),
            Some(&128)
        );
    }
}
