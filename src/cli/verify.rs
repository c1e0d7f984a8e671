//! `citylights verify`: does every strategy keep its promises?

use super::home::Home;
use super::outcome::Outcome;
use super::progress::Progress;
use super::scene::{SceneOptions, receivers};
use super::terminal::{print, say};
use super::threads::{pool, threads};
use super::waiting::while_long;
use crate::base::error::{Error, Result};
use crate::base::names;
use crate::base::statistics::sidak;
use crate::measure::gate;
use crate::measure::observer::Observer;
use crate::scene::{Parts, Scene};
use crate::sources::small;
use crate::strategy::Configured;
use crate::verify::metamorphic::{self, Copies, Metamorphic, PIXELS};
use crate::verify::{self, BY_CHANCE, Check, Verifier, VerifyOptions};
use crate::visibility::visits::Receivers;
use clap::Args;
use rayon::prelude::*;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene files, recipes (.toml) or glTF (.glb, .gltf); small generated scenes where none is named
    scenes: Vec<PathBuf>,
    /// The strategies, with parameters if any: uniform,influence-pick:picks=4; all by default
    #[arg(long, short, value_name = "A,B")]
    strategies: Option<String>,
    /// Names all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Take the seed from the clock, and say which it is
    #[arg(long, conflicts_with = "seed")]
    fresh_seed: bool,
    /// Picks to draw at each receiver, about; a failing check is made again with four times as many
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u32).range(100..=100_000_000))]
    draws: u32,
    /// Places of each scene that are looked at
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    places: u32,
    /// The chance that any check fails although all strategies are right
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = level)]
    level: f64,
    /// Look as shortly as `compare` does before it measures, at its whole film, and at the scene alone, unchanged
    #[arg(long, conflicts_with_all = ["draws", "places", "level"])]
    gate: bool,
    /// Show this check alone
    #[arg(long, value_name = "CHECK", value_parser = check)]
    only: Option<&'static str>,
    /// One line a strategy
    #[arg(long, short)]
    quiet: bool,
    /// Threads; all cores by default
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
    /// Which points are sampled: what each pixel sees through its centre; spread or bounce: what a pass of `compare` visits.
    /// Scenes that are changed for a check are always looked at through pixel centres
    #[arg(long, value_name = "centre|spread|bounce", default_value = "centre", value_parser = receivers)]
    receivers: Receivers,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let strategies =
        arguments.strategies.as_deref().map_or_else(|| home.registry.all(), |list| home.registry.parse_list(list))?;
    let progress = Progress::new()?;
    let scenes: Vec<Scene> = if arguments.scenes.is_empty() {
        small::all().into_iter().map(Scene::new).collect::<Result<_>>()?
    } else {
        arguments.scenes.iter().map(|file| arguments.scene_options.load(file)).collect::<Result<_>>()?
    };
    let chances = (BY_CHANCE.len() + metamorphic::CHANCES) * strategies.len() * scenes.len();
    let seed = if arguments.fresh_seed { clock()? } else { arguments.seed };
    let options = if arguments.gate {
        say(&format!("seed {seed}; as `compare` looks before it measures"));
        gate::options(strategies.len(), seed)
    } else {
        say(&format!("seed {seed}; level {} for {chances} checks that go by chance", arguments.level));
        VerifyOptions {
            receivers: arguments.places as usize,
            draws: arguments.draws as usize,
            seed,
            // A check fails only if it fails twice.
            level: sidak(arguments.level, chances).sqrt(),
            ..VerifyOptions::default()
        }
    };
    let (failed, shown) = pool(arguments.threads)?.install(|| -> anyhow::Result<(Vec<String>, usize)> {
        let (mut failed, mut shown) = (Vec::new(), 0);
        for scene in scenes {
            progress.scene(scene.name());
            for found in verify(&scene, arguments, &strategies, options, &progress)? {
                print(&found.text(arguments.quiet))?;
                shown += found.checks.iter().flatten().count();
                failed.extend(found.failures().map(|check| format!("{}: {} {check}\n", scene.name(), found.strategy)));
            }
        }
        Ok((failed, shown))
    })?;
    if let (Some(only), 0) = (arguments.only, shown) {
        return Err(
            Error::Invalid(format!("no check `{only}` was made: it needs other options, or another scene")).into()
        );
    }
    if failed.is_empty() {
        print("every check passed\n")?;
        return Ok(Outcome::Done);
    }
    print(&format!("\n{} failed, seed {}:\n{}", failed.len(), options.seed, failed.concat()))?;
    Ok(Outcome::CheckFailed)
}

