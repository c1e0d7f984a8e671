//! What can a scene be exported to, and how are the files of each named?

use crate::base::error::{Error, Result};
use std::path::Path;

/// What a scene can be exported to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Renderer {
    /// glTF 2.0: `.glb`, or `.gltf` with its buffer embedded; for Blender and most others.
    Gltf,
    /// pbrt-v4: one `.pbrt` file.
    Pbrt,
    /// Mitsuba 3: an `.xml` file, and beside it a folder of the same name with meshes and the cones of spots.
    Mitsuba,
}

impl Renderer {
    /// All of them.
    pub(crate) const ALL: [Self; 3] = [Self::Gltf, Self::Pbrt, Self::Mitsuba];

    /// The name on the command line.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Gltf => "gltf",
            Self::Pbrt => "pbrt",
            Self::Mitsuba => "mitsuba",
        }
    }

    /// The target of a name.
    ///
    /// # Errors
    /// An unknown name is an [`Error::Unknown`].
    pub(crate) fn named(text: &str) -> Result<Self> {
        let unknown = || Error::unknown("format", text, Self::ALL.map(Self::name));
        Self::ALL.into_iter().find(|target| target.name() == text).ok_or_else(unknown)
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
    ///
    /// # Errors
    /// An extension that is none of this format's, or none at all.
    pub(crate) fn check(self, file: &Path) -> Result<()> {
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
