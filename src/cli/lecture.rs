//! `citylights lecture`: the labelled picture of a chapter.

use super::home::Home;
use super::outcome::Outcome;
use super::output::check_folder;
use super::terminal::{print, say};
use super::threads::{pool, threads};
use super::values::{pixel, resolution};
use super::waiting::while_long;
use crate::base::error::Error;
use crate::base::file::write_whole;
use crate::lecture::{Asked, CHAPTERS, find};
use crate::sources::{self, Overrides};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct Arguments {
    /// The chapter, by name or number; without one they are listed
    chapter: Option<String>,
    /// Another scene than the chapter's own: a recipe (.toml) or glTF (.glb, .gltf)
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// The picture, .svg; lecture/NUMBER-CHAPTER.svg by default
    #[arg(long, short, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Pixels across and down of the pictures in it
    #[arg(long, visible_alias = "size", value_name = "WxH", value_parser = resolution)]
    resolution: Option<(u32, u32)>,
    /// The pixel that points and picks look at, counted from the upper left corner
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pixel: Option<(u32, u32)>,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads; all cores by default. The picture does not depend on it
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
}

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let Some(name) = &arguments.chapter else {
        for chapter in &CHAPTERS {
            print(&format!("{} {}\n    {}\n    {}\n", chapter.number, chapter.name, chapter.question, chapter.scene))?;
        }
        return Ok(Outcome::Done);
    };
    let chapter = find(name)?;
    let output = arguments.output.clone().unwrap_or_else(|| chapter.file().into());
    if !output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        return Err(Error::Invalid(format!("{}: the picture of a chapter is written as .svg", output.display())).into());
    }
    if arguments.output.is_none()
        && let Some(folder) = output.parent()
    {
        fs::create_dir_all(folder).map_err(Error::io("make", folder))?;
    }
    check_folder(&output)?;
    let scene = match &arguments.scene {
        Some(scene) => scene,
        None if Path::new(chapter.scene).is_file() => Path::new(chapter.scene),
        None => {
            let text = format!(
                "there is no {} here: run this in a clone of the repository, or name a scene with --scene",
                chapter.scene
            );
            return Err(Error::Invalid(text).into());
        }
    };
    pool(arguments.threads)?.install(|| {
        let resolution = Some(arguments.resolution.unwrap_or(chapter.resolution));
        let overrides = Overrides { resolution, ..Overrides::default() };
        let what = format!("{}: being read", scene.display());
        let scene = while_long(&what, || sources::open(scene, &overrides))?;
        let pixel = arguments.pixel.map(|(x, y)| [x, y]);
        let asked = Asked { scene, pixel, seed: arguments.seed, registry: home.registry };
        let drawn = while_long(&format!("chapter {}: being drawn", chapter.name), || chapter.svg(&asked))?;
        write_whole(&output, drawn.as_bytes())?;
        say(&format!("{}", output.display()));
        Ok(Outcome::Done)
    })
}
