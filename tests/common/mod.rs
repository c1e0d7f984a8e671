//! Scenes small enough to reason about, made from parts.

#![allow(dead_code, unreachable_pub, unused_imports, reason = "each test file uses a part of this module")]

use citylights::base::random::{RunKey, Stream};
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::receiver::Receiver;
use citylights::scene::{Parts, Scene};
pub use citylights::sources::small::{ALBEDO, camera, cuboid, ground, moon, panel, point, sixteen, spot};
use citylights::strategy::{AnySampler, BuildContext, Registry};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use cpu_time::ThreadTime;
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

/// What decides the image, as text to compare.
pub fn digest(scene: &Scene) -> Vec<u8> {
    let mut bytes = Vec::new();
    scene.digest(|more| bytes.extend(more));
    bytes
}

/// Irradiance of a polygon of unit radiance that lies wholly above the horizon of `normal` at `x`: Lambert 1760, by the
/// vector irradiance of its edges.
pub fn lambert(corners: [Vec3; 3], x: Vec3, normal: Vec3) -> f64 {
    let unit = corners.map(|c| (c.as_dvec3() - x.as_dvec3()).normalize());
    let edge = |i: usize| {
        let (a, b) = (unit[i], unit[(i + 1) % 3]);
        let cross = a.cross(b);
        cross.length().atan2(a.dot(b)) * cross.normalize().dot(normal.as_dvec3())
    };
    0.5 * (0..3).map(edge).sum::<f64>().abs()
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

/// How many times as much of a thread's CPU time `large` takes as `small`, whatever the machine; each the least of two,
/// for what else a machine does only adds.
pub fn times_as_long(large: impl Fn() + Sync, small: impl Fn() + Sync) -> f64 {
    // In a pool of one thread, so that all that is started there is timed.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let once = |work: &(dyn Fn() + Sync)| {
        alone.install(|| {
            let begun = ThreadTime::now();
            work();
            begun.elapsed().as_secs_f64()
        })
    };
    let least = |work: &(dyn Fn() + Sync)| once(work).min(once(work));
    let (large, small) = (least(&large), least(&small));
    println!("{large:.4} s and {small:.4} s of CPU time");
    large / small
}

/// The most that ten times the work may take: in proportion it takes about 10 times as long, by its square 100 times.
pub const IN_PROPORTION: f64 = 50.0;
