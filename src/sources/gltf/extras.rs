//! What do our own exports say where glTF has no word?
//!
//! `extras` belong to whoever wrote the file: what has another form than ours is someone else's and passed over.

use serde::Deserialize;
use serde_json::value::RawValue;

/// Of a scene.
#[derive(Deserialize)]
pub(super) struct SceneExtras {
    /// Exposure value at ISO 100.
    pub(super) ev100: Option<f64>,
}

/// Of a camera.
#[derive(Deserialize)]
pub(super) struct CameraExtras {
    /// Pixels across and down.
    pub(super) resolution: Option<[u32; 2]>,
}

/// Of a material.
#[derive(Deserialize)]
pub(super) struct MaterialExtras {
    /// Whether people walk or drive on it.
    pub(super) street: Option<bool>,
}

/// The extras, if they have our form.
pub(super) fn read<'a, T: Deserialize<'a>>(extras: Option<&'a RawValue>) -> Option<T> {
    serde_json::from_str(extras?.get()).ok()
}
