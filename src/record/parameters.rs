//! How were the parameters of a comparison's strategies chosen?

use serde::{Deserialize, Serialize};

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
}
