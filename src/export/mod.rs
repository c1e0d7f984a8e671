//! A scene for other renderers: which of them, in which files, and what they cannot say.
//!
//! Each export renders there with the same absolute radiance and no hand edit: intensities, irradiances and radiances
//! are carried with factor 1, the camera with its pixel grid, the film without any curve. Coordinates are those of the
//! scene, relative to its origin.

mod cone;
mod gltf;
mod meshes;
mod mitsuba;
mod pbrt;
mod serialized;
mod text;

use crate::base::error::{Error, Result};
use crate::base::file::write_together;
use crate::base::names;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// Samples a pixel that files with a sampler ask for.
const SAMPLES: u32 = 64;

/// What a scene can be exported to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// glTF 2.0: `.glb`, or `.gltf` with its buffer embedded; for Blender and most others.
    Gltf,
    /// pbrt-v4: one `.pbrt` file.
    Pbrt,
    /// Mitsuba 3: an `.xml` file, and beside it a folder of the same name with meshes and the cones of spots.
    Mitsuba,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Gltf, Self::Pbrt, Self::Mitsuba];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gltf => "gltf",
            Self::Pbrt => "pbrt",
            Self::Mitsuba => "mitsuba",
        }
    }

    /// The target of a name; an unknown one is an [`Error::Unknown`].
    pub fn named(text: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|target| target.name() == text).ok_or_else(|| Error::Unknown {
            what: "format",
            name: text.to_owned(),
            near: names::near(text, Self::ALL.map(Self::name)),
        })
    }

    /// The extensions that its files bear.
    const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Gltf => &["glb", "gltf"],
            Self::Pbrt => &["pbrt"],
            Self::Mitsuba => &["xml"],
        }
    }

    /// Refuses a file name whose extension is another format's, before the work instead of after it.
    pub fn check(self, file: &Path) -> Result<()> {
        let extension = file.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if self.extensions().contains(&&*extension) {
            return Ok(());
        }
        let right: Vec<String> = self.extensions().iter().map(|extension| format!(".{extension}")).collect();
        Err(Error::Invalid(format!(
            "`{}` is no name for a {} file: use {}",
            file.display(),
            self.name(),
            right.join(" or ")
        )))
    }
}

/// A scene in the words of another renderer, not yet on disk.
#[derive(Clone, Debug)]
pub struct Export {
    /// Every file with its bytes, the one that names the others last.
    pub files: Vec<(PathBuf, Vec<u8>)>,
    /// What the format cannot say, with figures.
    pub notes: Vec<String>,
}

impl Export {
    /// Writes all files; none that was there is replaced before all are on disk, and the one that names the others is
    /// replaced last.
    pub fn write(&self) -> Result<()> {
        if let Some(folder) = self.files.first().and_then(|(path, _)| path.parent())
            && self.files.len() > 1
        {
            std::fs::create_dir_all(folder).map_err(Error::io("make the folder", folder))?;
        }
        write_together(&self.files)
    }
}

/// The scene as files of `target`, the main one at `file`; the same scene and name give the same bytes.
pub fn export(scene: &Scene, target: Target, file: &Path) -> Result<Export> {
    target.check(file)?;
    match target {
        Target::Gltf => gltf::export(scene, file),
        Target::Pbrt => Ok(pbrt::export(scene, file)),
        Target::Mitsuba => mitsuba::export(scene, file),
    }
}
