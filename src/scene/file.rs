//! The scene of a file, whatever its format.

#[cfg(not(all(feature = "gltf", feature = "recipe")))]
use crate::base::error::Error;
use crate::base::error::Result;
use crate::scene::Scene;
#[cfg(feature = "gltf")]
use crate::scene::gltf;
#[cfg(feature = "recipe")]
use crate::scene::recipe;
use std::path::Path;

/// Coordinates lie within this distance of the origin, in m: f32 has a metre there.
pub(super) const FARTHEST: f64 = 1e7;
/// The origin lies within this distance of the world's, in m: f64 has 0.1 mm there.
pub(super) const FARTHEST_ORIGIN: f64 = 1e12;
/// Greatest value of any photometric quantity: above that f32 would overflow on the way to a pixel.
pub(super) const BRIGHTEST: f64 = 1e15;
/// Least outer half-angle of a spot, in degrees: the cosines of its cone are 640 steps of f32.
pub(super) const NARROWEST_CONE: f64 = 0.5;

/// What a caller sets in place of the file's own words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The seed of a recipe's city.
    pub seed: Option<u64>,
    /// Pixels across and down.
    pub resolution: Option<(u32, u32)>,
    /// Exposure value at ISO 100.
    pub ev100: Option<f32>,
    /// Lights of a recipe's generated city, at the recipe's density: its extent grows with them about the same middle.
    pub lights: Option<u64>,
    /// The camera of a glTF file, by the name of its node or its own.
    pub camera: Option<String>,
}

/// The scene of a file: glTF if its name ends in `.glb` or `.gltf`, a recipe otherwise.
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
