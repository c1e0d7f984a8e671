//! Reuse of neighbours' candidates: unbiased where it says so, and measurably dark where it does not.

use super::runs::Runs;
use crate::promises::common::{bits, sampler, sixteen, stage};
use citylights::base::random::RunKey;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::strategy::{Claim, Registry};
use glam::Vec3;

#[test]
fn pairwise_reuse_is_unbiased() {
    let stage = stage(sixteen());
    for name in [
        "restir",
        "restir:from=power,visibility=off",
        "restir:from=uniform,m=2,neighbours=5,radius=8",
        "restir:from=uniform:picks=2,m=1,neighbours=1,radius=3,visibility=off",
    ] {
        Runs::new(name, &stage, 64, 16).assert_unbiased(name);
    }
}

#[test]
fn reuse_by_one_over_m_is_dark_at_edges_and_shadows() {
    let stage = stage(sixteen());
    let name = "restir:from=power,combine=1/M";
    let runs = Runs::new(name, &stage, 64, 16);
    let (energy, (worst, limit)) = (runs.energy(), runs.worst());
    let half = energy.half_width(0.99);
    println!("{name}: energy {:+.4} ±{half:.4}, worst |t| {worst:.1}, limit {limit:.1}", energy.mean - 1.0);
    assert!(energy.mean - 1.0 + half < -0.01 && worst > limit, "{name}: {energy:?}, {worst}");
    assert!(matches!(Registry::standard().parse(name).expect(name).info().claim, Claim::Biased { .. }));
}

#[test]
fn reuse_lowers_the_error_of_a_pass() {
    let stage = stage(sixteen());
    let mse = |name: &str| Runs::new(name, &stage, 8, 4).mse();
    let names =
        ["resampled:from=uniform,m=4,points=random", "restir:from=uniform,m=4,neighbours=5,radius=5,points=random"];
    let [alone, reused] = names.map(mse);
    println!("MSE {alone:.3e}, {reused:.3e}");
    assert!(reused < 0.7 * alone, "{alone} and {reused}");
}

fn image(receivers: &[citylights::scene::receiver::Receiver], threads: usize) -> Vec<Vec3> {
    let stage = stage(sixteen());
    let sampler = sampler("restir", &stage);
    let plan = Plan { stage: &stage, receivers, sampler: &*sampler, key: RunKey { seed: 3, run: 1 } };
    let mut film = Film::new(receivers.len());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| plan.run_parallel(3, &mut film));
    film.image()
}

#[test]
fn threads_and_the_order_of_receivers_change_nothing() {
    let receivers = stage(sixteen()).receivers().to_vec();
    let one = image(&receivers, 1);
    assert_eq!(bits(&one), bits(&image(&receivers, 2)));
    let reversed: Vec<_> = receivers.iter().rev().copied().collect();
    let mut back = image(&reversed, 2);
    back.reverse();
    assert_eq!(bits(&one), bits(&back));
}

#[test]
fn a_frame_without_neighbours_is_right_too() {
    let stage = stage(sixteen());
    let few: Vec<_> = stage.receivers().iter().step_by(40).copied().collect();
    let sampler = sampler("restir:radius=2", &stage);
    let mut film = Film::new(few.len());
    let key = RunKey { seed: 3, run: 1 };
    Plan { stage: &stage, receivers: &few, sampler: &*sampler, key }.run(2_000, &mut film);
    let (mut found, mut wanted) = (0.0, 0.0);
    for (at, shown) in few.iter().zip(film.image()) {
        found += f64::from(shown.y);
        wanted += citylights::render::exact::exact(&stage, at, 4_000, 6).mean().y;
    }
    assert!((found / wanted - 1.0).abs() < 0.01, "{found} for {wanted}");
}

#[test]
fn receivers_beyond_the_cameras_pixels_have_no_neighbours_and_no_accident() {
    let stage = stage(sixteen());
    let beyond: Vec<_> = (stage.receivers().iter().step_by(100).zip(5_000..))
        .map(|(at, pixel)| citylights::scene::receiver::Receiver { pixel, ..*at })
        .collect();
    assert!(image(&beyond, 1).iter().all(|rgb| rgb.is_finite()));
}
