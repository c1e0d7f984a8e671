//! Which of the formats makes the files that a target asks for?

use super::files::Export;
use super::renderer::Renderer;
use super::{gltf, mitsuba, pbrt};
use crate::base::error::Result;
use crate::scene::Scene;
use std::path::Path;

/// The scene as files of `target`, the main one at `file`; the same scene and name give the same bytes.
///
/// # Errors
/// A name that `target` does not use or cannot hold; for glTF, a light beyond 2^127 or a `.glb` beyond 4 GiB.
pub(crate) fn export(scene: &Scene, target: Renderer, file: &Path) -> Result<Export> {
    target.check(file)?;
    match target {
        Renderer::Gltf => gltf::export(scene, file),
        Renderer::Pbrt => Ok(pbrt::export(scene, file)),
        Renderer::Mitsuba => mitsuba::export(scene, file),
    }
}
