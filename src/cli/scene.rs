//! Options that say which scene, and how it is prepared.

use super::say;
use crate::base::colour;
use crate::base::error::Error;
use crate::base::names;
use crate::image::Format;
use crate::scene::Scene;
use crate::scene::file::{self, Overrides};
use crate::scene::light_sampling::LightSampling;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use clap::Args;
use std::path::Path;

/// Options of every verb that takes a scene.
#[derive(Args)]
pub(super) struct SceneOptions {
    /// Seed of the city, instead of the recipe's; a glTF file has none
    #[arg(long, value_name = "N")]
    scene_seed: Option<u64>,
    /// Pixels across and down, instead of the file's
    #[arg(long, value_name = "WxH", value_parser = resolution)]
    resolution: Option<(u32, u32)>,
    /// The camera of a glTF file, by the name of its node or its own; the first by default
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Exposure value at ISO 100, instead of the file's
    #[arg(long, value_name = "X", value_parser = finite, allow_negative_numbers = true, conflicts_with = "exposure")]
    ev100: Option<f32>,
    /// Factor from radiance to displayed value, instead of an exposure value
    #[arg(long, value_name = "X", value_parser = positive)]
    exposure: Option<f32>,
    /// How shadow rays keep off their own surfaces
    #[arg(long, value_name = "POLICY", default_value = "scaled", value_parser = offset)]
    offset: Offset,
    /// How the point on a triangle light is drawn: area, solid-angle, projected, auto; references always take area
    #[arg(long, value_name = "WAY", default_value = "auto", value_parser = light_sampling)]
    light_sampling: LightSampling,
    /// Leave out what the scene provably does not need
    #[arg(long, value_name = "on|off", default_value = "on", value_parser = leave_out)]
    leave_out: LeaveOut,
}

impl SceneOptions {
    /// Loads a scene.
    pub(super) fn load(&self, path: &Path) -> Result<Scene, Error> {
        let ev100 = self.exposure.map(colour::ev100).or(self.ev100);
        let scene = file::open(
            path,
            &Overrides {
                seed: self.scene_seed,
                resolution: self.resolution,
                ev100,
                lights: None,
                camera: self.camera.clone(),
            },
        )?;
        for note in scene.notes() {
            say(&format!("{}: {note}", scene.name()));
        }
        Ok(scene)
    }

    /// The file and these options as one would type them.
    pub(super) fn typed(&self, file: &Path) -> String {
        let quoted =
            |text: &str| if text.contains(char::is_whitespace) { format!("'{text}'") } else { text.to_owned() };
        let mut typed = quoted(&file.display().to_string());
        let mut add = |option: &str, value: Option<String>| {
            typed.extend(value.map(|value| format!(" --{option} {}", quoted(&value))));
        };
        add("scene-seed", self.scene_seed.map(|seed| seed.to_string()));
        add("resolution", self.resolution.map(|(width, height)| format!("{width}x{height}")));
        add("camera", self.camera.clone());
        add("ev100", self.ev100.map(|ev100| ev100.to_string()));
        add("exposure", self.exposure.map(|exposure| exposure.to_string()));
        let offset =
            Offset::NAMED.iter().find(|(_, offset)| *offset == self.offset).filter(|_| self.offset != Offset::SCALED);
        add("offset", offset.map(|(name, _)| (*name).to_owned()));
        let sampling = Some(self.light_sampling).filter(|by| *by != LightSampling::default());
        add("light-sampling", sampling.map(|by| by.name().to_owned()));
        add("leave-out", (self.leave_out == LeaveOut::No).then(|| "off".to_owned()));
        typed
    }

    /// The options that decide an image beside the scene itself.
    pub(super) fn describe(&self) -> String {
        format!("{:?}, light sampling {}, leave out {:?}", self.offset, self.light_sampling.name(), self.leave_out)
    }

    /// How shadow rays keep off their own surfaces.
    pub(super) fn offset(&self) -> Offset {
        self.offset
    }

    /// How the point on a triangle light is drawn.
    pub(super) fn light_sampling(&self) -> LightSampling {
        self.light_sampling
    }

    /// Loads a scene and makes it ready.
    pub(super) fn stage(&self, file: &Path) -> Result<Stage, Error> {
        Ok(self.prepare(self.load(file)?))
    }

    /// Makes a loaded scene ready.
    pub(super) fn prepare(&self, scene: Scene) -> Stage {
        let stage = Stage::new(scene, self.leave_out, self.offset).with_light_sampling(self.light_sampling);
        if stage.receivers().is_empty() {
            say(&format!("{}: the camera sees no surface: nothing but sky and emitters", stage.scene().name()));
        }
        stage
    }
}

/// Refuses a picture that could not be written, before the work instead of after it.
pub(super) fn check_output(file: &Path) -> Result<(), Error> {
    Format::of(file)?;
    check_folder(file)
}

/// Refuses a file that could not be written, before the work instead of after it.
pub(super) fn check_folder(file: &Path) -> Result<(), Error> {
    if file.is_dir() {
        return Err(Error::Invalid(format!("cannot write {}: it is a folder", file.display())));
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(Error::Invalid(format!(
            "cannot write {}: there is no folder {}",
            file.display(),
            folder.display()
        )));
    }
    let probe = folder.join(format!(".citylights-{}", std::process::id()));
    std::fs::write(&probe, b"").and_then(|()| std::fs::remove_file(&probe)).map_err(Error::io("write", file))
}

/// A pool of `threads` threads; all cores where none is given.
pub(super) fn pool(threads: Option<u32>) -> anyhow::Result<rayon::ThreadPool> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0) as usize).build()?)
}

/// Parses a number of threads.
pub(super) fn threads(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| (1..=1024).contains(n)).ok_or_else(|| "a whole number from 1 to 1024 is right".into())
}

/// Parses pixels across and down.
pub(super) fn resolution(text: &str) -> Result<(u32, u32), String> {
    let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    parsed
        .filter(|&(w, h): &(u32, u32)| w > 0 && h > 0)
        .ok_or_else(|| "two whole numbers of 1 or more are right, as 240x135".into())
}

/// Parses an exposure value.
pub(super) fn finite(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|x: &f32| x.is_finite() && x.abs() <= 60.0)
        .ok_or_else(|| "a number from -60 to 60 is right".into())
}

/// Parses a factor.
pub(super) fn positive(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|x: &f32| x.is_normal() && *x > 0.0).ok_or_else(|| "a number above 0 is right".into())
}

fn offset(text: &str) -> Result<Offset, String> {
    let known = Offset::NAMED.map(|(name, _)| name);
    Offset::named(text).ok_or_else(|| {
        format!("one of {} is right; near it: {}", known.join(", "), names::near(text, known).join(", "))
    })
}

fn light_sampling(text: &str) -> Result<LightSampling, String> {
    let known = LightSampling::NAMED.map(|(name, _)| name);
    LightSampling::named(text).ok_or_else(|| {
        format!("one of {} is right; near it: {}", known.join(", "), names::near(text, known).join(", "))
    })
}

fn leave_out(text: &str) -> Result<LeaveOut, String> {
    match text {
        "on" => Ok(LeaveOut::Yes),
        "off" => Ok(LeaveOut::No),
        _ => Err("on or off is right".into()),
    }
}
