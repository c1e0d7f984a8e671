//! What is found on cities that are made ready, each with its truth at some of its receivers?

use super::engine::Engine;
use super::observer::Observer;
use super::reference::{Reference, Wanted};
use super::target::Target;
use super::tune::{City, Tuner};
use crate::base::error::{Error, Result};
use crate::record::Program;
use crate::record::tuned::{Condition, Tuned};
use crate::strategy::Configured;
use crate::visibility::stage::Stage;
use glam::Vec3;
use std::path::Path;

/// How many cities are tuned on.
pub(crate) const CITIES: usize = 5;
/// Runs on each city that a choice rests on, as in `study elsewhere`.
pub(crate) const RUNS: u32 = 4;

/// Receivers of a frame that errors are taken at.
pub(crate) const PIXELS: usize = 512;
/// The reference's own relMSE, where its work allows: far below any error that a choice rests on.
pub(crate) const OWN_REL_MSE: f64 = 1e-5;
/// Most counted work of a city's reference, in nominal seconds.
const REFERENCE_S: f64 = 24.0;
/// Most passes where receivers move: the truth must be known at all that they visit.
pub(crate) const MOST_MOVING: u32 = 64;

/// Where the errors of a city are taken, and against what.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    /// The numbers of passes that a run may have, ascending.
    pub passes: &'a [u32],
    /// Most receivers of the frame that errors are taken at.
    pub pixels: usize,
    /// The reference's own relMSE, where its work allows; where receivers move, that after the fewest passes.
    pub own_rel_mse: f64,
    /// Most counted work of a city's reference, in nominal seconds, where that is less than usual.
    pub reference_work_s: f64,
    /// Folder of cached references.
    pub cache: &'a Path,
}

/// How parameters are looked for.
pub(crate) struct Search<'a> {
    /// Who does the runs.
    pub engine: &'a Engine<'a>,
    /// Nominal CPU seconds of a run, set-up in.
    pub time_s: f64,
    /// The user's seed.
    pub seed: u64,
    /// Where errors are taken.
    pub ground: Ground<'a>,
    /// The program, where it is not this crate's own.
    pub program: Option<Program>,
}

impl Search<'_> {
    /// Tunes every strategy that has a choice on the cities in which there is something to see.
    ///
    /// # Errors
    /// As [`with`](Self::with) and [`Tuner::all`].
    pub(crate) fn on(
        &self,
        stages: &[Stage],
        grids: &[Vec<Configured>],
        condition: Condition,
        watch: &dyn Observer,
    ) -> Result<Tuned> {
        self.with(stages, watch, |tuner| tuner.all(grids, condition, self.program.clone(), watch))
    }

    /// Does something with a tuner on the cities in which there is something to see.
    ///
    /// # Errors
    /// Cities of which none has a lit surface in view; an error of `tune`; as [`Reference::bounded`].
    pub(crate) fn with<T>(
        &self,
        stages: &[Stage],
        watch: &dyn Observer,
        tune: impl FnOnce(&Tuner<'_>) -> Result<T>,
    ) -> Result<T> {
        let known = |stage| self.ground.of(stage, watch);
        let mut grounds: Vec<(Target<'_>, Reference)> = stages.iter().map(known).collect::<Result<_>>()?;
        grounds.retain(|(_, reference)| reference.truth.mean().iter().any(|&radiance| radiance != Vec3::ZERO));
        if grounds.is_empty() {
            let cities = stages.len();
            return Err(Error::Invalid(format!(
                "nothing can be tuned: none of {cities} cities has a lit surface in view"
            )));
        }
        let cities: Vec<City<'_>> =
            grounds.iter().map(|(target, reference)| City { target, truth: &reference.truth }).collect();
        let Self { engine, time_s, seed, ground, .. } = *self;
        tune(&Tuner { engine, cities: &cities, time_s, passes: ground.passes, runs: RUNS, seed })
    }
}

impl Ground<'_> {
    /// A stage measured at some of its receivers, and what is true there.
    ///
    /// # Errors
    /// As [`Reference::bounded`].
    pub(crate) fn of<'s>(&self, stage: &'s Stage, watch: &dyn Observer) -> Result<(Target<'s>, Reference)> {
        let target = Target::whole(stage).thinned(self.pixels).after(self.passes.iter().copied());
        // It falls as 1 / passes where each has receivers of its own; what is asked for is that after the most.
        let most = target.budgets().last().map_or(1.0, |&most| f64::from(most));
        let wanted = Wanted { work_s: REFERENCE_S.min(self.reference_work_s), ..Wanted::new(self.own_rel_mse / most) };
        Reference::bounded(&target, wanted, self.cache, watch)
    }
}

/// The numbers of passes that a run may have: powers of two, and half as many more. Where receivers move, no more than
/// [`MOST_MOVING`].
pub(crate) fn passes(most: u32, moves: bool) -> Vec<u32> {
    let twos = (0..31).map(|power| 1u32 << power);
    let mut all: Vec<u32> = twos.flat_map(|passes| [passes, passes / 2 * 3]).filter(|&passes| passes > 0).collect();
    let most = if moves { most.min(MOST_MOVING) } else { most };
    all.retain(|&passes| passes <= most);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_are_powers_of_two_and_half_as_many_more() {
        assert_eq!(passes(64, false), [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64]);
        assert_eq!(passes(5, true), [1, 2, 3, 4]);
        assert_eq!(passes(1, false), [1]);
        assert!(passes(1 << 24, false).is_sorted());
    }
}
