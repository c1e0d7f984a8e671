//! With which parameters does a comparison run its strategies: as named, as they are found best on other cities, or as a
//! file says that an earlier comparison found?

use super::family::Family;
use super::progress::Progress;
use super::replicates::Entry;
use super::scene::SceneOptions;
use super::terminal::say;
use super::values::seconds;
use crate::base::error::{Error, Result};
use crate::measure::tuned::Found;
use crate::measure::tuning_cities::{CITIES, RUNS, Search};
use crate::record::tuned::{self, Tuned};
use crate::record::{Parameters, TunedFamily};
use crate::strategy::{Configured, Registry};
use crate::visibility::stage::Stage;
use crate::visibility::visits::Receivers;
use clap::Args;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Options that say which parameters strategies have.
#[derive(Args)]
pub(super) struct TuneOptions {
    /// Find the best parameters of each strategy first, over the grid that it declares or that braces name, and compare it
    /// with these and with its defaults. For each recipe by itself, on five cities of other seeds, by counted work: the same
    /// on every machine. What is found is kept in the result folder, tuned.json
    #[arg(long, conflicts_with = "tuned")]
    tune: bool,
    /// Time that --tune finds the least error in, in nominal CPU seconds of a run, set-up included. With all strategies it
    /// takes a few thousand times as long
    #[arg(long, value_name = "S", default_value = "0.25", requires = "tune", value_parser = seconds)]
    pub(super) tune_time: f64,
    /// Parameters that --tune found in an earlier comparison: its tuned.json; more than once for more than one recipe
    #[arg(long, value_name = "FILE")]
    tuned: Vec<PathBuf>,
}

impl TuneOptions {
    /// What a list names; all strategies where there is none.
    ///
    /// # Errors
    /// A list that cannot be read; one of which nothing can be tuned.
    pub(super) fn contestants(&self, list: Option<&str>, registry: &Registry) -> Result<Contestants> {
        if !self.tune && self.tuned.is_empty() {
            let strategies = list.map_or_else(|| registry.all(), |list| registry.parse_list(list))?;
            return Ok(Contestants { strategies, grids: Vec::new() });
        }
        let all = || registry.infos().map(|info| info.name).collect::<Vec<_>>().join(",");
        let grids = registry.grids(&list.map_or_else(all, str::to_owned))?;
        if grids.iter().all(|grid| grid.len() == 1) {
            let text = "nothing can be tuned: no strategy of the list may be tried at more than one point; sweep a parameter, \
                        as in `light-tree:arity={2,4,8}`, or name the strategy alone";
            return Err(Error::Invalid(text.into()));
        }
        let strategies = grids.iter().map(|grid| registry.parse(grid[0].name())).collect::<Result<_>>()?;
        Ok(Contestants { strategies, grids })
    }
}

/// The strategies of a comparison before they are tuned.
pub(super) struct Contestants {
    /// At their defaults, or as they are named.
    pub(super) strategies: Vec<Configured>,
    /// The points that each may be tried at; none where nothing is tuned.
    grids: Vec<Vec<Configured>>,
}

/// The strategies of each family, at what was found for it.
pub(super) type ByFamily = HashMap<String, Vec<Configured>>;

/// What is to be tuned, and for which recipes.
pub(super) struct Tuning<'a> {
    options: &'a TuneOptions,
    registry: &'a Registry,
    contestants: &'a Contestants,
    /// None where nothing is tuned.
    families: Vec<Family>,
    /// What files say for each family; none where it is to be found.
    given: Vec<Tuned>,
}

impl<'a> Tuning<'a> {
    /// What `options` ask for, with all mistakes told before anything is measured.
    ///
    /// # Errors
    /// A scene that has no other cities to tune on; a file that does not hold what is wanted.
    pub(super) fn new(
        options: &'a TuneOptions,
        registry: &'a Registry,
        contestants: &'a Contestants,
        scenes: &[Entry],
        receivers: Receivers,
    ) -> Result<Self> {
        let wanted = !contestants.grids.is_empty();
        let families = if wanted { Family::all(scenes, receivers)? } else { Vec::new() };
        let mut tuning = Self { options, registry, contestants, families, given: Vec::new() };
        if options.tune {
            tuning.families.iter().try_for_each(Family::check)?;
        } else if wanted {
            tuning.given = tuning.read()?;
        }
        Ok(tuning)
    }

