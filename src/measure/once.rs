//! One independent run of one strategy through its budgets, on this thread's clock.

use super::clock::{Spent, timed};
use super::errors::Truth;
use super::target::Target;
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::record::Row;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::strategy::BuildContext;
use crate::strategy::registry::Configured;
use glam::Vec3;

/// What is run.
#[derive(Clone, Copy)]
pub(super) struct Once<'a> {
    pub(super) target: &'a Target<'a>,
    pub(super) truth: &'a Truth,
    pub(super) strategy: &'a Configured,
    pub(super) key: RunKey,
}

impl Once<'_> {
    /// Builds the strategy and goes through `budgets`, ascending numbers of passes, with a row for each; gives the last
    /// image at the measured receivers.
    ///
    /// A strategy that cannot serve the scene gets one row that says so, and no image. `each` may end the run by
    /// failing.
    pub(super) fn through(
        &self,
        budgets: &[u32],
        mut each: impl FnMut(Row) -> Result<()>,
    ) -> Result<Option<Vec<Vec3>>> {
        let Self { target, truth, strategy, key } = *self;
        let (scene, name) = (target.stage.scene().name().to_owned(), strategy.name().to_owned());
        let context = BuildContext { stage: target.stage, seed: key.stream(u32::MAX, 0).bits() };
        let (built, setup) = timed(|| strategy.build(context));
        let sampler = match built {
            Ok(sampler) => sampler,
            Err(error) => {
                each(Row::failed(scene, name, key.run, 0, error.to_string()))?;
                return Ok(None);
            }
        };
        let plan = Plan { stage: target.stage, receivers: &target.frame, sampler: sampler.as_ref(), key };
        let mut film = Film::new(target.frame.len());
        let mut spent = Spent::default();
        for &passes in budgets {
            let ((), block) = timed(|| plan.run(passes - film.passes(), &mut film));
            spent += block;
            let errors = truth.errors(&target.at_places(&film.image()));
            let row = Row {
                setup_cpu_s: setup.cpu,
                cpu_s: spent.cpu,
                wall_s: spent.wall,
                heap_bytes: sampler.heap_bytes() as u64,
                ..Row::blank(scene.clone(), name.clone(), key.run, passes)
            };
            each(errors.written_to(row))?;
        }
        Ok(Some(target.at_places(&film.image())))
    }
}
