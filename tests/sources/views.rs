//! Promise: a view that the generator places stands in the city, sees it, and changes nothing else of the scene.
#![cfg(feature = "recipe")]

use citylights::sources::city::View;
use citylights::sources::recipe::load;
use citylights::sources::{Overrides, open};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use citylights::visibility::view::Seen;
use std::path::PathBuf;

const VIEWS: [View; 3] = [View::Street, View::Roof, View::Sky];

/// Every shipped recipe with a city, and how many lights it is given here: a million take too long.
const CITIES: [(&str, Option<u64>); 7] = [
    ("first-night", None),
    ("downtown", None),
    ("lamps-only", None),
    ("metropolis", Some(10_000)),
    ("stadium", None),
    ("moonlit", None),
    ("megacity", Some(10_000)),
];

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.toml"))
}

fn looked_at(name: &str, lights: Option<u64>, seed: u64, view: View) -> Stage {
    let overrides =
        Overrides { view: Some(view), seed: Some(seed), resolution: Some((32, 18)), lights, ..Overrides::default() };
    let scene = load(&file(name), &overrides).unwrap_or_else(|error| panic!("{error}"));
    Stage::new(scene, LeaveOut::No, Offset::SCALED)
}

#[test]
fn every_view_of_every_shipped_city_sees_it() {
    for (name, lights) in CITIES {
        for seed in 1..=20 {
            for view in VIEWS {
                let stage = looked_at(name, lights, seed, view);
                let pixels = stage.view().pixels();
                let surfaces = pixels.iter().filter(|seen| matches!(seen, Seen::Receiver(_))).count();
                let share = surfaces as f64 / pixels.len() as f64;
                assert!(share >= 0.2, "{name}, seed {seed}, {view:?}: {share} of the pixels see a surface");
                let eye = stage.scene().camera().position();
                let mut far: Vec<f32> = stage.receivers().iter().map(|at| at.position.distance(eye)).collect();
                far.sort_by(f32::total_cmp);
                let median = far[far.len() / 2];
                assert!(median > 4.0, "{name}, seed {seed}, {view:?}: half of what is seen is within {median} m");
            }
        }
    }
}

#[test]
fn a_view_changes_the_camera_alone() {
    let own = load(&file("first-night"), &Overrides::default()).expect("a scene");
    for view in VIEWS {
        let seen =
            load(&file("first-night"), &Overrides { view: Some(view), ..Overrides::default() }).expect("a scene");
        assert!(seen.lights() == own.lights() && seen.surfaces().len() == own.surfaces().len());
        let (camera, before) = (seen.camera(), own.camera());
        assert!(camera.position() != before.position() && camera.resolution() == before.resolution());
        assert!((camera.fov() - before.fov()).abs() < 1e-9, "{view:?}");
    }
}

#[test]
fn the_views_of_a_known_city_are_these() {
    let at = |view| {
        let scene =
            load(&file("first-night"), &Overrides { view: Some(view), ..Overrides::default() }).expect("a scene");
        let (eye, forward) = (scene.camera().position(), scene.camera().forward());
        format!("{view:?} from {eye} along {forward:.6}")
    };
    insta::assert_snapshot!(VIEWS.map(at).join("\n"));
}

#[test]
fn what_has_no_city_has_no_views() {
    let refused = |file: PathBuf| {
        let error = open(&file, &Overrides { view: Some(View::Roof), ..Overrides::default() }).expect_err("no city");
        let text = error.to_string();
        let told = ["city", "street, roof, sky", "roof"].iter().all(|part| text.contains(part));
        assert!(told && text.contains(&file.display().to_string()), "{text}");
    };
    refused(file("plaza"));
    #[cfg(feature = "gltf")]
    {
        let folder = tempfile::tempdir().expect("a folder");
        let gltf = folder.path().join("empty.gltf");
        std::fs::write(&gltf, "{\"asset\": {\"version\": \"2.0\"}}").expect("written");
        refused(gltf);
    }
}
