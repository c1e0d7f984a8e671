//! What every strategy promises exactly: no allocation, no dependence on threads, nothing lost by leaving out.

use crate::promises::common::{
    bits, cuboid, ground, image, moon, panel, point, sampler, sixteen, spot, stage, stage_with,
};
use citylights::base::random::RunKey;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::Parts;
use citylights::strategy::{Frame, PickBuffer, Registry};
use citylights::verify::allocations;
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;

/// Strategies as they come, and with the parameters that change what they keep.
fn configurations() -> impl Iterator<Item = &'static str> {
    let others = [
        "stochastic-cull:draw=receiver",
        "light-tree:split=0.5",
        "light-tree:facing=rms",
        "light-tree:open=0,arity=2,importance=classic",
        "resampled:from=light-tree,m=4,visibility=on",
    ];
    let all: Vec<&str> = Registry::standard().infos().map(|info| info.name).collect();
    all.into_iter().chain(others)
}

#[test]
fn no_strategy_allocates_once_it_is_warm() {
    let stage = stage(sixteen());
    for name in configurations() {
        let sampler = sampler(name, &stage);
        let passes = sampler.most_passes().min(4);
        let block = sampler.begin(Frame::new(stage.receivers(), RunKey { seed: 3, run: 0 }), 0..passes);
        let found = allocations(crate::promises::counting::allocations, || {
            let (mut worker, mut buffer) = (block.worker(false), PickBuffer::default());
            let stage = &stage;
            move || worker.fill(stage.receivers(), 0..passes, true, &mut buffer)
        });
        assert_eq!(found, 0, "{name} allocates");
    }
}

#[test]
fn the_counter_counts() {
    let found = allocations(crate::promises::counting::allocations, || || drop(std::hint::black_box(vec![1u8; 100])));
    assert_eq!(found, 1);
}

fn film(name: &str, stage: &Stage, threads: usize) -> Film {
    let sampler = sampler(name, stage);
    let mut film = Film::new(stage.receivers().len());
    let plan = Plan { stage, receivers: stage.receivers(), sampler: &*sampler, key: RunKey { seed: 9, run: 2 } };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| plan.run_parallel(5, &mut film));
    film
}

#[test]
fn one_thread_and_two_give_the_same_bytes() {
    let stage = stage(sixteen());
    for name in configurations() {
        let sampler = sampler(name, &stage);
        let mut alone = Film::new(stage.receivers().len());
        let plan =
            Plan { stage: &stage, receivers: stage.receivers(), sampler: &*sampler, key: RunKey { seed: 9, run: 2 } };
        plan.run(5, &mut alone);
        for threads in [1, 2] {
            assert_eq!(bits(&film(name, &stage, threads).image()), bits(&alone.image()), "{name} on {threads} threads");
        }
    }
}

/// Lights that leaving out must leave alone, and some that it may drop: below the ground, turned away, black.
fn useless_among_useful() -> Parts {
    let mut parts = sixteen();
    let mut lights = vec![
        point(Vec3::new(1.0, 1.0, -3.0), 100.0),
        moon(Vec3::new(0.1, 0.1, -1.0), 5.0),
        spot(Vec3::new(0.0, 0.0, 9.0), Vec3::Z, 500.0),
        point(Vec3::new(0.0, 0.0, 4.0), 0.0),
    ];
    lights.extend(panel(Vec3::new(0.0, 0.0, 9.0), Vec3::X, Vec3::Y, 300.0));
    lights.append(&mut parts.lights);
    lights.insert(12, point(Vec3::new(2.0, 2.0, -1.0), 50.0));
    parts.lights = lights;
    parts
}

/// The inside of a convex, open shape: nothing can stand in the way.
fn plaza() -> Parts {
    let mut lights: Vec<_> =
        (0..30).map(|i| point(Vec3::new(i as f32 - 15.0, (i * 7 % 13) as f32 - 6.0, 4.0), 50.0)).collect();
    lights.push(spot(Vec3::new(0.0, 0.0, 7.0), Vec3::NEG_Z, 500.0));
    ground(20.0, lights)
}

fn moonlit_plaza_with_panels() -> Parts {
    let mut lights = vec![moon(Vec3::new(0.2, 0.3, 0.9), 0.25), point(Vec3::new(3.0, 3.0, -2.0), 10.0)];
    lights.extend(panel(Vec3::new(-9.0, -1.0, 5.0), Vec3::Y * 2.0, Vec3::X * 2.0, 100.0));
    lights.push(moon(Vec3::NEG_Z, 0.25));
    lights.extend(panel(Vec3::new(9.0, -1.0, 5.0), Vec3::Y * 2.0, Vec3::X * 2.0, 100.0));
    ground(20.0, lights)
}

fn walled() -> Parts {
    let mut parts = plaza();
    parts.surfaces.extend(cuboid(Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, 2.0, 6.0)));
    parts
}

#[test]
fn leaving_out_changes_no_byte_of_all() {
    let scenes = [
        ("sixteen", sixteen()),
        ("useless among useful", useless_among_useful()),
        ("plaza", plaza()),
        ("moonlit plaza with panels", moonlit_plaza_with_panels()),
        ("walled", walled()),
    ];
    for (name, parts) in scenes {
        for (policy, offset) in Offset::NAMED {
            let with = image("all", &stage_with(parts.clone(), LeaveOut::Yes, offset), 2);
            let without = image("all", &stage_with(parts.clone(), LeaveOut::No, offset), 2);
            let differ = bits(&with).iter().zip(&bits(&without)).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{name}, offset {policy}: {differ} of {} receivers differ", with.len());
        }
    }
}

#[test]
fn leaving_out_leaves_something_out() {
    let parts = useless_among_useful();
    let lights = parts.lights.len();
    // Upward from above all, a dark one, two panels: the walls' receivers may see what is below the ground.
    assert!(stage(parts).lights().len() <= lights - 4);
    assert!(!stage(plaza()).needs().occlusion, "a plaza needs no shadow rays");
    assert!(stage(walled()).needs().occlusion);
}
