//! Which condition, size, city and view is a case?

use super::super::session::Session;
use crate::base::error::{Error, Result};
use crate::measure::tune;
use crate::measure::tuning_cities::{CITIES, Ground, PIXELS, passes};
use crate::scene::Scene;
use crate::sources::city::View;
use crate::sources::{self, Overrides};
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use crate::visibility::visits::Receivers;
use std::path::Path;

/// Pixels across and down where nobody says otherwise.
const RESOLUTION: (u32, u32) = (96, 54);
/// Most passes of a run. Where receivers move, the truth must be known at all that they visit.
pub(super) const STAYING: u32 = 128;
pub(super) const MOVING: u32 = 8;

/// All cases of a study.
#[derive(Clone, Copy)]
pub(super) struct Cases<'a> {
    pub(super) session: &'a Session<'a>,
    pub(super) recipe: &'a Path,
    /// Lights of the smallest cities.
    pub(super) fewest: u64,
    /// Nominal seconds of a run among the fewest lights, set-up in.
    pub(super) time_s: f64,
    /// Independent runs of a strategy in a case.
    pub(super) runs: u32,
}

/// The cases of one condition and size.
#[derive(Clone, Copy)]
pub(super) struct Size<'a> {
    pub(super) cases: Cases<'a>,
    pub(super) receivers: Receivers,
    pub(super) lights: u64,
}

impl<'a> Cases<'a> {
    /// The small cities that are reported: what has no city, or no room for a view, shows here.
    pub(super) fn first(&self, lights: u64) -> Result<Vec<Scene>> {
        (0..CITIES).map(|city| self.reported(lights, city)).collect()
    }

    /// The n-th city that is reported.
    fn reported(&self, lights: u64, city: usize) -> Result<Scene> {
        let first = self.open(lights, self.session.options.overrides.seed, view(city))?;
        let seed = first.seed().checked_add(city as u64).ok_or_else(|| {
            Error::Invalid(format!("the seeds of {CITIES} cities go beyond {}: take a smaller --scene-seed", u64::MAX))
        })?;
        if city == 0 { Ok(first) } else { self.open(lights, Some(seed), view(city)) }
    }

    pub(super) fn size(self, receivers: Receivers, lights: u64) -> Size<'a> {
        Size { cases: self, receivers, lights }
    }

    fn open(&self, lights: u64, seed: Option<u64>, view: View) -> Result<Scene> {
        let own = &self.session.options.overrides;
        let resolution = own.resolution.or(Some(RESOLUTION));
        sources::open(
            self.recipe,
            &Overrides { lights: Some(lights), seed, view: Some(view), resolution, ..own.clone() },
        )
    }
}

/// The view of the n-th city: all are taken in turn.
pub(super) fn view(city: usize) -> View {
    View::ALL[city % View::ALL.len()]
}

impl Size<'_> {
    /// Nominal seconds of a run, set-up in: half as many more for ten times the lights, whose set-up would else take most of
    /// them.
    pub(super) fn time_s(&self) -> f64 {
        let tens =
            (0..).take_while(|&tens| self.cases.fewest.saturating_mul(10u64.pow(tens + 1)) <= self.lights).count();
        self.cases.time_s * 1.5f64.powi(tens as i32)
    }

    /// The n-th city that is reported.
    pub(super) fn reported(&self, city: usize) -> Result<Stage> {
        self.stage(self.cases.reported(self.lights, city)?)
    }

    /// Seeds of the cities that parameters are found on: none that is reported.
    pub(super) fn others(&self) -> Result<Vec<u64>> {
        let first = self.cases.reported(self.lights, 0)?.seed();
        let is_reported = |seed: &u64| seed.wrapping_sub(first) < CITIES as u64;
        Ok(tune::seeds(first, 2 * CITIES).into_iter().filter(|seed| !is_reported(seed)).take(CITIES).collect())
    }

    /// A city of a seed, seen as the n-th.
    pub(super) fn other(&self, seed: u64, city: usize) -> Result<Stage> {
        self.stage(self.cases.open(self.lights, Some(seed), view(city))?)
    }

    fn stage(&self, scene: Scene) -> Result<Stage> {
        Ok(Stage::visiting(scene, LeaveOut::Yes, Offset::SCALED, self.receivers))
    }

    /// The numbers of passes that a run may have, ascending.
    pub(super) fn passes(&self) -> Vec<u32> {
        let moves = self.receivers.moves();
        passes(if moves { MOVING } else { STAYING }, moves)
    }

    /// Where errors are taken, and against what, to this relMSE, after these numbers of passes.
    pub(super) fn ground<'s>(&'s self, passes: &'s [u32], own_rel_mse: f64) -> Ground<'s> {
        let session = self.cases.session;
        Ground {
            passes,
            pixels: session.pixels(PIXELS),
            own_rel_mse,
            reference_work_s: f64::INFINITY,
            cache: &session.options.cache,
        }
    }
}
