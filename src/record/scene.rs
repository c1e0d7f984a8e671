//! What is known of a scene: its size, what was measured on it, and against which reference.

use super::number;
use super::summary::Summary;
use serde::{Deserialize, Serialize};

/// The image that errors are taken against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceRecord {
    /// "exact sum" or "stratified".
    pub kind: String,
    /// Its own relMSE; 0 for an exact sum.
    #[serde(with = "number")]
    pub rel_mse: f64,
    /// Standard error of its mean luminance as a share of it; 0 for an exact sum.
    #[serde(with = "number", default)]
    pub energy_error: f64,
    /// Shadow rays it took.
    pub rays: u64,
    /// CPU seconds it took.
    #[serde(with = "number")]
    pub cpu_s: f64,
    /// Whether it came from the cache.
    pub cached: bool,
    /// Whether it covers a stratified subset of the receivers, `pixels_measured` of them, rather than all.
    pub subset: bool,
}

/// Work that all strategies of a scene share, off their clocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SharedWork {
    /// What was done: "occluders".
    pub what: String,
    /// Wall seconds that it took, on all threads of the run.
    #[serde(with = "number")]
    pub wall_s: f64,
}

/// One scene and all strategies on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneRecord {
    /// Its name; rows refer to it.
    pub name: String,
    /// The recipe or glTF file.
    pub file: String,
    /// Hash of its content.
    pub hash: String,
    /// Seed of its generator.
    pub seed: u64,
    /// The name of the scene that it is a replicate of, one city or view of several; none of a scene by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
    /// The view that the generator placed; none of the file's own camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// Which points the passes visited, "spread" or "bounce", where they were others than what pixels see through their
    /// centres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visits: Option<String>,
    /// How many lights.
    pub lights: u64,
    /// Columns of the image.
    pub width: u32,
    /// Rows of the image.
    pub height: u32,
    /// Pixels that errors are taken over.
    pub pixels_measured: u64,
    /// Pixels that see a surface which receives light.
    pub receivers: u64,
    /// Share of pixels that see the sky.
    #[serde(with = "number")]
    pub sky_share: f64,
    /// Share of pixels that see an emitter.
    #[serde(with = "number")]
    pub emitter_share: f64,
    /// The epsilon of relMSE for red, green and blue, in the square of the image's unit.
    #[serde(with = "number::channels")]
    pub rel_mse_epsilon: [f64; 3],
    /// What errors are taken against.
    pub reference: ReferenceRecord,
    /// What was done once for all strategies.
    pub shared: Vec<SharedWork>,
    /// The relMSE that [`Summary::seconds_to`] is read at, greatest first.
    #[serde(with = "number::list")]
    pub errors: Vec<f64>,
    /// The CPU seconds that [`Summary::error_at`] is read at, least first.
    #[serde(with = "number::list")]
    pub times_s: Vec<f64>,
    /// Which of [`errors`](Self::errors) ranks the rows: by the CPU seconds to it.
    pub ranked_by: u32,
    /// What a reader must know: a default exposure, lights left out.
    pub notes: Vec<String>,
    /// One per strategy, in any order.
    pub summaries: Vec<Summary>,
}
