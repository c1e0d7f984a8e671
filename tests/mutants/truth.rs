//! Faults in code that the truth shares with what it judges: each is seen by arithmetic that shares nothing with either.

#![cfg(all(feature = "measure", feature = "recipe"))]

use crate::promises::common::{cuboid, ground, panel, sixteen, stage};
use citylights::scene::Parts;
use citylights::scene::light::LightId;
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use citylights::verify::Check;
use citylights::verify::independent::{Own, Path, independent};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use citylights::visibility::visits::Receivers;
use glam::{DVec3, Vec3};
use std::sync::LazyLock;

static CITY: LazyLock<Stage> = LazyLock::new(|| {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
    Stage::new(load(&file, &Overrides::default()).expect("a shipped scene"), LeaveOut::Yes, Offset::SCALED)
});

const LEVEL: f64 = 1e-6;

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    /// The numbers of a point on a triangle taken the other way round.
    Map,
    /// A triangle counted by twice its area.
    Area,
    /// Normals turned to the camera's axis instead of to the camera.
    Normals,
    /// Shadow rays that start 5 cm off.
    Offset,
    /// No importance of one triangle in a hundred.
    Dropped,
    /// An exact sum that is 1 % short.
    Short,
    /// Spots that are 1 % too bright.
    Bright,
    /// Passes that visit what a pixel eight columns beside sees, or what a bounce from there meets.
    Beside,
}

/// The program's path with one thing wrong.
struct Mutant<'a> {
    own: Own<'a>,
    receivers: Vec<Receiver>,
    fault: Fault,
}

impl<'a> Mutant<'a> {
    fn new(stage: &'a Stage, fault: Fault) -> Self {
        let forward = stage.scene().camera().forward().as_vec3();
        let mut receivers = stage.receivers().to_vec();
        if fault == Fault::Normals {
            for at in &mut receivers {
                at.normal *= -at.normal.dot(forward).signum();
            }
        }
        Self { own: Own(stage), receivers, fault }
    }
}

impl Path for Mutant<'_> {
    fn receivers(&self) -> &[Receiver] {
        &self.receivers
    }

    fn visited(&self, centre: &Receiver, pass: u32) -> Option<Receiver> {
        let pixel = if self.fault == Fault::Beside { centre.pixel + 8 } else { centre.pixel };
        Some(Receiver { pixel, ..self.own.visited(centre, pass)? })
    }

    fn unshadowed(&self, by: LightSampling, light: LightId, [u, v]: [f32; 2], at: &Receiver) -> DVec3 {
        let uv = if self.fault == Fault::Map { [v, u] } else { [u, v] };
        let radiance = self.own.unshadowed(by, light, uv, at);
        let kind = self.own.0.scene().lights()[light as usize].kind().name();
        match (self.fault, kind) {
            (Fault::Area, "triangle") => 2.0 * radiance,
            (Fault::Bright, "spot") => 1.01 * radiance,
            _ => radiance,
        }
    }

    fn visible(&self, light: LightId, uv: [f32; 2], at: &Receiver) -> bool {
        let off = if self.fault == Fault::Offset { 0.05 } else { 0.0 };
        self.own.visible(light, uv, &Receiver { position: at.position + at.normal * off, ..*at })
    }

    fn importance(&self, light: LightId, at: &Receiver) -> f32 {
        if self.fault == Fault::Dropped && light % 100 == 7 { 0.0 } else { self.own.importance(light, at) }
    }

    fn exact(&self, at: &Receiver, points: u32, seed: u64) -> [DVec3; 2] {
        let kept = if self.fault == Fault::Short { 0.99 } else { 1.0 };
        self.own.exact(at, points, seed).map(|half| half * kept)
    }
}

fn failed(checks: &[Check]) -> Vec<&str> {
    checks.iter().for_each(|check| println!("{check}"));
    checks.iter().filter(|check| !check.passed).map(|check| check.name).collect()
}

#[test]
fn the_program_agrees_with_independent_arithmetic() {
    assert!(failed(&independent(&CITY, &Own(&CITY), 1, LEVEL)).is_empty());
    for parts in citylights::sources::small::all().into_iter().chain([sixteen(), near()]) {
        println!("{}", parts.name);
        let stage = stage(parts);
        assert!(failed(&independent(&stage, &Own(&stage), 1, LEVEL)).is_empty());
    }
}

/// Great panels near the ground and a box: drawn by angle, and by area.
fn near() -> Parts {
    let mut lights = panel(Vec3::new(-2.0, -2.0, 1.5), Vec3::Y * 4.0, Vec3::X * 4.0, 100.0).to_vec();
    lights.extend(panel(Vec3::new(3.0, 0.0, 0.2), Vec3::Y * 5.0, Vec3::X * 3.0, 150.0));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-1.0, -1.0, 0.0), Vec3::new(0.5, 0.5, 1.2)));
    parts
}

fn faults(fault: Fault) -> Vec<String> {
    let mutant = Mutant::new(&CITY, fault);
    failed(&independent(&CITY, &mutant, 1, LEVEL)).into_iter().map(str::to_owned).collect()
}

#[test]
fn a_wrong_map_onto_triangles_is_seen() {
    assert_eq!(faults(Fault::Map), ["contribution"]);
    assert_eq!(faults(Fault::Area), ["contribution", "triangle-mean"]);
}

#[test]
fn normals_by_the_axis_of_the_camera_are_seen() {
    assert!(faults(Fault::Normals).contains(&"receivers".to_owned()));
}

#[test]
fn shadow_rays_that_start_too_far_off_are_seen() {
    assert_eq!(faults(Fault::Offset), ["visibility"]);
}

#[test]
fn an_importance_that_drops_one_light_in_a_hundred_is_seen() {
    assert_eq!(faults(Fault::Dropped), ["importance"]);
}

#[test]
fn an_exact_sum_short_of_one_percent_is_seen() {
    assert_eq!(faults(Fault::Short), ["exact-sum"]);
}

#[test]
fn a_spot_one_percent_too_bright_is_seen() {
    assert_eq!(faults(Fault::Bright), ["contribution"]);
}

#[test]
fn passes_that_visit_what_another_pixel_sees_are_seen() {
    for receivers in [Receivers::Spread, Receivers::Bounce] {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
        let scene = load(&file, &Overrides::default()).expect("a shipped scene");
        let stage = Stage::visiting(scene, LeaveOut::Yes, Offset::SCALED, receivers);
        let failed = |fault| -> Vec<Check> {
            let checks = independent(&stage, &Mutant::new(&stage, fault), 1, LEVEL);
            checks.into_iter().filter(|check| !check.passed).collect()
        };
        let right = independent(&stage, &Own(&stage), 1, LEVEL);
        assert!(right.iter().all(|check| check.passed), "{right:?}");
        assert_eq!(failed(Fault::Beside).iter().map(|check| check.name).collect::<Vec<_>>(), ["visits"]);
    }
}
