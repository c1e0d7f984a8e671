//! Which strategy is best where a reader's scenes are: in other cities, from other views, where receivers move, each at its
//! best?
//!
//! One recipe in cities of several sizes and seeds, seen from a street, a roof and the sky in turn, under every condition of
//! `--receivers`. Every strategy is tuned for a condition and size on cities of other seeds, in counted work, and then
//! measured on the cities that are reported: at what was found, and at its defaults. All have about the same time, set-up
//! and every arrival in.
//!
//! | question | where |
//! |---|---|
//! | which condition, size, city and view is a case? | `case` |
//! | which parameters are best, and what do they lose in cities that they were not found in? | `tuning` |
//! | what does each strategy come to in a case? | `measured` |
//! | what do all cases say together? | `together` |
//! | what stands in the tables? | `tables` |

mod case;
mod measured;
mod tables;
mod together;
mod tuning;

use super::entry::Entry;
use super::session::Session;
use super::sizes::sizes;
use crate::base::claim::Claim;
use crate::base::error::{Error, Result};
use crate::measure::tuning_cities::CITIES;
use crate::record::study::Study;
use crate::strategy::Configured;
use crate::visibility::visits::Receivers;
use case::Cases;

pub(super) const ENTRY: Entry = Entry {
    name: "elsewhere",
    question: "Which strategy is best in other cities, from other views and where receivers move, each at its best?",
    run,
};

/// The recipe.
const SCENE: &str = "scenes/downtown.toml";
/// Fewest and most lights of a city.
const FEWEST: u64 = 1_000;
const MOST: u64 = 100_000;
/// A run's share of the counted seconds and of the runs that are asked for: there are many of them.
const TIME: f64 = 0.1;
const RUNS: u32 = 2;

fn run(session: &Session<'_>) -> Result<Study> {
    let options = session.options;
    let grids = grids(session)?;
    let files = session.scenes(&[SCENE]);
    let [recipe] = &files[..] else {
        return Err(Error::Invalid("study elsewhere takes one recipe: a single --scene is right".into()));
    };
    let sizes = sizes(FEWEST, options.max_lights.min(MOST));
    let (time_s, runs) = (TIME * options.seconds, (options.repeats / RUNS).max(2));
    let cases = Cases { session, recipe, fewest: FEWEST, time_s, runs };
    // Read once before anything is measured: what has no city, or no room for a view, must not cost an hour.
    let views = cases.first(sizes[0])?;
    let mut writer = session.open(&views, tables::all(&cases, &grids))?;
    for (_, receivers) in Receivers::NAMED {
        for &lights in &sizes {
            let size = cases.size(receivers, lights);
            let best = tuning::best(&size, &mut writer, &grids)?;
            if lights == sizes[sizes.len() / 2] {
                tuning::loss(&size, &mut writer, &grids, &best)?;
            }
            for city in 0..CITIES {
                measured::case(&size, city, &mut writer, &grids, &best)?;
            }
        }
    }
    together::summarise(&mut writer, &grids)?;
    session.finish(writer)
}

/// The grid of each strategy: of those that are asked for, or of every registered one that is unbiased.
fn grids(session: &Session<'_>) -> Result<Vec<Vec<Configured>>> {
    let registry = &session.options.registry;
    let own = || {
        let unbiased = registry.infos().filter(|info| info.claim == Claim::Unbiased && info.claim.chooses());
        unbiased.map(|info| info.name).collect::<Vec<_>>().join(",")
    };
    let grids = registry.grids(session.options.strategies.as_deref().unwrap_or(&own()))?;
    let other = grids.iter().map(|grid| &grid[0]).find(|one| one.info().claim != Claim::Unbiased);
    match other {
        None => Ok(grids),
        Some(one) => Err(Error::Invalid(format!(
            "study elsewhere compares unbiased strategies: `{}` is {}",
            one.name(),
            one.info().claim.word()
        ))),
    }
}
