//! Random ranges: as many lights as the closed form says, and the whole scene on average, however few are shaded.

use crate::promises::common::{ALBEDO, ground, point, receiver, sampler, sixteen, stage, stage_with};
use citylights::base::colour::luminance;
use citylights::base::random::RunKey;
use citylights::base::statistics::Moments;
use citylights::render::exact::exact;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::light::Shape;
use citylights::scene::receiver::Receiver;
use citylights::strategy::{Frame, PickBuffer};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;

/// Mean luminance of all receivers in each of several independent runs.
fn runs(name: &str, stage: &Stage, passes: u32, runs: u32) -> Moments {
    let sampler = sampler(name, stage);
    let mean = |run| {
        let mut film = Film::new(stage.receivers().len());
        let key = RunKey { seed: 5, run };
        Plan { stage, receivers: stage.receivers(), sampler: &*sampler, key }.run_parallel(passes, &mut film);
        film.image().iter().map(|rgb| f64::from(luminance(*rgb))).sum::<f64>() / film.image().len() as f64
    };
    Moments::of((0..runs).map(mean).collect::<Vec<f64>>().iter().copied())
}

#[test]
fn random_ranges_and_few_places_lose_nothing() {
    let stage = stage(sixteen());
    let truth = |at: &Receiver| f64::from(luminance(exact(&stage, at, 400, 3).mean().as_vec3()));
    let truth = stage.receivers().iter().map(truth).sum::<f64>() / stage.receivers().len() as f64;
    for draw in ["pass", "receiver"] {
        for picks in [0, 1, 4] {
            for points in ["random", "r2"] {
                // A threshold of 50 full whites leaves few lights in range for certain.
                let name = format!("stochastic-cull:draw={draw},picks={picks},cutoff=255,points={points}");
                let found = runs(&name, &stage, 40, 24);
                let t = (found.mean - truth) / found.standard_error();
                println!("{name}: {:+.3} %, t {t:.2}", 100.0 * (found.mean / truth - 1.0));
                // 12 two-sided tests at a level of 1 % together: 4.0 with 23 degrees of freedom.
                assert!(t.abs() < 4.0, "{name}: {} for {truth}, t {t}, seed 5", found.mean);
                assert!(found.standard_error() < 0.02 * truth, "{name} sees nothing: {found:?}");
            }
        }
    }
}

#[test]
fn lists_grow_with_the_logarithm_of_the_radius() {
    // Equal lamps in a plane, n0 of them inside the least range: n0 (1 + 2 ln(R / r0)) are expected in range.
    let (r0, radius) = (6.0f64, 60.0f64);
    let candela = std::f64::consts::PI * 0.5 / 255.0 / f64::from(ALBEDO) * r0 * r0;
    let side = radius as i32;
    let lamps: Vec<Shape> = (-side..=side)
        .flat_map(|x| (-side..=side).map(move |y| Vec3::new(x as f32 + 0.5, y as f32 + 0.5, 4.0)))
        .filter(|at| f64::from(at.truncate().length()) < radius)
        .map(|at| point(at, candela as f32))
        .collect();
    let stage = stage_with(ground(90.0, lamps), LeaveOut::No, Offset::SCALED);
    let at = receiver(Vec3::new(0.0, 0.0, 4.0), Vec3::X);
    let wanted = std::f64::consts::PI * r0 * r0 * (1.0 + 2.0 * (radius / r0).ln());
    for draw in ["pass", "receiver"] {
        let sampler = sampler(&format!("stochastic-cull:draw={draw},picks=0,points=random"), &stage);
        let mut counts = vec![0.0; stage.scene().lights().len()];
        assert!(sampler.expected_counts(&at, &mut counts));
        let expected: f64 = counts.iter().map(|&c| f64::from(c)).sum();
        assert!((expected / wanted - 1.0).abs() < 0.01, "{draw}: {expected} expected, {wanted} by the closed form");
        let mut buffer = PickBuffer::default();
        let receivers = [at];
        let found: Vec<f64> = (0..400)
            .map(|pass| {
                let block = sampler.begin(Frame::new(&receivers, RunKey { seed: 2, run: 0 }), pass..pass + 1);
                block.worker(false).fill(&receivers, pass..pass + 1, false, &mut buffer);
                buffer.len() as f64
            })
            .collect();
        let found = Moments::of(found.iter().copied());
        let t = (found.mean - expected) / found.standard_error();
        assert!(t.abs() < 4.0, "{draw}: {} in range for {expected}, t {t}, seed 2", found.mean);
    }
}
