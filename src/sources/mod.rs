//! Where do scenes come from?
//!
//! | source | where |
//! |---|---|
//! | a file, whatever its format | [`open`] |
//! | a recipe in TOML | [`recipe`] |
//! | a generated night city | [`city`] |
//! | glTF 2.0 | [`gltf`] |
//! | a few lights over a ground, for checks and tests | [`small`] |

pub mod city;
#[cfg(any(feature = "recipe", feature = "gltf"))]
mod file;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(any(feature = "recipe", feature = "gltf"))]
mod limits;
#[cfg(any(feature = "recipe", feature = "gltf"))]
mod name;
#[cfg(any(feature = "recipe", feature = "gltf"))]
mod overrides;
#[cfg(feature = "recipe")]
pub mod recipe;
pub mod small;

#[cfg(any(feature = "recipe", feature = "gltf"))]
pub use {file::open, overrides::Overrides};
