//! `citylights explain`: each pick of a strategy at a pixel, beside what each light really adds there.

use super::home::Home;
use super::outcome::Outcome;
use super::scene::SceneOptions;
use super::terminal::{print, side_by_side};
use super::threads::{pool, threads};
use super::values::pixel;
use super::waiting::while_long;
use crate::explain::{Explained, Explanation, Fate, Share, explain};
use crate::report::{grouped, short};
use crate::scene::Scene;
use crate::scene::light::{Kind, LightId, Shape};
use crate::shading::contribution::EarlyOut;
use crate::visibility::occluders::Met;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene file: a recipe (.toml) or glTF (.glb, .gltf)
    scene: PathBuf,
    /// The strategy, with parameters if any: `light-tree:picks=4`
    #[arg(long, short)]
    strategy: String,
    /// The pixel, counted from the upper left corner
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pixel: (u32, u32),
    /// Passes whose picks are listed
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=4096))]
    passes: u32,
    /// Lights that are listed with their shares, those that add most first
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    lights: u32,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads; all cores by default
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let strategy = home.registry.parse(&arguments.strategy)?;
    let Arguments { pixel: (x, y), passes, seed, .. } = *arguments;
    pool(arguments.threads)?.install(|| {
        let stage = arguments.scene_options.stage(&arguments.scene)?;
        let what = format!("{}: {} being explained", stage.scene().name(), strategy.name());
        let found = while_long(&what, || explain(&stage, &strategy, [x, y], passes, seed))?;
        let at = &found.at;
        print(&format!(
            "{} at pixel {x},{y}: position {:.3} m, normal {:.3}, albedo {:.3}\nexact luminance {} cd/m^2, mean of these passes {}\n",
            strategy.name(),
            at.position,
            at.normal,
            at.albedo,
            short(found.exact()),
            short(found.mean()),
        ))?;
        print(&picks(stage.scene(), &found))?;
        print(&shares(stage.scene(), &found, arguments.lights as usize))?;
        Ok(Outcome::Done)
    })
}

/// Each pick of each pass.
fn picks(scene: &Scene, found: &Explanation) -> String {
    let mut text = String::new();
    for (number, pass) in found.passes.iter().enumerate() {
        _ = writeln!(text, "\npass {number}{}", if pass.is_empty() { ": no light is picked" } else { "" });
        for pick in pass {
            let Explained { light, weight, point, adds, expected, fate } = pick;
            let point = point.map_or_else(String::new, |point| format!(", point {point:.3}"));
            let told = expected.map_or_else(|| "cannot be told".to_owned(), |count| short(f64::from(count)));
            _ = writeln!(text, "  {}{point}", name(scene, *light));
            let weight = format!("    weight {}; expected picks of it in a pass: {told};", short(f64::from(*weight)));
            text.push_str(&side_by_side(&[weight, became(scene, *adds, *fate)]));
        }
    }
    text
}

fn became(scene: &Scene, adds: f32, fate: Fate) -> String {
    let adds = short(f64::from(adds));
    match fate {
        Fate::Adds => format!("adds {adds} cd/m^2"),
        Fate::Ends(EarlyOut::ZeroIntensity) => "adds nothing: the light sends nothing this way".into(),
        Fate::Ends(EarlyOut::BehindSurface) => "adds nothing: the light is below the receiver's horizon".into(),
        Fate::Ends(EarlyOut::BehindLight) => "adds nothing: the receiver is behind the light".into(),
        Fate::Blocked(by) => {
            let by = match by {
                Some(Met::Surface(surface)) => {
                    let material = scene.surfaces()[surface as usize].material as usize;
                    format!("surface {surface} ({})", scene.materials()[material].name)
                }
                Some(Met::Light(light)) => name(scene, light),
                None => "an occluder".into(),
            };
            format!("occluded by {by}; unoccluded it would add {adds} cd/m^2")
        }
    }
}

/// What each light adds, and how often it is picked.
fn shares(scene: &Scene, found: &Explanation, most: usize) -> String {
    let exact = found.exact();
    let all = found.shares.iter().filter_map(|share| share.expected).map(f64::from).sum::<f64>();
    let mut text = String::from("\nexact share of each light, and how often it is picked\n");
    _ = writeln!(text, "  {:>12} {:>8} {:>12} {:>10}  light", "cd/m^2", "share", "picks a pass", "over share");
    for Share { light, exact: adds, expected } in found.shares.iter().take(most) {
        let share = if exact > 0.0 { adds / exact } else { 0.0 };
        let (count, over) = match expected {
            Some(count) if share > 0.0 && all > 0.0 => {
                (short(f64::from(*count)), short(f64::from(*count) / all / share))
            }
            Some(count) => (short(f64::from(*count)), "–".to_owned()),
            None => ("–".to_owned(), "–".to_owned()),
        };
        let percent = format!("{:.2} %", 100.0 * share);
        let figures = format!("  {:>12} {percent:>8} {count:>12} {over:>10}", short(*adds));
        text.push_str(&side_by_side(&[figures, name(scene, *light)]));
    }
    if let Some(rest) = found.shares.get(most..).filter(|rest| !rest.is_empty()) {
        let sum: f64 = rest.iter().map(|share| share.exact).sum();
        let percent = if exact > 0.0 { 100.0 * sum / exact } else { 0.0 };
        _ = writeln!(text, "  {:>12} {percent:>6.2} %  the other {}", short(sum), grouped(rest.len() as u64));
    }
    text.push_str(
        "  over share: the light's part of the picks over its part of the radiance; 1 is best where lights are drawn one by one\n",
    );
    text
}

/// A light in words: number, kind, the part of the scene that it belongs to, place.
fn name(scene: &Scene, light: LightId) -> String {
    let of = &scene.lights()[light as usize];
    let kind = match of.kind() {
        Kind::Point => "point",
        Kind::Spot => "spot",
        Kind::Directional => "directional",
        Kind::Triangle => "triangle",
    };
    let group = scene.groups().iter().find(|group| group.range.contains(&light));
    let group = group.map_or_else(String::new, |group| format!(", {}", group.name));
    let place = match of.shape() {
        Shape::Point { position, .. } | Shape::Spot { position, .. } => format!(" at {position:.2}"),
        Shape::Triangle { corners: [a, b, c], .. } => format!(" at {:.2}", (a + b + c) / 3.0),
        Shape::Directional { towards, .. } => format!(" from {towards:.2}"),
    };
    format!("light {light} ({kind}{group}){place}")
}
