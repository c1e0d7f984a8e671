//! Promise: in the scenes under `scenes/extreme` every registered strategy stays finite, positive and right.
#![cfg(all(feature = "recipe", feature = "measure"))]

mod common;

use citylights::scene::recipe::{Overrides, load};
use citylights::scene::{Parts, Scene};
use citylights::strategy::registry::{STRATEGIES, parse};
use citylights::verify::{Options, Verifier};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use common::image;
use std::path::Path;

/// Every recipe of the folder but the million, which takes too long to be verified here.
const SCENES: [&str; 7] = [
    "a-thousand-kilometres-away",
    "coincident",
    "coplanar",
    "lamp-at-a-wall",
    "orders-of-magnitude",
    "slivers",
    "straddling",
];
const MILLION: &str = "one-in-a-million";

fn scene(name: &str, pixels: u32) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/extreme").join(format!("{name}.toml"));
    let parts = load(&file, &Overrides::default()).expect("a shipped scene").parts();
    let camera = parts.camera.shrunk(pixels);
    Scene::new(Parts { camera, ..parts }).expect("a scene")
}

/// Renders every strategy's image; says which value is neither 0 nor positive and finite.
fn assert_finite(name: &str, stage: &Stage) {
    assert!(!stage.receivers().is_empty(), "{name}");
    for entry in STRATEGIES {
        let strategy = entry.info().name;
        for (i, rgb) in image(strategy, stage, 2).into_iter().enumerate() {
            let right = rgb.is_finite() && rgb.min_element() >= 0.0;
            assert!(right, "{name}, {strategy}: {rgb} at {:?}", stage.receivers()[i]);
        }
    }
}

#[test]
fn every_recipe_of_the_folder_is_tried() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/extreme");
    let files = std::fs::read_dir(folder).expect("the folder").map(|entry| entry.expect("a file").path());
    let mut found: Vec<String> =
        files.map(|file| file.file_stem().expect("a name").to_string_lossy().into_owned()).collect();
    found.sort();
    let mut wanted: Vec<&str> = SCENES.into_iter().chain([MILLION]).collect();
    wanted.sort_unstable();
    assert_eq!(found, wanted);
}

#[test]
fn every_strategy_is_finite_and_positive_under_every_offset() {
    for name in SCENES {
        for (_, offset) in Offset::NAMED {
            assert_finite(name, &Stage::new(scene(name, 24 * 14), LeaveOut::Yes, offset));
        }
    }
}

#[test]
fn every_strategy_keeps_its_contract_and_the_exact_mean() {
    let mut failed = Vec::new();
    for name in SCENES {
        let stage = Stage::new(scene(name, 64 * 36), LeaveOut::Yes, Offset::SCALED);
        let options = Options { receivers: 8, draws: 5_000, ..Options::default() };
        let verifier = Verifier::new(&stage, options);
        assert!(verifier.truths().iter().any(|truth| truth.total() > 0.0), "{name} is black");
        for entry in STRATEGIES {
            let strategy = parse(entry.info().name).expect("a name of the registry");
            let checks = verifier.verify(&strategy).expect("a sampler");
            failed.extend(checks.iter().filter(|c| !c.passed).map(|c| format!("{name}, {}: {c}", strategy.name())));
        }
    }
    assert!(failed.is_empty(), "seed {}:\n{}", Options::default().seed, failed.join("\n"));
}

#[test]
fn one_light_among_a_million_is_found() {
    let stage = Stage::new(scene(MILLION, 16 * 9), LeaveOut::No, Offset::SCALED);
    assert_eq!(stage.scene().lights().len(), 1_000_001);
    assert_finite(MILLION, &stage);
    let sum = |name: &str, passes| image(name, &stage, passes).iter().map(|rgb| f64::from(rgb.x)).sum::<f64>();
    let truth = sum("all", 1);
    assert!(truth > 0.0);
    // Whoever looks at what a light can add at the point finds the one that adds anything.
    // From the box's walls the bulbs are above the horizon, and the ground hides them: what is picked there is often dark.
    for name in ["intensity", "light-tree"] {
        let found = sum(name, 16) / truth;
        assert!((found - 1.0).abs() < 0.3, "{name}: {found} of the light");
    }
}
