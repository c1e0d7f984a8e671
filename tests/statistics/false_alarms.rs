//! How often do the gate and `verify` refuse a right strategy, and what does it cost? Re-runnable; minutes long, so ignored:
//!
//! `cargo test --release --lib false_alarms -- --ignored --nocapture`

#![cfg(all(feature = "measure", feature = "recipe"))]

use super::awkward::{self, failures};
use citylights::base::statistics::sidak;
use citylights::measure::gate::Gate;
use citylights::scene::Scene;
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use citylights::strategy::{Claim, Registry};
use citylights::verify::metamorphic::CHANCES;
use citylights::verify::{BY_CHANCE, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use cpu_time::ProcessTime;
use std::path::Path;

/// Comparisons, and runs of `verify`, with seeds of their own.
const COMPARISONS: u64 = 100;

/// How many of them may refuse a right strategy.
const MOST: usize = 3;

#[test]
#[ignore = "minutes: a measurement"]
fn right_strategies_pass_the_gate_of_a_hundred_comparisons() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
    let overrides = Overrides { resolution: Some((64, 36)), ..Overrides::default() };
    let stage = Stage::new(load(&file, &overrides).expect("a shipped scene"), LeaveOut::Yes, Offset::SCALED);
    let names: Vec<&str> = Registry::standard().infos().map(|info| info.name).collect();
    let strategies: Vec<_> = names.iter().map(|name| Registry::standard().parse(name).expect(name)).collect();
    let (clock, mut alarms) = (ProcessTime::now(), Vec::new());
    for seed in 1..=COMPARISONS {
        let gate = Gate::new(&stage, "scenes/first-night.toml --resolution 64x36", strategies.len(), seed);
        for strategy in strategies.iter().filter(|strategy| strategy.info().claim != Claim::Oracle) {
            if let Err(error) = gate.pass(strategy) {
                println!("seed {seed}, {}: {error}", strategy.name());
                alarms.push(seed);
            }
        }
    }
    let seconds = clock.elapsed().as_secs_f64() / COMPARISONS as f64;
    alarms.dedup();
    println!("{} of {COMPARISONS} comparisons refused a right strategy; {seconds:.2} CPU s a gate", alarms.len());
    assert!(alarms.len() <= MOST, "seeds {alarms:?}");
}

/// The scenes that are verified: the first, hard ones as files and made here. The largest, of a million lights, takes as long as all
/// others: `citylights verify scenes/extreme/one-in-a-million.toml` looks at it.
fn scenes() -> Vec<Scene> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let extreme =
        std::fs::read_dir(folder.join("extreme")).expect("a folder").map(|entry| entry.expect("a file").path());
    let mut files: Vec<_> = extreme.filter(|file| !file.ends_with("one-in-a-million.toml")).collect();
    files.sort();
    files.push(folder.join("first-night.toml"));
    let loaded = files.iter().map(|file| load(file, &Overrides::default()).expect("a shipped scene"));
    loaded.chain(awkward::all().into_iter().map(|parts| Scene::new(parts).expect("a scene"))).collect()
}

#[test]
#[ignore = "minutes: a measurement"]
fn right_strategies_pass_a_hundred_runs_of_verify() {
    let (clock, scenes, mut alarms) = (ProcessTime::now(), scenes(), 0);
    let chances = (BY_CHANCE.len() + CHANCES) * Registry::standard().infos().count();
    for run in 0..COMPARISONS {
        let scene = &scenes[run as usize % scenes.len()];
        let level = sidak(0.01, chances).sqrt();
        let found =
            failures(scene, VerifyOptions { receivers: 16, seed: 1_000 + run, level, ..VerifyOptions::default() });
        found.iter().for_each(|line| println!("{line}"));
        alarms += usize::from(!found.is_empty());
    }
    let seconds = clock.elapsed().as_secs_f64() / COMPARISONS as f64;
    println!(
        "{alarms} of {COMPARISONS} runs accused a right strategy, on {} scenes; {seconds:.1} CPU s a run",
        scenes.len()
    );
    assert!(alarms <= MOST);
}