    /// What the files say, family by family.
    fn read(&self) -> Result<Vec<Tuned>> {
        let read = |file: &'a PathBuf| Ok((file, tuned::read(file)?));
        let files: Vec<(&PathBuf, Tuned)> = self.options.tuned.iter().map(read).collect::<Result<_>>()?;
        let mut given = Vec::new();
        for family in &self.families {
            let own = files.iter().find(|(_, tuned)| tuned.condition.recipe == family.name);
            let (file, tuned) = own.unwrap_or(&files[0]);
            self.apply(file, tuned, family)?;
            given.push(tuned.clone());
        }
        let recipe = |tuned: &Tuned| self.families.iter().any(|family| family.name == tuned.condition.recipe);
        match files.iter().find(|(_, tuned)| !recipe(tuned)) {
            None => Ok(given),
            Some((file, tuned)) => Err(Error::Invalid(format!(
                "{} is for the recipe {}, which is not compared: leave it out",
                file.display(),
                tuned.condition.recipe
            ))),
        }
    }

    fn apply(&self, file: &Path, tuned: &Tuned, family: &Family) -> Result<Vec<Configured>> {
        let found = Found::new(file, tuned, self.registry)?;
        found.apply(self.registry, &self.contestants.grids, &family.condition, &family.reported)
    }

    /// All that decides which parameters are found, for the plan of a comparison; nothing where none are.
    pub(super) fn plan(&self) -> String {
        let of_grid = |grid: &Vec<Configured>| grid.iter().map(Configured::name).collect::<Vec<_>>().join("|");
        let grids = || self.contestants.grids.iter().map(of_grid).collect::<Vec<_>>().join(" ");
        if self.options.tune {
            let TuneOptions { tune_time, .. } = self.options;
            return format!("; tuned for {tune_time} s on {CITIES} cities, {RUNS} runs, over {}", grids());
        }
        let hash = |tuned: &Tuned| {
            let text = serde_json::to_string(tuned).expect("plain fields");
            blake3::hash(text.as_bytes()).to_hex()[..32].to_owned()
        };
        let given: Vec<String> = self.given.iter().map(hash).collect();
        if given.is_empty() { String::new() } else { format!("; tuned as in {} over {}", given.join(" "), grids()) }
    }

    /// How parameters are chosen, as far as is known before anything is tuned; none where there are none to choose among.
    pub(super) fn parameters(&self) -> Option<Parameters> {
        if !self.families.is_empty() {
            return Some(Parameters::Tuned(Vec::new()));
        }
        let has_others = |one: &Configured| self.registry.grid(one.name()).is_ok_and(|grid| grid.len() > 1);
        self.contestants.strategies.iter().any(has_others).then_some(Parameters::AsNamed)
    }

    /// The strategies of each family at what was found, with what is told of that: found now, unless the result folder
    /// holds it since the comparison was interrupted, or files say it.
    ///
    /// # Errors
    /// What cannot be read or written; as [`Search::on`] and [`Found::apply`].
    pub(super) fn settle(
        &self,
        folder: &Path,
        search: &Search<'_>,
        receivers: Receivers,
        progress: &Progress,
    ) -> Result<(ByFamily, Vec<TunedFamily>)> {
        let (mut strategies, mut records) = (HashMap::new(), Vec::new());
        for (at, family) in self.families.iter().enumerate() {
            let file = folder.join(&family.tuned_file);
            if !file.exists() {
                let found = match self.given.get(at) {
                    Some(given) => given.clone(),
                    None => self.find(family, search, receivers, progress)?,
                };
                tuned::write(&file, &found)?;
            }
            let tuned = tuned::read(&file)?;
            strategies.insert(family.name.clone(), self.apply(&file, &tuned, family)?);
            let cities = tuned.cities.len() as u32;
            records.push(TunedFamily { family: family.name.clone(), file: family.tuned_file.clone(), cities });
        }
        Ok((strategies, records))
    }

    fn find(&self, family: &Family, search: &Search<'_>, receivers: Receivers, progress: &Progress) -> Result<Tuned> {
        progress.scene(&format!("{}, tuning", family.name));
        let prepare = |(scene, options): (_, &SceneOptions)| options.prepare(scene, receivers);
        let stages: Vec<Stage> = family.cities(CITIES)?.into_iter().map(prepare).collect();
        let found = search.on(&stages, &self.contestants.grids, family.condition.clone(), progress)?;
        for strategy in &found.strategies {
            let best = strategy.best.as_deref().unwrap_or("none of its points could be measured");
            let gain = strategy.gain.map(|gain| format!(", V {:.2} times the default's", 1.0 / gain.mean));
            say(&format!("{}: `{}`: best at `{best}`{}", family.name, strategy.default, gain.unwrap_or_default()));
        }
        Ok(found)
    }
}
