//! What must not change when the scene changes in a way that changes nothing, and what must change by a known factor.

mod common;

use citylights::scene::light::Shape;
use citylights::scene::receiver::Receiver;
use citylights::scene::{Parts, Scene};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use common::{bits, camera, expected, image, point, sixteen, stage_with};
use glam::{DVec3, Vec3};

const CHOOSING: [&str; 5] = ["uniform", "power", "intensity", "influence-pick:cutoff=20", "influence-tail:cutoff=20"];

fn whole(parts: Parts) -> Stage {
    stage_with(parts, LeaveOut::No, Offset::SCALED)
}

/// Lengths times `s`, intensities times its square: radiance stays.
fn scaled(parts: &Parts, s: f32) -> Parts {
    let mut parts = parts.clone();
    for light in &mut parts.lights {
        match light {
            Shape::Point { position, intensity } | Shape::Spot { position, intensity, .. } => {
                *position *= s;
                *intensity *= s * s;
            }
            Shape::Triangle { corners, .. } => corners.iter_mut().for_each(|c| *c *= s),
            Shape::Directional { .. } => {}
        }
    }
    parts.surfaces.iter_mut().for_each(|surface| surface.corners.iter_mut().for_each(|c| *c *= s));
    parts.camera = camera(parts.camera.position() * s, Vec3::new(0.0, 1.0, 0.0) * s);
    parts
}

fn assert_close(a: &[f32], b: &[f32], what: &str) {
    assert!(a.iter().any(|&c| c > 0.0), "{what}: nothing can be chosen");
    for (i, (x, y)) in a.iter().zip(b).enumerate() {
        assert!((x - y).abs() <= 2e-5 * x.max(*y) + 1e-9, "{what}: light {i}: {x} and {y}");
    }
}

#[test]
fn scaling_the_scene_changes_no_expected_count() {
    let base = whole(sixteen());
    for s in [0.01f32, 100.0] {
        let other = whole(scaled(&sixteen(), s));
        for at in base.receivers().iter().step_by(41) {
            let there = Receiver { position: at.position * s, ..*at };
            for name in CHOOSING {
                let (a, b) = (expected(name, &base, at), expected(name, &other, &there));
                assert_close(&a, &b, &format!("{name} at scale {s}, pixel {}", at.pixel));
            }
        }
    }
}

#[test]
fn moving_the_origin_changes_no_byte() {
    let mut parts = sixteen();
    let before = Scene::new(parts.clone()).expect("a scene");
    parts.origin = DVec3::new(1e6, -3e5, 1e3);
    let after = Scene::new(parts.clone()).expect("a scene");
    let digest = |scene: &Scene| {
        let mut bytes = Vec::new();
        scene.digest(|part| bytes.extend_from_slice(part));
        bytes
    };
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
