//! `citylights render`: one picture by one strategy.

use super::home::Home;
use super::outcome::Outcome;
use super::output::{check_output, save};
use super::scene::{SceneOptions, receivers};
use super::terminal::print;
use super::threads::{pool, threads};
use super::values::pixel;
use super::waiting::while_long;
use crate::base::random::RunKey;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::BuildContext;
use crate::visibility::view::Seen;
use crate::visibility::visits::Receivers;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene file: a recipe (.toml) or glTF (.glb, .gltf)
    scene: PathBuf,
    /// The strategy, with parameters if any: influence-pick:picks=4
    #[arg(long, short, default_value = "influence-tail")]
    strategy: String,
    /// Passes: samples a pixel
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    spp: u32,
    /// The picture: .png through exposure and sRGB, .exr linear
    #[arg(long, short, required_unless_present = "pixel")]
    output: Option<PathBuf>,
    /// Print one pixel, from the left and the top, pass by pass, instead of a picture
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pixel: Option<(u32, u32)>,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads; all cores by default. The picture does not depend on it
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
    /// Which points the passes visit: what each pixel sees through its centre; spread: in each pass through another point
    /// of it; bounce: what a ray from there meets next, as in a path tracer. Where they move, each is arrived at once
    #[arg(long, value_name = "centre|spread|bounce", default_value = "centre", value_parser = receivers)]
    receivers: Receivers,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let strategy = home.registry.parse(&arguments.strategy)?;
    if let Some(output) = &arguments.output {
        check_output(output)?;
    }
    pool(arguments.threads)?.install(|| {
        let stage = arguments.scene_options.stage_visiting(&arguments.scene, arguments.receivers)?;
        let name = stage.scene().name();
        let context = BuildContext { stage: &stage, seed: arguments.seed };
        let sampler = while_long(&format!("{name}: {} being built", strategy.name()), || strategy.build(context))?;
        let key = RunKey { seed: arguments.seed, run: 0 };
        let plan = Plan { stage: &stage, receivers: stage.receivers(), sampler: sampler.as_ref(), key };
        if let Some((x, y)) = arguments.pixel {
            return one_pixel(&plan, x, y, arguments.spp);
        }
        let mut film = Film::new(stage.receivers().len());
        let what = format!("{name}: being rendered, {} passes", arguments.spp);
        while_long(&what, || plan.run_parallel(arguments.spp, &mut film));
        if let Some(output) = &arguments.output {
            save(&stage, &film.image(), output)?;
        }
        Ok(Outcome::Done)
    })
}

/// Replays the passes of one pixel.
fn one_pixel(plan: &Plan<'_>, x: u32, y: u32, passes: u32) -> anyhow::Result<Outcome> {
    let seen = plan.stage.view().seen(x, y)?;
    let Seen::Receiver(index) = seen else {
        print(&format!("pixel {x},{y} sees {}\n", if seen == Seen::Sky { "the sky" } else { "an emitter" }))?;
        return Ok(Outcome::Done);
    };
    let at = plan.receivers[index as usize];
    let moves = plan.stage.visits().moves();
    // What looks at the whole frame must see it; whatever else gives this pixel the same alone.
    let (point, index) = (std::slice::from_ref(&at), index as usize);
    let (receivers, index) = if plan.sampler.source().is_some() { (point, 0) } else { (plan.receivers, index) };
    let plan = Plan { receivers, ..*plan };
    let place = |at: &Receiver| format!("position {} m, normal {}, albedo {}", at.position, at.normal, at.albedo);
    if !moves {
        print(&format!("pixel {x},{y}: {}\n", place(&at)))?;
    }
    let mut film = Film::new(receivers.len());
    for pass in 0..passes {
        let mut single = Film::starting_at(receivers.len(), pass);
        plan.run_parallel(1, &mut single);
        plan.run_parallel(1, &mut film);
        let there = plan.stage.visited(&at, pass).filter(|_| moves).map(|at| format!(" at {}", place(&at)));
        let there = if moves { there.unwrap_or_else(|| " meets no surface".into()) } else { String::new() };
        let (own, mean) = (single.image()[index], film.image()[index]);
        print(&format!("pass {pass}{there}: {own} cd/m^2, mean {mean}\n"))?;
    }
    Ok(Outcome::Done)
}
