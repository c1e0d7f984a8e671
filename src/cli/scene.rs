//! Options that say which scene, and how it is prepared.

use super::terminal::say;
use super::values::{exposure, finite, positive, resolution};
use super::waiting::while_long;
use crate::base::colour;
use crate::base::error::Error;
use crate::base::names;
use crate::report::grouped;
use crate::scene::Scene;
use crate::scene::light_sampling::LightSampling;
use crate::sources::city::View;
use crate::sources::{self, Overrides};
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use crate::visibility::visits::Receivers;
use clap::Args;
use std::path::Path;

/// Options of every verb that takes a scene.
#[derive(Args, Clone)]
pub(super) struct SceneOptions {
    /// Seed of the city, instead of the recipe's; a glTF file has none
    #[arg(long, value_name = "N")]
    scene_seed: Option<u64>,
    /// A view that the generator places in a recipe's city, instead of the recipe's camera: street, roof, sky
    #[arg(long, value_name = "NAME", value_parser = view)]
    view: Option<View>,
    /// Pixels across and down, instead of the file's
    #[arg(long, value_name = "WxH", value_parser = resolution)]
    resolution: Option<(u32, u32)>,
    /// The camera of a glTF file, by the name of its node or its own; the first by default
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// What the lamps of a glTF file are divided by: 683 where Blender's exporter wrote them in its default lighting mode
    #[arg(long, value_name = "X", value_parser = positive)]
    lamps_divided_by: Option<f32>,
    /// Exposure value at ISO 100, instead of the file's
    #[arg(long, value_name = "X", value_parser = finite, allow_negative_numbers = true, conflicts_with = "exposure")]
    ev100: Option<f32>,
    /// Factor from radiance to displayed value, instead of an exposure value
    #[arg(long, value_name = "X", value_parser = exposure)]
    exposure: Option<f32>,
    /// How shadow rays keep off their own surfaces: scaled, origin-push, t-min, ulps; none, which is wrong on purpose, shows why
    #[arg(long, value_name = "POLICY", default_value = "scaled", value_parser = offset)]
    offset: Offset,
    /// How the point on a triangle light is drawn: area, solid-angle, projected, auto; references take area, and projected where a light looks large or has a near end
    #[arg(long, value_name = "WAY", default_value = "auto", value_parser = light_sampling)]
    light_sampling: LightSampling,
    /// Leave out what the scene provably does not need
    #[arg(long, value_name = "on|off", default_value = "on", value_parser = leave_out)]
    leave_out: LeaveOut,
}

impl SceneOptions {
    /// Loads a scene, and says what its reader noted.
    pub(super) fn load(&self, path: &Path) -> Result<Scene, Error> {
        let scene = self.open(path)?;
        for note in scene.notes() {
            say(&format!("{}: {note}", scene.name()));
        }
        Ok(scene)
    }

    /// Loads a scene.
    pub(super) fn open(&self, path: &Path) -> Result<Scene, Error> {
        let ev100 = self.exposure.map(colour::ev100).or(self.ev100);
        let overrides = Overrides {
            seed: self.scene_seed,
            resolution: self.resolution,
            ev100,
            lights: None,
            view: self.view,
            camera: self.camera.clone(),
            lamps_divided_by: self.lamps_divided_by,
        };
        while_long(&format!("{}: being read", path.display()), || sources::open(path, &overrides))
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
        add("view", self.view.map(|view| view.name().to_owned()));
        add("resolution", self.resolution.map(|(width, height)| format!("{width}x{height}")));
        add("camera", self.camera.clone());
        add("lamps-divided-by", self.lamps_divided_by.map(|by| by.to_string()));
        add("ev100", self.ev100.map(|ev100| ev100.to_string()));
        add("exposure", self.exposure.map(|exposure| exposure.to_string()));
        let offset = Offset::all().find(|(_, offset)| *offset == self.offset).filter(|_| self.offset != Offset::SCALED);
        add("offset", offset.map(|(name, _)| name.to_owned()));
        let sampling = Some(self.light_sampling).filter(|by| *by != LightSampling::default());
        add("light-sampling", sampling.map(|by| by.name().to_owned()));
        add("leave-out", (self.leave_out == LeaveOut::No).then(|| "off".to_owned()));
        typed
    }

    /// The same options for a city and a view of a recipe, where they are given.
    pub(super) fn of_replicate(&self, seed: Option<u64>, view: Option<View>) -> Self {
        Self { scene_seed: seed.or(self.scene_seed), view: view.or(self.view), ..self.clone() }
    }

    /// The same options for whatever city a recipe's seed says.
    pub(super) fn of_no_seed(&self) -> Self {
        Self { scene_seed: None, ..self.clone() }
    }

    /// The seed that is asked for in place of a recipe's own.
    pub(super) fn seed(&self) -> Option<u64> {
        self.scene_seed
    }

    /// The view that is asked for in place of a recipe's camera.
    pub(super) fn view(&self) -> Option<View> {
        self.view
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
        self.stage_visiting(file, Receivers::Centre)
    }

    /// Loads a scene and makes it ready for passes that visit these receivers.
    pub(super) fn stage_visiting(&self, file: &Path, receivers: Receivers) -> Result<Stage, Error> {
        Ok(self.prepare(self.load(file)?, receivers))
    }

    /// Makes a loaded scene ready for passes that visit these receivers.
    pub(super) fn prepare(&self, scene: Scene, receivers: Receivers) -> Stage {
        let (lights, surfaces) = (grouped(scene.lights().len() as u64), grouped(scene.surfaces().len() as u64));
        let what = format!("{}: being prepared, {lights} lights and {surfaces} triangles", scene.name());
        let stage = while_long(&what, || Stage::visiting(scene, self.leave_out, self.offset, receivers));
        let stage = stage.with_light_sampling(self.light_sampling);
        if stage.receivers().is_empty() {
            say(&format!("{}: the camera sees no surface: nothing but sky and emitters", stage.scene().name()));
        }
        stage
    }
}

/// The receivers that passes visit, by name.
pub(super) fn receivers(text: &str) -> Result<Receivers, String> {
    let known = Receivers::NAMED.map(|(name, _)| name);
    Receivers::named(text).ok_or_else(|| right(text, &known))
}

/// Parses the name of a view.
pub(super) fn view(text: &str) -> Result<View, String> {
    let known = View::ALL.map(View::name);
    View::ALL.into_iter().find(|view| view.name() == text).ok_or_else(|| right(text, &known))
}

fn offset(text: &str) -> Result<Offset, String> {
    let known: Vec<&str> = Offset::all().map(|(name, _)| name).collect();
    Offset::named(text).ok_or_else(|| right(text, &known))
}

fn light_sampling(text: &str) -> Result<LightSampling, String> {
    let known = LightSampling::NAMED.map(|(name, _)| name);
    LightSampling::named(text).ok_or_else(|| right(text, &known))
}

/// What is right in place of `text`.
fn right(text: &str, known: &[&str]) -> String {
    let near = names::near(text, known.iter().copied());
    let near = if near.is_empty() { String::new() } else { format!("; near it: {}", near.join(", ")) };
    format!("one of {} is right{near}", known.join(", "))
}

fn leave_out(text: &str) -> Result<LeaveOut, String> {
    match text {
        "on" => Ok(LeaveOut::Yes),
        "off" => Ok(LeaveOut::No),
        _ => Err("on or off is right".into()),
    }
}
