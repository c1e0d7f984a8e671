//! How were the parameters of a comparison's strategies chosen?

use super::check::{Fault, wrong};
use super::files::file_name;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;

/// How the parameters of strategies were chosen that may be tried at several.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Parameters {
    /// They are the defaults, or what somebody named.
    AsNamed,
    /// They were found by tuning, for each recipe by itself; those that are still to be tuned for are missing.
    Tuned(Vec<TunedFamily>),
}

/// What was tuned for one recipe.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TunedFamily {
    /// The scene, or the scene that others are replicates of.
    pub family: String,
    /// The file in the result folder that holds what was found.
    pub file: String,
    /// How many cities it was found on: none that is reported.
    pub cities: u32,
}

impl Parameters {
    /// What was tuned, recipe by recipe.
    pub(crate) fn tuned(&self) -> &[TunedFamily] {
        match self {
            Self::AsNamed => &[],
            Self::Tuned(families) => families,
        }
    }

    /// Looks for what cannot be: names of files are those that this program gives.
    pub(super) fn check(&self) -> Result<(), Fault> {
        let (mut names, mut files) = (HashSet::new(), HashSet::new());
        for (at, TunedFamily { family, file, .. }) in self.tuned().iter().enumerate() {
            let place = format!("parameters.tuned[{at}]");
            if !names.insert(family) {
                return Err(wrong(&place, "family", format!("`{family}` is an earlier one's, too")));
            }
            if file_name(file) != *file || !file.ends_with(".json") || !files.insert(file) {
                return Err(wrong(
                    &place,
                    "file",
                    format!("`{file}` is no name of a file of its own; `tuned.json` is"),
                ));
            }
        }
        Ok(())
    }
}
