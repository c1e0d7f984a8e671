//! The scene of a file, whatever its format.

#[cfg(feature = "gltf")]
use super::gltf;
use super::overrides::Overrides;
#[cfg(feature = "recipe")]
use super::recipe;
#[cfg(not(all(feature = "gltf", feature = "recipe")))]
use crate::base::error::Error;
use crate::base::error::Result;
use crate::scene::Scene;
use std::path::Path;

/// The scene of a file: glTF if its name ends in `.glb` or `.gltf`, a recipe otherwise.
///
/// # Errors
/// A file that cannot be read, or with a mistake, with its field and the line where it is known; an override that does
/// not fit the file; a format that this program was built without.
pub fn open(path: &Path, overrides: &Overrides) -> Result<Scene> {
    let is_gltf = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("glb") || e.eq_ignore_ascii_case("gltf"));
    if is_gltf {
        #[cfg(feature = "gltf")]
        return gltf::load(path, overrides);
    } else {
        #[cfg(feature = "recipe")]
        return recipe::load(path, overrides);
    }
    #[cfg(not(all(feature = "gltf", feature = "recipe")))]
    Err(Error::Invalid(format!("{}: this program was built without the reader of such files", path.display())))
}
