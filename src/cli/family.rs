//! Which scenes of a comparison are tuned for together, and on which cities?

use super::replicates::Entry;
use super::scene::SceneOptions;
use crate::base::error::{Error, Result};
use crate::measure::reference::scene_hash;
use crate::measure::tune::seeds;
use crate::record::store::file_name;
use crate::record::tuned::{Condition, TuningCity};
use crate::scene::Scene;
use crate::visibility::visits::Receivers;
use std::fs;
use std::path::{Path, PathBuf};

/// The scenes of one recipe, whatever their cities and views.
pub(super) struct Family {
    /// The recipe's name.
    pub(super) name: String,
    /// The file in a result folder that holds what was found.
    pub(super) tuned_file: String,
    /// What parameters are found for.
    pub(super) condition: Condition,
    /// The cities that are reported.
    pub(super) reported: Vec<TuningCity>,
    file: PathBuf,
    /// How its cities are prepared: once for each view.
    views: Vec<SceneOptions>,
}

/// So many seeds are tried for each city that is wanted: one may have a building where the recipe's camera stands.
const TRIED: usize = 4;

impl Family {
    /// The families of a comparison, in the order of their first scenes.
    ///
    /// # Errors
    /// A recipe that cannot be read any more.
    pub(super) fn all(entries: &[Entry], receivers: Receivers) -> Result<Vec<Self>> {
        let groups: Vec<&[Entry]> = entries.chunk_by(|a, b| a.group() == b.group()).collect();
        let alone = groups.len() == 1;
        groups.into_iter().map(|group| Self::of(group, receivers, alone)).collect()
    }

    fn of(entries: &[Entry], receivers: Receivers, alone: bool) -> Result<Self> {
        let first = &entries[0];
        let mut views: Vec<SceneOptions> = Vec::new();
        for entry in entries {
            if views.iter().all(|known| known.view() != entry.options.view()) {
                views.push(entry.options.of_no_seed());
            }
        }
        let mut hasher = blake3::Hasher::new();
        hasher.update(&fs::read(&first.file).map_err(Error::io("read", &first.file))?);
        views.iter().for_each(|options| _ = hasher.update(options.typed(Path::new("")).as_bytes()));
        let name = first.group().to_owned();
        let condition = Condition {
            recipe: name.clone(),
            hash: hasher.finalize().to_hex()[..32].to_owned(),
            lights: first.lights,
            receivers: receivers.name().to_owned(),
        };
        let tuned_file =
            if alone { "tuned.json".to_owned() } else { format!("{}.json", file_name(&format!("tuned-{name}"))) };
        let reported = entries.iter().map(|entry| TuningCity { seed: entry.seed, hash: entry.hash.clone() }).collect();
        Ok(Self { name, tuned_file, condition, reported, file: first.file.clone(), views })
    }

    /// Refuses what has no other cities; one is read for that.
    ///
    /// # Errors
    /// A glTF file, and a recipe that generates nothing.
    pub(super) fn check(&self) -> Result<()> {
        self.cities(1).map(drop)
    }

    /// So many cities that are not reported, each seen by the next view in turn, with how they are prepared.
    ///
    /// # Errors
    /// What has no other cities, or none that the camera can stand in.
    pub(super) fn cities(&self, count: usize) -> Result<Vec<(Scene, &SceneOptions)>> {
        let refuse = |why: String| {
            let right = "--tune is for recipes with a table [city]: it tunes on cities of other seeds";
            Error::Invalid(format!("{why}; {right}"))
        };
        let mut found: Vec<(Scene, &SceneOptions)> = Vec::new();
        let mut failed = None;
        for seed in seeds(self.reported[0].seed, TRIED * count) {
            if found.len() == count {
                break;
            }
            let options = &self.views[found.len() % self.views.len()];
            match options.of_replicate(Some(seed), None).open(&self.file) {
                Ok(scene) if self.reported.iter().any(|city| city.hash == scene_hash(&scene)) => {
                    let file = self.file.display();
                    return Err(refuse(format!("{file} has no generated city: a seed changes nothing")));
                }
                Ok(scene) if self.reported.iter().any(|city| city.seed == scene.seed()) => {}
                Ok(scene) => found.push((scene, options)),
                Err(error) => failed = Some(error.to_string()),
            }
        }
        match failed {
            Some(why) if found.is_empty() => Err(refuse(why)),
            _ => Ok(found),
        }
    }
}
