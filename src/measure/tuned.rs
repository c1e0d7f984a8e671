//! With which parameters does a strategy run, where some were found best for its like?

use super::work::RATES;
use crate::base::error::{Error, Result};
use crate::record::tuned::{Condition, Tuned, TunedStrategy, TuningCity};
use crate::strategy::{Configured, Registry};
use std::path::Path;

/// Cities are of one size up to so many times the lights: where no windows make up a number, each seed has its own.
const SAME_SIZE: f64 = 1.1;

/// What was read from a file, held against the program that is to use it.
#[derive(Debug)]
pub(crate) struct Found<'a> {
    file: &'a Path,
    tuned: &'a Tuned,
}

impl<'a> Found<'a> {
    /// What `file` held, if this program can make use of it.
    ///
    /// # Errors
    /// Work counted at other rates; a strategy that `registry` does not know, or not with these parameters.
    pub(crate) fn new(file: &'a Path, tuned: &'a Tuned, registry: &Registry) -> Result<Self> {
        let found = Self { file, tuned };
        if tuned.rates != RATES {
            let why = format!("is {}, this program counts at rates {RATES}: tune again", tuned.rates);
            return Err(found.wrong("rates", why));
        }
        for (at, strategy) in tuned.strategies.iter().enumerate() {
            for (field, text) in [("default", Some(&strategy.default)), ("best", strategy.best.as_ref())] {
                let Some(text) = text else { continue };
                let field = format!("strategies[{at}].{field}");
                registry.parse(text).map_err(|error| found.wrong(&field, error.to_string()))?;
            }
        }
        Ok(found)
    }

    /// Every strategy as it was found best for a condition, and beside it its default, the first point of its grid, where
    /// these differ: each once. One whose grid is a single point stays as it is.
    ///
    /// # Errors
    /// Another condition than the file's; a city to be reported that it was tuned on; a strategy that was not tuned.
    pub(crate) fn apply(
        &self,
        registry: &Registry,
        grids: &[Vec<Configured>],
        condition: &Condition,
        reported: &[TuningCity],
    ) -> Result<Vec<Configured>> {
        self.is_for(condition)?;
        // Of one condition cities with the same seed are the same, whatever they are seen from.
        let is_reported =
            |city: &TuningCity| reported.iter().any(|other| city.seed == other.seed || city.hash == other.hash);
        if let Some((at, city)) = self.tuned.cities.iter().enumerate().find(|(_, city)| is_reported(city)) {
            let why = format!(
                "the city of seed {} would be reported: never one that it was tuned on; take another --scene-seed",
                city.seed
            );
            return Err(self.wrong(&format!("cities[{at}]"), why));
        }
        let mut all: Vec<Configured> = Vec::new();
        for grid in grids {
            let strategy = &grid[0];
            let best = match self.of(strategy) {
                Some(found) => found.best.as_deref(),
                None if grid.len() == 1 => None,
                None => {
                    let why = format!("says nothing of `{}`: tune it too, or leave it out", strategy.name());
                    return Err(self.wrong("strategies", why));
                }
            };
            for text in best.into_iter().chain([strategy.name()]) {
                let one = registry.parse(text)?;
                if all.iter().all(|known| known.name() != one.name()) {
                    all.push(one);
                }
            }
        }
        Ok(all)
    }

    /// What was found for a strategy, if it was tuned.
    fn of(&self, strategy: &Configured) -> Option<&'a TunedStrategy> {
        self.tuned.strategies.iter().find(|found| found.default == strategy.name())
    }

    fn is_for(&self, wanted: &Condition) -> Result<()> {
        let Condition { recipe, hash, lights, receivers } = &self.tuned.condition;
        let differs = |field: &str, own: &str, wanted: &str| {
            let why = format!("is {own}, this is {wanted}: tune for this, or take the file that was tuned for it");
            Err(self.wrong(&format!("condition.{field}"), why))
        };
        if *recipe != wanted.recipe {
            return differs("recipe", recipe, &wanted.recipe);
        }
        if *hash != wanted.hash {
            let this = format!("{} (another text of the recipe, resolution, view or exposure)", wanted.hash);
            return differs("hash", hash, &this);
        }
        let (least, most) = (wanted.lights.min(*lights), wanted.lights.max(*lights));
        if most as f64 > SAME_SIZE * least as f64 {
            return differs("lights", &lights.to_string(), &wanted.lights.to_string());
        }
        if *receivers != wanted.receivers {
            return differs("receivers", receivers, &wanted.receivers);
        }
        Ok(())
    }

    fn wrong(&self, field: &str, message: String) -> Error {
        Error::Input { file: self.file.to_owned(), line: None, field: field.to_owned(), message }
    }
}
