//! `citylights export`: a scene in the words of another renderer.

use super::outcome::Outcome;
use super::output::check_folder;
use super::scene::SceneOptions;
use super::terminal::{print, say};
use crate::export::{Renderer, export};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene: a recipe (.toml) or glTF (.glb, .gltf)
    scene: PathBuf,
    /// The format: gltf (.glb, or .gltf with its buffer embedded), pbrt (.pbrt), mitsuba (.xml and a folder beside it)
    #[arg(long, value_name = "FORMAT", value_parser = target)]
    to: Renderer,
    /// The file; one that is there is replaced
    #[arg(long, short)]
    output: PathBuf,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    arguments.to.check(&arguments.output)?;
    check_folder(&arguments.output)?;
    let scene = arguments.scene_options.load(&arguments.scene)?;
    let export = export(&scene, arguments.to, &arguments.output)?;
    export.write()?;
    for note in &export.notes {
        say(&format!("{}: {note}", scene.name()));
    }
    let bytes: usize = export.files.iter().map(|(_, bytes)| bytes.len()).sum();
    print(&format!(
        "{}: {} lights and {} surfaces, {bytes} bytes\n",
        scene.name(),
        scene.lights().len(),
        scene.surfaces().len()
    ))?;
    Ok(Outcome::Done)
}

fn target(text: &str) -> Result<Renderer, String> {
    Renderer::named(text).map_err(|error| error.to_string())
}
