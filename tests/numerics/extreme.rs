//! Promise: in the scenes under `scenes/extreme` every registered strategy stays finite, positive and right.
#![cfg(all(feature = "recipe", feature = "measure"))]

use crate::promises::common::image;
use citylights::base::triangle::Seen;
use citylights::render::exact::exact;
use citylights::scene::light::Shape;
use citylights::scene::receiver::Receiver;
use citylights::scene::{Parts, Scene, Surface};
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use citylights::strategy::Registry;
use citylights::verify::{Verifier, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use std::path::Path;
use std::sync::LazyLock;

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
    for info in Registry::standard().infos() {
        let strategy = info.name;
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
        let options = VerifyOptions { receivers: 8, draws: 5_000, ..VerifyOptions::default() };
        let verifier = Verifier::new(&stage, options);
        assert!(verifier.truths().iter().any(|truth| truth.total() > 0.0), "{name} is black");
        for info in Registry::standard().infos() {
            let strategy = Registry::standard().parse(info.name).expect("a name of the registry");
            let checks = verifier.verify(&strategy).expect("a sampler");
            failed.extend(checks.iter().filter(|c| !c.passed).map(|c| format!("{name}, {}: {c}", strategy.name())));
        }
    }
    assert!(failed.is_empty(), "seed {}:\n{}", VerifyOptions::default().seed, failed.join("\n"));
}

/// What a light adds at a receiver with nothing in between, in f64, and what f32 may make of it: its relative error.
///
/// The error is a few times 1e-7 of what the cosine at the receiver, that at the light and a spot's ramp are made from:
/// the less is left of one of these, the more.
fn unshadowed(shape: &Shape, at: &Receiver) -> (DVec3, f64) {
    const ROUNDING: f64 = 5e-7;
    let (position, normal) = (at.position.as_dvec3(), at.normal.as_dvec3());
    let reflected = |strength: Vec3| strength.as_dvec3() * at.albedo.as_dvec3() / PI;
    match *shape {
        Shape::Directional { towards, irradiance } => {
            let cosine = normal.dot(towards.as_dvec3());
            (reflected(irradiance) * cosine.max(0.0), ROUNDING * (1.0 + 1.0 / cosine.abs()))
        }
        Shape::Point { position: from, intensity } => {
            let to_light = from.as_dvec3() - position;
            let distance = to_light.length();
            let cosine = normal.dot(to_light) / distance;
            let error = ROUNDING * (4.0 + 1.0 / cosine.abs());
            (reflected(intensity) * cosine.max(0.0) / (distance * distance), error)
        }
        Shape::Spot { position: from, axis, intensity, cos_inner, cos_outer } => {
            let to_light = from.as_dvec3() - position;
            let distance = to_light.length();
            let cosine = normal.dot(to_light) / distance;
            let (inner, outer) = (f64::from(cos_inner), f64::from(cos_outer));
            let ramp = (-axis.as_dvec3().dot(to_light) / distance - outer) / (inner - outer);
            let lit = ramp.clamp(0.0, 1.0).powi(2);
            let error = ROUNDING * (4.0 + 1.0 / cosine.abs() + 4.0 / ((inner - outer) * ramp.abs().min(1.0)));
            (reflected(intensity) * lit * cosine.max(0.0) / (distance * distance), error)
        }
        Shape::Triangle { corners, radiance } => {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3() - position);
            let front = (b - a).cross(c - a);
            let facing = -front.dot(a);
            let top = [a, b, c].into_iter().map(|corner| normal.dot(corner) / corner.length()).fold(0.0, f64::max);
            let error = ROUNDING * (8.0 + 1.0 / top + front.length() * a.length() / facing.abs());
            if facing <= 0.0 {
                return (DVec3::ZERO, error);
            }
            (reflected(radiance) * Seen::new([a, b, c]).irradiance(normal), error)
        }
    }
}

/// A light alone in the world, but for a surface far above that a scene has to have.
fn alone(shape: Shape, like: &Scene) -> Stage {
    let parts = like.parts();
    let above = parts.surfaces[0].corners[0] + Vec3::Z * 3e4;
    let surface = Surface { corners: [above, above + Vec3::X * 10.0, above + Vec3::Y * 10.0], ..parts.surfaces[0] };
    let (camera, lights) = (parts.camera.shrunk(16), vec![shape]);
    let parts = Parts { camera, lights, surfaces: vec![surface], groups: Vec::new(), ..parts };
    Stage::new(Scene::new(parts).expect("a scene"), LeaveOut::No, Offset::SCALED)
}

