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
pub(crate) const RUNS: u32 = 6;

/// Receivers of a frame that errors are taken at.
const PIXELS: usize = 512;
/// The reference's own relMSE, where its work allows: far below any error that a choice rests on.
const OWN_REL_MSE: f64 = 1e-5;
/// Most counted work of a city's reference, in nominal seconds.
const REFERENCE_S: f64 = 24.0;
/// Most passes where receivers move: the truth must be known at all that they visit.
const MOST_MOVING: u32 = 64;

/// How parameters are looked for.
pub(crate) struct Search<'a> {
    /// Who does the runs.
    pub engine: &'a Engine<'a>,
    /// Nominal CPU seconds of a run, set-up in.
    pub time_s: f64,
    /// Most passes of a run.
    pub most_passes: u32,
    /// The user's seed.
    pub seed: u64,
    /// Most counted work of a city's reference, in nominal seconds, where that is less than usual.
    pub reference_work_s: f64,
    /// Folder of cached references.
    pub cache: &'a Path,
    /// The program, where it is not this crate's own.
    pub program: Option<Program>,
}

impl Search<'_> {
    /// Tunes every strategy that has a choice on the cities in which there is something to see.
    ///
    /// # Errors
    /// Cities of which none has a lit surface in view; as [`Tuner::all`] and [`Reference::bounded`].
    pub(crate) fn on(
        &self,
        stages: &[Stage],
        grids: &[Vec<Configured>],
        condition: Condition,
        watch: &dyn Observer,
    ) -> Result<Tuned> {
        let moves = stages.iter().any(|stage| stage.visits().moves());
        let passes = passes(if moves { self.most_passes.min(MOST_MOVING) } else { self.most_passes });
        let known = |stage| {
            let target = Target::whole(stage).thinned(PIXELS).after(passes.iter().copied());
            let wanted = Wanted { work_s: REFERENCE_S.min(self.reference_work_s), ..Wanted::new(OWN_REL_MSE) };
            Reference::bounded(&target, wanted, self.cache, watch)
        };
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
        let Self { engine, time_s, seed, .. } = *self;
        let tuner = Tuner { engine, cities: &cities, time_s, passes: &passes, runs: RUNS, seed };
        tuner.all(grids, condition, self.program.clone(), watch)
    }
}

/// The numbers of passes that a run may have: powers of two, and half as many more.
fn passes(most: u32) -> Vec<u32> {
    let twos = (0..31).map(|power| 1u32 << power);
    let mut all: Vec<u32> = twos.flat_map(|passes| [passes, passes / 2 * 3]).filter(|&passes| passes > 0).collect();
    all.retain(|&passes| passes <= most);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_are_powers_of_two_and_half_as_many_more() {
        assert_eq!(passes(64), [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64]);
        assert_eq!(passes(5), [1, 2, 3, 4]);
        assert_eq!(passes(1), [1]);
        assert!(passes(1 << 24).is_sorted());
    }
}
