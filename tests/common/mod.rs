//! Scenes small enough to reason about, made from parts.

#![allow(dead_code, unreachable_pub, unused_imports, reason = "each test file uses a part of this module")]

#[cfg(feature = "measure")]
pub mod alone;

use citylights::base::random::{RunKey, Stream};
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::receiver::Receiver;
use citylights::scene::{Parts, Scene};
pub use citylights::sources::small::{ALBEDO, camera, cuboid, ground, moon, panel, point, sixteen, spot};
use citylights::strategy::{AnySampler, BuildContext, Registry};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};

/// A stage with everything default.
pub fn stage(parts: Parts) -> Stage {
    stage_with(parts, LeaveOut::Yes, Offset::SCALED)
}

pub fn stage_with(parts: Parts, leave_out: LeaveOut, offset: Offset) -> Stage {
    Stage::new(Scene::new(parts).expect("a scene"), leave_out, offset)
}

/// A receiver made by hand.
pub fn receiver(position: Vec3, normal: Vec3) -> Receiver {
    Receiver { position, normal, view: normal, albedo: Vec3::splat(ALBEDO), pixel: 0, surface: 0 }
}

/// A sampler of a registered strategy.
pub fn sampler(strategy: &str, stage: &Stage) -> Box<dyn AnySampler> {
    Registry::standard().parse(strategy).expect(strategy).build(BuildContext { stage, seed: 1 }).expect(strategy)
}

/// Expected counts of a registered strategy at a receiver.
pub fn expected(strategy: &str, stage: &Stage, at: &Receiver) -> Vec<f32> {
    let mut counts = vec![0.0; stage.scene().lights().len()];
    assert!(sampler(strategy, stage).expected_counts(at, &mut counts));
    counts
}

/// The image of a registered strategy: mean radiance of each receiver.
pub fn image(strategy: &str, stage: &Stage, passes: u32) -> Vec<Vec3> {
    let sampler = sampler(strategy, stage);
    let mut film = Film::new(stage.receivers().len());
    let key = RunKey { seed: 1, run: 0 };
    Plan { stage, receivers: stage.receivers(), sampler: &*sampler, key }.run_parallel(passes, &mut film);
    film.image()
}

/// A direction uniform over the sphere.
pub fn on_sphere(stream: &mut Stream) -> Vec3 {
    let z = stream.uniform64() * 2.0 - 1.0;
    let (sin, cos) = (stream.uniform64() * std::f64::consts::TAU).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos, r * sin, z).as_vec3()
}

/// Bits of an image, for comparing bytes.
pub fn bits(image: &[Vec3]) -> Vec<[u32; 3]> {
    image.iter().map(|rgb| rgb.to_array().map(f32::to_bits)).collect()
}
