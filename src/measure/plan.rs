//! How far does each strategy go?
//!
//! Budgets are the same numbers of passes for all strategies: 1, 4, 16 and so on. A pilot on a few receivers counts a
//! strategy's work; it goes as far as its [nominal seconds](super::work) allow. Nothing here depends on how fast the
//! machine is: the same seed gives the same budgets everywhere. The pilot also guesses the error, which says how good
//! the reference must be.

use super::counted::Work;
use super::engine::{Account, Meter};
use super::errors::Truth;
use super::target::Target;
use crate::base::colour::luminance;
use crate::base::counts::Counts;
use crate::base::draws::Points;
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::{BuildContext, Configured};
use glam::Vec3;

/// What one strategy may spend in one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Budget {
    /// Passes that suffice if they make the image's mean certain enough to see a bias of [`DETECTABLE`] in it.
    pub usual_passes: u32,
    /// Most passes, if they do not.
    pub most_passes: u32,
    /// Most nominal seconds of sampling.
    pub work_s: f64,
}

impl Budget {
    /// Up to `passes` and no more.
    pub(crate) fn up_to(passes: u32, work_s: f64) -> Self {
        Self { usual_passes: passes, most_passes: passes, work_s }
    }
}

/// What a pilot found.
#[derive(Clone, Debug)]
pub(crate) struct Pilot {
    /// Nominal seconds of coming to every receiver of the frame once, whatever the number of passes.
    arrive_s: f64,
    /// Nominal seconds of a pass over the frame.
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
    /// What it took, on the strategy's clock and on the process's.
    pub account: Account,
}

/// Receivers of a pilot's errors.
pub(crate) const RECEIVERS: usize = 512;

/// A bias of the image's mean that runs should be able to see.
pub(crate) const DETECTABLE: f64 = 0.05;

/// Passes of a pilot, and passes that work is counted over.
pub(crate) const PASSES: u32 = 4;

impl Pilot {
    /// Tries a strategy on a few of the target's receivers, with their truth: that of `target.thinned(RECEIVERS)`
    /// after [`PASSES`] passes.
    ///
    /// One that draws state for a pass or looks at its whole frame gets the whole frame: on a few receivers that cost
    /// would be out of proportion, and neighbours too far apart to be any.
    ///
    /// # Errors
    /// A strategy that cannot serve the scene.
    pub(crate) fn run(
        target: &Target<'_>,
        truth: &Truth,
        strategy: &Configured,
        seed: u64,
        meter: Meter<'_>,
    ) -> Result<Self> {
        let (found, account) = meter.audit(|| Self::tried(target, truth, strategy, seed));
        Ok(Self { account, ..found? })
    }

    fn tried(target: &Target<'_>, truth: &Truth, strategy: &Configured, seed: u64) -> Result<Self> {
        let truth = truth.after(PASSES);
        let sampler = strategy.build(BuildContext { stage: target.stage, seed })?;
        let frame = &target.frame;
        let places = target.thinned(RECEIVERS).places;
        let whole = sampler.most_passes() == 1;
        let few: Vec<Receiver> = places.iter().map(|&i| frame[i]).collect();
        let plan = |receivers, run| Plan {
            stage: target.stage,
            receivers,
            sampler: sampler.as_ref(),
            key: RunKey { seed: !seed, run },
        };
        let image = |run| -> Vec<Vec3> {
            let receivers: &[Receiver] = if whole { frame } else { &few };
            let mut film = Film::new(receivers.len());
            plan(receivers, run).run(PASSES, &mut film);
            let image = film.image();
            if whole { places.iter().map(|&i| image[i]).collect() } else { image }
        };
        let (first, second) = (image(1), image(2));
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
        let measured = target.places.len().max(1) as f64;
        let energy_variance = if energy > 0.0 { of_pixel / (measured * energy * energy) } else { 0.0 };
        let key = RunKey { seed: !seed, run: 3 };
        let fresh = || strategy.build(BuildContext { stage: target.stage, seed });
        let Work { arrive_s, pass_s, counts, .. } = Work::at_squares(target, &fresh, key, PASSES)?;
        Ok(Self {
            arrive_s,
            pass_s,
            variance: (errors - bias2).max(0.0) * f64::from(PASSES),
            bias2,
            spread: strategy.points() != Points::Random,
            energy_variance,
            counts,
            account: Account::default(),
        })
    }