#[test]
fn the_truth_is_that_of_f64() {
    /// Points in each half.
    const POINTS: u32 = 1_000;
    const RECEIVERS: usize = 60;
    let (mut failed, mut sharp, mut blunt, mut delta) = (Vec::new(), 0, 0, 0);
    for name in SCENES.into_iter().chain([MILLION]) {
        let own;
        let stage = if name == MILLION {
            &*A_MILLION
        } else {
            own = Stage::new(scene(name, 24 * 14), LeaveOut::Yes, Offset::SCALED);
            &own
        };
        let lights = stage.scene().lights();
        let step = (stage.receivers().len() / RECEIVERS).max(1);
        let mut lit = 0;
        // Of the million, the lamp and a few others.
        for light in lights.iter().step_by((lights.len() / 100).max(1)) {
            let (shape, single) = (light.shape(), alone(light.shape(), stage.scene()));
            for at in stage.receivers().iter().step_by(step) {
                let found = exact(&single, at, POINTS, 1);
                let (wanted, rounding) = unshadowed(&shape, at);
                let spread = (found.halves[0] - found.halves[1]).abs().max_element();
                let off = (found.mean() - wanted).abs().max_element();
                let size = wanted.max_element();
                // Where f32 may take the one side of a plane for the other.
                if rounding > 0.5 {
                    continue;
                }
                let mut limit = rounding * size;
                if matches!(shape, Shape::Triangle { .. }) {
                    // Two halves say of themselves how far they are off, about.
                    limit += 2e-3 * size + 4.0 * spread;
                    // Next to a light most points by area are worth next to nothing.
                    if spread < 1e-2 * size { sharp += 1 } else { blunt += u32::from(size > 0.0) }
                } else {
                    delta += u32::from(size > 0.0);
                }
                lit += u32::from(size > 0.0);
                if off > limit {
                    failed.push(format!("{name}: {} for {wanted} of {shape:?} at {at:?}", found.mean()));
                }
            }
        }
        assert!(lit > 50, "{name}: {lit} pairs of light and receiver say anything");
    }
    assert!(failed.is_empty(), "{} fail:\n{}", failed.len(), failed[..failed.len().min(20)].join("\n"));
    assert!(delta > 5_000 && sharp > 1_000 && blunt < sharp / 20, "{delta}, {sharp} and {blunt} say anything");
}

/// One lamp, and a million bulbs that light nothing.
static A_MILLION: LazyLock<Stage> = LazyLock::new(|| Stage::new(scene(MILLION, 16 * 9), LeaveOut::No, Offset::SCALED));

/// Strategies that take longer than a few seconds to verify among a million lights.
const SLOW: [&str; 4] = ["all", "allocate", "stochastic-cull", "oracle"];

fn assert_verified_among_a_million(wanted: impl Fn(&str) -> bool) {
    let options = VerifyOptions { receivers: 2, draws: 400, batches: 50, points: 1, ..VerifyOptions::default() };
    let verifier = Verifier::new(&A_MILLION, options);
    assert!(verifier.truths().iter().any(|truth| truth.total() > 0.0), "{MILLION} is black");
    let (mut failed, mut tried) = (Vec::new(), 0);
    for info in Registry::standard().infos().filter(|info| wanted(info.name)) {
        let strategy = Registry::standard().parse(info.name).expect("a name of the registry");
        let checks = verifier.verify(&strategy).expect("a sampler");
        tried += 1;
        failed.extend(checks.iter().filter(|c| !c.passed).map(|c| format!("{}: {c}", strategy.name())));
    }
    assert!(tried > 0, "no strategy is tried");
    assert!(failed.is_empty(), "seed {}:\n{}", options.seed, failed.join("\n"));
}

#[test]
fn strategies_keep_their_contract_among_a_million_lights() {
    assert_verified_among_a_million(|name| !SLOW.contains(&name));
}

#[test]
#[ignore = "two minutes: strategies that look at every light"]
fn slow_strategies_keep_their_contract_among_a_million_lights() {
    assert_verified_among_a_million(|name| SLOW.contains(&name));
}

#[test]
fn one_light_among_a_million_is_found() {
    let stage = &*A_MILLION;
    assert_eq!(stage.scene().lights().len(), 1_000_001);
    assert_finite(MILLION, stage);
    let sum = |name: &str, passes| image(name, stage, passes).iter().map(|rgb| f64::from(rgb.x)).sum::<f64>();
    let truth = sum("all", 1);
    assert!(truth > 0.0);
    // Whoever looks at what a light can add at the point finds the one that adds anything.
    // From the box's walls the bulbs are above the horizon, and the ground hides them: what is picked there is often
    // dark.
    for name in ["intensity", "light-tree"] {
        let found = sum(name, 16) / truth;
        assert!((found - 1.0).abs() < 0.3, "{name}: {found} of the light");
    }
}
