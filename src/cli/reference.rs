//! `citylights reference`: the exact image.

use super::folders::CACHE;
use super::outcome::Outcome;
use super::output::{check_output, save};
use super::progress::Progress;
use super::scene::{SceneOptions, receivers};
use super::terminal::{print, say};
use super::threads::{pool, threads};
use super::values::seconds;
use crate::base::error::Error;
use crate::measure::reference::{Reference, WORK_S, Wanted};
use crate::measure::target::Target;
use crate::visibility::visits::Receivers;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene file: a recipe (.toml) or glTF (.glb, .gltf)
    scene: PathBuf,
    /// The picture: .exr linear, or .png through exposure and sRGB
    #[arg(long, short)]
    output: PathBuf,
    /// Refine triangle lights until the image's own relMSE is at most this; other lights are exact
    #[arg(long, value_name = "RELMSE", default_value = "1e-5", value_parser = noise)]
    noise: f64,
    /// Most work, in nominal CPU seconds: 170 ns a shadow ray and 20 ns a light and receiver, whatever the machine
    /// takes. Where that is not enough for every pixel, the image is less exact than asked for
    #[arg(long, value_name = "S", default_value_t = WORK_S, value_parser = seconds)]
    reference_work: f64,
    /// Folder of finished tiles; an interrupted run goes on from there
    #[arg(long, value_name = "DIR", default_value = CACHE)]
    cache: PathBuf,
    /// Threads; all cores by default. The picture does not depend on it
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
    /// Which points the passes visit: what each pixel sees through its centre; spread: in each pass through another point
    /// of it; bounce: what a ray from there meets next, as in a path tracer. Where they move, each is arrived at once
    #[arg(long, value_name = "centre|spread|bounce", default_value = "centre", value_parser = receivers)]
    receivers: Receivers,
    /// Where receivers move: the passes whose receivers' mean it is
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1 << 16))]
    passes: u32,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    check_output(&arguments.output)?;
    let progress = Progress::new()?;
    pool(arguments.threads)?.install(|| {
        let stage = arguments.scene_options.stage_visiting(&arguments.scene, arguments.receivers)?;
        progress.scene(stage.scene().name());
        let visits = stage.receivers().len() as u64 * u64::from(arguments.passes);
        if arguments.receivers.moves() && visits > MOST_VISITS {
            let (pixels, passes) = (stage.receivers().len(), arguments.passes);
            return Err(Error::Invalid(format!(
                "{passes} passes of {pixels} pixels are {visits} receivers; at most 2^24 are held at once: fewer --passes or a \
                 smaller --resolution are right"
            ))
            .into());
        }
        let target = Target::whole(&stage).after([arguments.passes]);
        // A picture needs every pixel.
        let fewest = target.places.len();
        let wanted = Wanted { own_rel_mse: arguments.noise, work_s: arguments.reference_work, fewest };
        let (target, reference) = Reference::bounded(&target, wanted, &arguments.cache, &progress)?;
        for note in reference.notes(&target, wanted) {
            say(&format!("{}: {note}", stage.scene().name()));
        }
        save(&stage, reference.truth.mean(), &arguments.output)?;
        let kind = if reference.exact_sum { "exact sum" } else { "stratified" };
        let cached = if reference.cached { ", from the cache" } else { "" };
        print(&format!(
            "{}: {kind}, own relMSE {:.2e} (epsilon {}), mean luminance to {:.1e}, {} shadow rays, {:.1} CPU s{cached}\n",
            stage.scene().name(),
            reference.truth.own_rel_mse(),
            reference.truth.epsilon(),
            reference.truth.own_energy_error(),
            reference.rays,
            reference.cpu_s,
        ))?;
        Ok(Outcome::Done)
    })
}

/// Most receivers of all passes: 170 bytes are held of each.
const MOST_VISITS: u64 = 1 << 24;

fn noise(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| (1e-12..=1.0).contains(x))
        .ok_or_else(|| "a number from 1e-12 to 1 is right".into())
}