/// Verifies the arithmetic and all strategies on a scene.
fn verify(
    scene: &Scene,
    arguments: &Arguments,
    strategies: &[Configured],
    options: VerifyOptions,
    watch: &Progress,
) -> anyhow::Result<Vec<Found>> {
    let (whole, by) = (&arguments.scene_options, arguments.scene_options.light_sampling());
    let parts = scene.parts();
    let camera = if arguments.gate { parts.camera } else { parts.camera.shrunk(PIXELS) };
    let stage = whole.prepare(Scene::new(Parts { camera, ..parts })?, arguments.receivers);
    let verifier = Verifier::new(&stage, options);
    let what = format!("{}: being changed in ways that change no strategy's contract", scene.name());
    let copies = while_long(&what, || (!arguments.gate).then(|| Copies::new(scene, whole.offset(), by)).transpose())?;
    // The changes are many, and each is looked at alone.
    let metamorphic = copies.as_ref().map(|copies| Metamorphic::new(copies, options.fewer()));
    watch.begin("strategies", strategies.len() as u64);
    let found: Vec<Found> = strategies
        .par_iter()
        .map(|strategy| {
            watch.check()?;
            let found = Found::of(strategy, &verifier, metamorphic.as_ref());
            watch.advance(1);
            Ok(found)
        })
        .collect::<Result<_>>()?;
    watch.end();
    let lights = stage.scene().lights().len();
    print(&format!("{}: {lights} lights, {} receivers\n", scene.name(), stage.receivers().len()))?;
    if verifier.dim() > 0 {
        let all = verifier.looked_at();
        let dim = verifier.dim();
        print(&format!("  {dim} of {all} receivers get no more light than rounding may make: no statistics there\n"))?;
    }
    let mut image = gate::arithmetic(&stage, options.seed);
    image.extend(metamorphic.iter().flat_map(Metamorphic::image));
    let image = Found { strategy: "(the image)".into(), checks: Ok(image), biased: false };
    let mut all: Vec<Found> = std::iter::once(image).chain(found).collect();
    if let Some(only) = arguments.only {
        all.iter_mut().filter_map(|found| found.checks.as_mut().ok()).for_each(|checks| {
            checks.retain(|check| check.name == only);
        });
        all.retain(|found| !found.checks.as_ref().is_ok_and(Vec::is_empty));
    }
    Ok(all)
}

/// What was found of a strategy; an error where it cannot serve the scene.
struct Found {
    strategy: String,
    checks: Result<Vec<Check>>,
    biased: bool,
}

impl Found {
    fn of(strategy: &Configured, verifier: &Verifier<'_>, metamorphic: Option<&Metamorphic<'_>>) -> Self {
        let checks = verifier.verify(strategy).and_then(|mut checks| {
            if let Some(metamorphic) = metamorphic {
                checks.extend(metamorphic.verify(strategy)?);
            }
            Ok(checks)
        });
        let biased = strategy.info().claim.bias().is_some();
        Self { strategy: strategy.name().to_owned(), checks, biased }
    }

    fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().flatten().filter(|check| !check.passed)
    }

    fn text(&self, quiet: bool) -> String {
        let name = &self.strategy;
        let checks = match &self.checks {
            Err(error) => return format!("  {name:<24} cannot serve this scene: {error}\n"),
            Ok(checks) => checks,
        };
        if !quiet {
            return checks.iter().map(|check| format!("  {name:<24} {check}\n")).collect();
        }
        // The check that came nearest to its limit, as a share of it; exact ones are at 0.
        let nearness = |check: &&Check| if check.limit > 0.0 { check.statistic / check.limit } else { 0.0 };
        let nearest = checks.iter().max_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        let last = match checks.iter().find(|check| self.biased && check.name == "bias") {
            Some(bias) => bias.detail.clone(),
            None => nearest.map_or_else(String::new, |check| {
                format!("nearest: {} {:.2} of {:.2}", check.name, check.statistic, check.limit)
            }),
        };
        let failures = self.failures().count();
        let verdict = if failures == 0 { "pass".to_owned() } else { format!("FAIL {failures}") };
        format!("  {name:<24} {verdict} of {} checks; {last}\n", checks.len())
    }
}

fn check(text: &str) -> std::result::Result<&'static str, String> {
    let near = || format!("no check has that name{}", names::hint(text, verify::names()));
    verify::names().find(|name| *name == text).ok_or_else(near)
}

fn clock() -> Result<u64> {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since
        .map(|time| time.as_nanos() as u64)
        .map_err(|_| Error::Invalid("the clock stands before 1970; name a --seed".into()))
}

fn level(text: &str) -> std::result::Result<f64, String> {
    text.parse().ok().filter(|p: &f64| *p > 0.0 && *p < 1.0).ok_or_else(|| "a chance between 0 and 1 is right".into())
}
