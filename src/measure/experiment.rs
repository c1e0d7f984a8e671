//! All runs of some strategies on one target: which are still to do, and what they gave.
//!
//! A unit is one budget of one run of one strategy, done in one block by the [engine](super::engine). Its row is kept as soon
//! as it exists; of the largest budget the image is kept too, since bias and variance need all images together.

use super::engine::{Account, Block, Done, Engine};
use super::errors::Truth;
use super::observer::Observer;
use super::target::Target;
use crate::base::error::Result;
use crate::base::random::{RunKey, hash};
use crate::record::Row;
use crate::strategy::Configured;
use glam::Vec3;

/// What is run.
pub(crate) struct Experiment<'a> {
    /// Who times it.
    pub engine: &'a Engine<'a>,
    /// The frame, and where errors are taken.
    pub target: &'a Target<'a>,
    /// What they are taken against.
    pub truth: &'a Truth,
    /// The strategies.
    pub strategies: &'a [&'a Configured],
    /// The budgets of each, in passes, ascending; none of one that is not run.
    pub ladders: &'a [Vec<u32>],
    /// Independent runs.
    pub runs: u32,
    /// The user's seed.
    pub seed: u64,
}

/// What a unit gave: a row, and the image at the measured receivers if its budget is the largest.
pub(crate) type Found = (Row, Option<Vec<Vec3>>);

/// Where rows and images are kept, so that an interrupted experiment goes on.
pub(crate) trait Keep {
    /// What is kept of a unit. What is there in part only is thrown away: the unit will be done again.
    ///
    /// # Errors
    /// What is kept that cannot be read, or thrown away.
    fn take(&mut self, strategy: &str, run: u32, passes: u32, with_image: bool) -> Result<Option<Found>>;
    /// Keeps what a unit gave.
    ///
    /// # Errors
    /// What cannot be written.
    fn keep(&mut self, found: &Found) -> Result<()>;
}

/// Keeps nothing.
pub(crate) struct Nowhere;

impl Keep for Nowhere {
    fn take(&mut self, _: &str, _: u32, _: u32, _: bool) -> Result<Option<Found>> {
        Ok(None)
    }

    fn keep(&mut self, _: &Found) -> Result<()> {
        Ok(())
    }
}

/// What the runs of one strategy gave.
#[derive(Clone, Debug, Default)]
pub(crate) struct Runs {
    /// Its rows, by budget and run.
    pub rows: Vec<Row>,
    /// Its images at the largest budget, in the order of runs.
    pub images: Vec<Vec<Vec3>>,
}

impl Runs {
    /// The rows of a budget, in the order of runs.
    pub(crate) fn at(&self, passes: u32) -> Vec<&Row> {
        self.rows.iter().filter(|row| row.passes == passes && row.error.is_none()).collect()
    }
}

/// Names the random numbers of a run at a budget: budgets share none, so that what they say is independent.
pub(crate) fn numbers(seed: u64, run: u32, passes: u32) -> RunKey {
    RunKey { seed: hash(&[seed, u64::from(passes)]), run }
}

/// One (strategy, run, budget).
struct Unit {
    strategy: usize,
    run: u32,
    passes: u32,
}

impl Experiment<'_> {
    /// Does what `kept` does not hold; gives the runs of each strategy, and what the units done now took together.
    ///
    /// # Errors
    /// An error of `kept`; the user's wish to stop; no thread to run on. A strategy that fails has rows that say so.
    pub(crate) fn run(&self, kept: &mut dyn Keep, watch: &dyn Observer) -> Result<(Vec<Runs>, Account)> {
        let mut found: Vec<Vec<Found>> = self.strategies.iter().map(|_| Vec::new()).collect();
        let mut units = Vec::new();
        for (strategy, ladder) in self.ladders.iter().enumerate() {
            for unit in ladder.iter().flat_map(|&passes| (0..self.runs).map(move |run| Unit { strategy, run, passes }))
            {
                match kept.take(self.strategies[strategy].name(), unit.run, unit.passes, self.is_last(&unit))? {
                    Some(one) => found[strategy].push(one),
                    None => units.push(unit),
                }
            }
        }
        let account = self.engine.run(
            "runs",
            &units,
            watch,
            |unit, meter| {
                let block = Block {
                    stage: self.target.stage,
                    receivers: &self.target.frame,
                    strategy: self.strategies[unit.strategy],
                    key: numbers(self.seed, unit.run, unit.passes),
                    passes: unit.passes,
                };
                Ok(self.found(unit, block.run(meter)))
            },
            |unit, one| {
                kept.keep(&one)?;
                found[unit.strategy].push(one);
                Ok(())
            },
        )?;
        Ok((found.into_iter().map(sorted).collect(), account))
    }

    fn is_last(&self, unit: &Unit) -> bool {
        self.ladders[unit.strategy].last() == Some(&unit.passes)
    }

    /// The row and image of a unit. One that could not be built, or gave no number, is a row that says so.
    fn found(&self, unit: &Unit, done: Result<Done>) -> Found {
        let scene = self.target.stage.scene().name();
        let name = self.strategies[unit.strategy].name();
        let failed = |why: String| (Row::failed(scene.to_owned(), name.to_owned(), unit.run, unit.passes, why), None);
        let done = match done {
            Ok(done) => done,
            Err(error) => return failed(error.to_string()),
        };
        let image = self.target.at_places(&done.image);
        if let Some(at) = image.iter().position(|radiance| !radiance.is_finite()) {
            let pixel = self.target.frame[self.target.places[at]].pixel;
            return failed(format!("the radiance at pixel {pixel} is no finite number"));
        }
        let row = self.truth.after(unit.passes).errors(&image).written_to(done.row(scene, name, unit.run, unit.passes));
        (row, self.is_last(unit).then_some(image))
    }
}

fn sorted(mut found: Vec<Found>) -> Runs {
    found.sort_by_key(|(row, _)| (row.passes, row.run));
    let (rows, images): (Vec<Row>, Vec<Option<Vec<Vec3>>>) = found.into_iter().unzip();
    Runs { rows, images: images.into_iter().flatten().collect() }
}
