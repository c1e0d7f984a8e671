//! Promise: a scene file is read as its format says or refused with what is wrong, and a generated city is what was
//! asked for.
//!
//! | file | what it shows |
//! |---|---|
//! | `recipe` | every mistake in a recipe is told with file, line, field and what would be right |
//! | `generator` | equal bytes everywhere, exact counts, the degeneracies and gaps of real cities |
//! | `scenes` | the shipped scenes are what the README and their comments say |
//! | `views` | the views that the generator places see the city, and others than a city's are refused |
//! | `gltf` | every triangle and every light in its place, as bright as the file says |
//! | `gltf_files` | a glTF file goes wherever a scene goes, and what is not used of it is told |
//! | `gltf_bad` | whatever a document says wrong is told with its path |
//! | `gltf_broken` | broken containers, JSON and buffers are refused |
//! | `foreign` | files as others write them open with the right light, and with one note for each thing left out |
//! | `foreign_geometry` | instanced, quantized, sparse and morphed meshes stand where they say |
//! | `foreign_kinds` | twenty-four kinds of files that others write and their light; why four stay refused |
//! | `foreign_textures` | what a texture makes of a surface is what is seen |
//! | `large_gltf` | a hundred thousand lights in seventy thousand materials |
//! | `mutated_inputs` | whatever bytes stand in a file, it is read or refused |
//!
//! Memory is watched for each thread by itself, so that tests that look at it may run beside others.

#[cfg(feature = "cli")]
#[path = "../common/broken.rs"]
mod broken;
#[path = "../common/mod.rs"]
mod common;
#[cfg(feature = "cli")]
mod foreign_made;
#[cfg(feature = "gltf")]
mod made;
#[cfg(feature = "cli")]
mod peak;
#[cfg(feature = "cli")]
mod refused;

mod foreign;
mod foreign_geometry;
mod foreign_kinds;
mod foreign_textures;
mod generator;
mod gltf;
mod gltf_bad;
mod gltf_broken;
mod gltf_files;
mod large_gltf;
mod mutated_inputs;
mod recipe;
mod scenes;
mod views;
