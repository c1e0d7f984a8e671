//! What must not change when the scene changes in a way that changes nothing, and what must change by a known factor.

use crate::promises::common::{bits, digest, expected, image, point, sixteen, stage_with};
use citylights::scene::light::Shape;
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::{Parts, Scene};
use citylights::sources::small;
use citylights::strategy::Registry;
use citylights::verify::metamorphic::{Copies, Metamorphic};
use citylights::verify::{Check, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};

const CHOOSING: [&str; 5] = ["uniform", "power", "intensity", "influence-pick:cutoff=20", "influence-tail:cutoff=20"];

fn whole(parts: Parts) -> Stage {
    stage_with(parts, LeaveOut::No, Offset::SCALED)
}

fn assert_close(a: &[f32], b: &[f32], what: &str) {
    assert!(a.iter().any(|&c| c > 0.0), "{what}: nothing can be chosen");
    for (i, (x, y)) in a.iter().zip(b).enumerate() {
        assert!((x - y).abs() <= 2e-5 * x.max(*y) + 1e-9, "{what}: light {i}: {x} and {y}");
    }
}

/// The checks of level 2 for every registered strategy: all pass, and the truth itself.
fn unchanged(scene: &Scene, options: VerifyOptions) {
    let copies = Copies::new(scene, Offset::SCALED, LightSampling::default()).expect("changed scenes");
    let metamorphic = Metamorphic::new(&copies, options);
    let mut failed = Vec::new();
    let mut tell = |who: &str, checks: &[Check]| {
        for check in checks {
            println!("{who:<16} {check}");
            if !check.passed {
                failed.push(format!("{who:<16} {check}"));
            }
        }
    };
    tell("the image", &metamorphic.image());
    let mut scaled = 0;
    for info in Registry::standard().infos() {
        let strategy = Registry::standard().parse(info.name).expect("a name of the registry");
        let checks = metamorphic.verify(&strategy).expect("samplers");
        scaled += usize::from(checks.iter().any(|check| check.name == "scaled-counts"));
        tell(info.name, &checks);
    }
    assert!(scaled >= 5, "only {scaled} strategies tell what they choose by");
    assert!(failed.is_empty(), "{}:\n{}", scene.name(), failed.join("\n"));
}

#[test]
fn no_change_that_changes_nothing_changes_a_small_scene() {
    for parts in small::all().into_iter().filter(|parts| ["sixteen", "one-place"].contains(&&*parts.name)) {
        let options = VerifyOptions { receivers: 8, draws: 5_000, batches: 50, ..VerifyOptions::default() };
        unchanged(&Scene::new(parts).expect("a scene"), options);
    }
}

#[test]
fn no_change_that_changes_nothing_changes_a_city() {
    use citylights::sources::Overrides;
    use citylights::sources::recipe::load;
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
    let scene = load(&file, &Overrides::default()).expect("a shipped scene");
    unchanged(
        &scene,
        VerifyOptions { receivers: 8, draws: 2_000, batches: 50, points: 16, ..VerifyOptions::default() },
    );
}

#[test]
fn moving_the_origin_changes_no_byte() {
    let mut parts = sixteen();
    let before = Scene::new(parts.clone()).expect("a scene");
    parts.origin = DVec3::new(1e6, -3e5, 1e3);
    let after = Scene::new(parts.clone()).expect("a scene");
    assert_eq!(digest(&before), digest(&after));
    for name in ["all", "power", "influence-tail"] {
        assert_eq!(bits(&image(name, &whole(sixteen()), 3)), bits(&image(name, &whole(parts.clone()), 3)), "{name}");
    }
}

#[test]
fn permuting_the_lights_permutes_the_expected_counts() {
    let base = whole(sixteen());
    let n = base.scene().lights().len();
    // 5 has no factor in common with 16.
    let place = |i: usize| (i * 5 + 3) % n;
    let mut parts = sixteen();
    sixteen().lights.into_iter().enumerate().for_each(|(i, light)| parts.lights[place(i)] = light);
    let other = whole(parts);
    for at in base.receivers().iter().step_by(41) {
        for name in CHOOSING {
            let (a, moved) = (expected(name, &base, at), expected(name, &other, at));
            let back: Vec<f32> = (0..n).map(|i| moved[place(i)]).collect();
            assert_close(&a, &back, name);
        }
    }
}

#[test]
fn a_black_light_changes_neither_the_image_nor_a_choice_by_power() {
    for leave_out in [LeaveOut::Yes, LeaveOut::No] {
        let base = stage_with(sixteen(), leave_out, Offset::SCALED);
        let mut parts = sixteen();
        parts.lights.push(point(Vec3::new(0.0, 1.0, 4.0), 0.0));
        let other = stage_with(parts, leave_out, Offset::SCALED);
        assert_eq!(bits(&image("all", &base, 3)), bits(&image("all", &other, 3)), "{leave_out:?}");
        for name in ["power", "intensity"] {
            let at = &base.receivers()[100];
            let (a, b) = (expected(name, &base, at), expected(name, &other, at));
            assert_close(&a, &b[..a.len()], name);
            assert_eq!(b[a.len()], 0.0, "{name}");
        }
    }
}

#[test]
fn lights_of_k_times_the_strength_give_k_times_the_image() {
    let base = image("all", &whole(sixteen()), 3);
    assert!(base.iter().any(|rgb| rgb.x > 0.0));
    for k in [4.0f32, 1_048_576.0, 1.0 / 1_048_576.0] {
        let mut parts = sixteen();
        for light in &mut parts.lights {
            match light {
                Shape::Point { intensity: colour, .. }
                | Shape::Spot { intensity: colour, .. }
                | Shape::Directional { irradiance: colour, .. }
                | Shape::Triangle { radiance: colour, .. } => *colour *= k,
            }
        }
        let wanted: Vec<Vec3> = base.iter().map(|rgb| *rgb * k).collect();
        assert_eq!(bits(&image("all", &whole(parts), 3)), bits(&wanted), "k = {k}");
    }
}