    /// The budgets that fit, in passes: 1, 4, 16 and so on; none if one pass is too much work.
    pub(crate) fn ladder(&self, budget: Budget, runs: u32) -> Vec<u32> {
        // 3 standard errors: Student's 97.5 % and 80 % points at 15 degrees of freedom; four times the variance, since
        // a pilot mostly misses the rare bright picks.
        let certain = 4.0 * self.energy_variance * (3.0 / DETECTABLE).powi(2) / f64::from(runs);
        let certain = budgets(1 << 30).find(|&passes| f64::from(passes) >= certain).unwrap_or(1 << 30);
        let most = certain.clamp(budget.usual_passes, budget.most_passes);
        budgets(most).take_while(|&passes| self.work_s(passes) <= budget.work_s).collect()
    }

    /// Nominal seconds of so many passes in one block.
    pub(crate) fn work_s(&self, passes: u32) -> f64 {
        self.arrive_s + f64::from(passes) * self.pass_s
    }

    /// Least relMSE that is to be expected after so many passes: it says how good a reference must be.
    ///
    /// Numbers that are spread over a pixel's passes make it fall faster than 1/n. Seen: 4 to 5 times lower than that
    /// after 64 passes, where most lights are seen; the square root of what they add to the pilot's passes gives 4
    /// there.
    pub(crate) fn expected_rel_mse(&self, passes: u32) -> f64 {
        let passes = f64::from(passes.max(1));
        let spread = if self.spread { (passes / f64::from(PASSES)).max(1.0).sqrt() } else { 1.0 };
        self.bias2 + self.variance / (passes * spread)
    }
}

/// The budgets of every plan up to `most` passes: powers of 4, and `most` itself where it is none.
pub(crate) fn budgets(most: u32) -> impl Iterator<Item = u32> {
    let powers = (0..16).map(|power| 1u32 << (2 * power)).take_while(move |&passes| passes < most);
    powers.chain((most > 0).then_some(most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_grow_fourfold_within_passes_and_work() {
        let pilot = Pilot {
            arrive_s: 0.1,
            pass_s: 0.1,
            variance: 1.0,
            bias2: 0.0,
            spread: false,
            energy_variance: 0.0,
            counts: Counts::default(),
            account: Account::default(),
        };
        assert_eq!(pilot.ladder(Budget::up_to(64, 100.0), 16), [1, 4, 16, 64]);
        assert_eq!(pilot.ladder(Budget::up_to(20, 100.0), 16), [1, 4, 16, 20]);
        // 16 passes in one block are 0.1 + 1.6 s.
        assert_eq!(pilot.ladder(Budget::up_to(64, 1.71), 16), [1, 4, 16]);
        assert_eq!(pilot.ladder(Budget::up_to(64, 1.69), 16), [1, 4]);
        assert!(pilot.ladder(Budget::up_to(64, 0.1), 16).is_empty());
        // A relative variance of 0.225 a pass, with 16 runs: 4 * 0.225 * 3600 / 16 = 202 passes are needed.
        let noisy = Pilot { arrive_s: 0.0, pass_s: 1e-3, energy_variance: 0.225, ..pilot };
        let budget = Budget { usual_passes: 64, most_passes: 1 << 20, work_s: 1.0 };
        assert_eq!(noisy.ladder(budget, 16).last(), Some(&256));
        assert_eq!(noisy.ladder(Budget { work_s: 0.15, ..budget }, 16).last(), Some(&64));
    }
}
