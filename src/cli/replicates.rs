//! Which scenes does a comparison take: each file as it is, or many cities and views of it?

use super::scene::{SceneOptions, view};
use crate::base::error::{Error, Result};
use crate::measure::reference::scene_hash;
use crate::record::store::file_name;
use crate::scene::Scene;
use crate::sources::city::View;
use clap::Args;
use std::path::{Path, PathBuf};

/// Most cities of a recipe.
const MOST_CITIES: i64 = 1000;

/// Options that make replicates of a recipe.
#[derive(Args)]
pub(super) struct ReplicateOptions {
    /// Cities of each recipe: its seed, or --scene-seed, and those after it. What they say together stands in a table of its own
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_CITIES))]
    cities: Option<u32>,
    /// Views of each city, placed by its generator in place of the recipe's camera: street,roof,sky
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = view, conflicts_with = "view")]
    views: Vec<View>,
}

impl ReplicateOptions {
    /// Whether any are asked for.
    pub(super) fn are_wanted(&self) -> bool {
        self.cities.is_some() || !self.views.is_empty()
    }

    /// What they are, to name a folder with: `downtown-2-cities-street-roof`.
    pub(super) fn folder_name(&self, entries: &[Entry]) -> String {
        let mut families: Vec<&str> = entries.iter().map(Entry::group).collect();
        families.dedup();
        let cities = self.cities.map(|cities| format!("-{cities}-cities"));
        let views = self.views.iter().map(|view| format!("-{}", view.name()));
        families.join("+") + &cities.into_iter().chain(views).collect::<String>()
    }

    /// Every scene that is asked for, each read once, so that a mistake in the last is told before anything is measured.
    ///
    /// # Errors
    /// A scene that cannot be read; two that could not be told apart; cities of what generates none.
    pub(super) fn entries(&self, files: &[PathBuf], options: &SceneOptions) -> Result<Vec<Entry>> {
        if let Some((_, twice)) = self.views.iter().enumerate().find(|(i, view)| self.views[..*i].contains(view)) {
            return Err(Error::Invalid(format!("the view `{}` is named twice", twice.name())));
        }
        let mut entries: Vec<Entry> = Vec::new();
        for file in files {
            let of_file = entries.len();
            self.add(file, options, &mut entries)?;
            let same =
                |(i, entry): (usize, &Entry)| entries[of_file..][..i].iter().any(|other| other.hash == entry.hash);
            // Of one city alone another says whether a seed changes anything.
            let lone =
                if self.cities == Some(1) { Some(self.another(file, options, &entries[of_file])?) } else { None };
            if lone == Some(false) || entries[of_file..].iter().enumerate().any(same) {
                let text = "has no generated city: a seed changes nothing; --cities is for recipes with a table [city]";
                return Err(Error::Invalid(format!("{} {text}", file.display())));
            }
        }
        let names: Vec<String> = entries.iter().map(|entry| file_name(&entry.name)).collect();
        match names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
            Some((_, twice)) => {
                Err(Error::Invalid(format!("two scenes are named `{twice}`; rows could not be told apart")))
            }
            None => Ok(entries),
        }
    }

    /// Whether a file makes another city of another seed.
    fn another(&self, file: &Path, options: &SceneOptions, of: &Entry) -> Result<bool> {
        let seed = of.options.seed().map_or(1, |seed| seed ^ 1);
        Ok(scene_hash(&options.of_replicate(Some(seed), of.options.view()).open(file)?) != of.hash)
    }

    /// The cities and views of one file.
    fn add(&self, file: &Path, options: &SceneOptions, entries: &mut Vec<Entry>) -> Result<()> {
        let views = || self.views.iter().copied().map(Some).chain(self.views.is_empty().then_some(None));
        // What the file says, where no seed is given.
        let mut first = None;
        for city in 0..self.cities.unwrap_or(1) {
            let beyond = || Error::Invalid(format!("the seeds of so many cities go beyond {}", u64::MAX));
            let seed = first.map(|first: u64| first.checked_add(city.into()).ok_or_else(beyond)).transpose()?;
            for view in views() {
                let scene = options.of_replicate(seed, view).load(file)?;
                let own = self.cities.map(|_| scene.seed());
                first = first.or(own);
                let parts = [own.map(|seed| seed.to_string()), view.map(|view| view.name().to_owned())];
                let varied = parts.into_iter().flatten().map(|part| format!(" {part}"));
                entries.push(Entry {
                    file: file.to_owned(),
                    options: options.of_replicate(own, view),
                    name: format!("{}{}", scene.name(), varied.collect::<String>()),
                    family: self.are_wanted().then(|| scene.name().to_owned()),
                    hash: scene_hash(&scene),
                    seed: scene.seed(),
                    lights: scene.lights().len() as u64,
                    // The one that is measured first need not be read again.
                    scene: Some(scene).filter(|_| entries.is_empty()),
                });
            }
        }
        Ok(())
    }
}

/// A scene of a comparison, known by its content and read again when its turn has come: a hundred cities at once would
/// not fit into memory.
pub(super) struct Entry {
    /// Where it comes from.
    pub(super) file: PathBuf,
    /// How it is prepared, city and view included.
    pub(super) options: SceneOptions,
    /// Its name, which no other bears: `downtown 18 roof`.
    pub(super) name: String,
    /// The name of the scene that it is a replicate of, where several were asked for.
    pub(super) family: Option<String>,
    /// The hash of its content.
    pub(super) hash: String,
    /// Seed of its generator.
    pub(super) seed: u64,
    /// How many lights.
    pub(super) lights: u64,
    /// The scene itself, where it was kept.
    scene: Option<Scene>,
}

impl Entry {
    /// The name of its family, or its own where it is by itself.
    pub(super) fn group(&self) -> &str {
        self.family.as_deref().unwrap_or(&self.name)
    }

    /// The scene, under its own name.
    ///
    /// # Errors
    /// A file that cannot be read any more, or that has changed since.
    pub(super) fn take(&mut self) -> Result<Scene> {
        let scene = self.scene.take().map_or_else(|| self.options.open(&self.file), Ok)?;
        if scene_hash(&scene) != self.hash {
            return Err(Error::Invalid(format!("{} has changed since it was read", self.file.display())));
        }
        Ok(scene.named(self.name.clone()))
    }
}
