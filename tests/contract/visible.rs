//! Choosing by what each place sees keeps its promise, whatever was learned; what is learned depends on nothing but the
//! scene and the seed, and stays within its bounds.

use super::runs::Runs;
use crate::promises::common::{bits, cuboid, ground, image, moon, panel, point, receiver, sampler, stage, stage_with};
use citylights::base::draws::Points;
use citylights::base::random::RunKey;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::light::Kind;
use citylights::scene::{Parts, Scene};
use citylights::shading::importance::importance;
use citylights::strategy::{AnySampler, BuildContext, Frame, PickBuffer, Registry};
use citylights::verify::{Verifier, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use citylights::visibility::visits::Receivers;
use glam::Vec3;

/// The tree that it falls back to where other receivers learn.
const TREE: &str = "light-tree:facing=rms";

/// Lamps, panels and a moon around a wall, and strong lamps in a closed box on the ground, which nothing sees.
fn courtyard() -> Parts {
    let mut lights: Vec<_> = (0..12).map(|i| point(Vec3::new(i as f32 * 1.5 - 9.0, 6.0, 3.0), 40.0)).collect();
    lights.extend((0..12).map(|i| point(Vec3::new(i as f32 * 1.5 - 9.0, -6.0, 3.0), 60.0)));
    lights.extend(panel(Vec3::new(-10.0, -1.0, 2.0), Vec3::Y * 2.0, Vec3::Z * 2.0, 50.0));
    lights.extend((0..8).map(|i| point(Vec3::new(4.2 + 0.2 * i as f32, 0.0, 1.0), 5_000.0)));
    lights.push(moon(Vec3::new(0.3, 0.8, 0.6), 2.0));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-9.0, -0.3, 0.0), Vec3::new(3.0, 0.3, 5.0)));
    parts.surfaces.extend(cuboid(Vec3::new(4.0, -1.0, 0.0), Vec3::new(6.0, 1.0, 2.0)));
    parts
}

fn expected(name: &str, stage: &Stage) -> Vec<Vec<f32>> {
    let sampler = sampler(name, stage);
    let counts = |at| {
        let mut counts = vec![0.0; stage.scene().lights().len()];
        assert!(sampler.expected_counts(at, &mut counts));
        counts
    };
    stage.receivers().iter().step_by(29).map(counts).collect()
}

/// The strategy passes all checks of its contract.
fn assert_kept(name: &str, stage: &Stage) {
    let options = VerifyOptions { receivers: 64, draws: 20_000, points: 256, ..VerifyOptions::default() };
    let checks = Verifier::new(stage, options).verify(&Registry::standard().parse(name).expect(name)).expect(name);
    let failed: Vec<String> = checks.iter().filter(|check| !check.passed).map(ToString::to_string).collect();
    assert!(failed.is_empty(), "{name}: {failed:?}");
}

#[test]
fn the_weights_of_each_light_sum_to_one() {
    let stage = stage(courtyard());
    for name in [
        "visible:cell=4",
        "visible:cell=4,picks=1",
        "visible:cell=4,picks=3",
        "visible:cell=4,memory=0",
        "visible:cell=4,cut=1",
    ] {
        let sampler = sampler(name, &stage);
        let passes = 4096;
        let frame = Frame { points: Points::R2, ..Frame::new(stage.receivers(), RunKey { seed: 4, run: 0 }) };
        let block = sampler.begin(frame, 0..passes);
        let (mut worker, mut buffer) = (block.worker(false), PickBuffer::default());
        for (at, counts) in stage.receivers().iter().step_by(29).zip(expected(name, &stage)) {
            worker.fill(&[*at], 0..passes, true, &mut buffer);
            let mut weights = vec![0.0; counts.len()];
            let mut picks = 0;
            for pick in buffer.calls().flatten() {
                let count = f64::from(counts[pick.light as usize]);
                assert!((f64::from(pick.weight) * count - 1.0).abs() < 1e-5, "{name}: {pick:?} of {count} expected");
                weights[pick.light as usize] += f64::from(pick.weight) / f64::from(passes);
                picks += 1;
            }
            let (mean, sum) = (f64::from(picks) / f64::from(passes), counts.iter().map(|&c| f64::from(c)).sum::<f64>());
            assert!((mean - sum).abs() < 5e-3, "{name}: {mean} picks of {sum} expected at pixel {}", at.pixel);
            for (light, (weight, count)) in weights.iter().zip(&counts).enumerate().filter(|(_, (_, c))| **c > 0.02) {
                let limit = 8.0 / (f64::from(*count) * f64::from(passes)).sqrt();
                assert!((weight - 1.0).abs() < limit, "{name}: weights of light {light} sum to {weight}");
            }
        }
    }
}

#[test]
fn lights_that_are_expected_get_whole_numbers_of_picks_in_every_pass() {
    let stage = stage(courtyard());
    let sampler = sampler("visible:picks=16", &stage);
    let begun = sampler.begin(Frame::new(stage.receivers(), RunKey { seed: 1, run: 0 }), 0..4);
    let (mut worker, mut buffer) = (begun.worker(false), PickBuffer::default());
    let (mut lamps, mut triangles, mut moons) = (0, 0, 0);
    for at in stage.receivers() {
        let mut counts = vec![0.0; stage.scene().lights().len()];
        assert!(sampler.expected_counts(at, &mut counts));
        let picks: f32 = counts.iter().sum();
        assert!(picks < 16.0 * 4.0 / 3.0 + 1.0, "{picks} picks");
        worker.fill(std::slice::from_ref(at), 0..4, true, &mut buffer);
        // By chance none is expected a whole number of times.
        for (light, &count) in (0..).zip(&counts).filter(|(_, count)| **count >= 1.0 && count.fract() == 0.0) {
            *(match stage.scene().lights()[light as usize].kind() {
                Kind::Triangle => &mut triangles,
                Kind::Directional => &mut moons,
                Kind::Point | Kind::Spot => &mut lamps,
            }) += 1;
            for call in buffer.calls() {
                let picks: Vec<_> = call.iter().filter(|pick| pick.light == light).collect();
                assert_eq!(picks.len(), count as usize, "light {light}");
                assert!(picks.iter().all(|pick| pick.weight == 1.0 / count), "{picks:?}");
            }
        }
    }
    assert!(lamps > 100 && triangles > 10 && moons > 10, "{lamps} lamps, {triangles} triangles, {moons} moons");
    assert_kept("visible:picks=16", &stage);
}

#[test]
fn it_draws_more_where_each_receiver_is_visited_once() {
    for (receivers, picks) in [(Receivers::Centre, 16), (Receivers::Spread, 64), (Receivers::Bounce, 64)] {
        let scene = Scene::new(courtyard()).expect("a scene");
        let stage = Stage::visiting(scene, LeaveOut::No, Offset::SCALED, receivers);
        assert_eq!(expected("visible", &stage), expected(&format!("visible:picks={picks}"), &stage), "{receivers:?}");
    }
}

#[test]
fn tables_are_learned_where_bounces_end_not_where_the_camera_looks() {
    let [centre, bounce] = [Receivers::Centre, Receivers::Bounce].map(|receivers| {
        Stage::visiting(Scene::new(courtyard()).expect("a scene"), LeaveOut::No, Offset::SCALED, receivers)
    });
    let [by_camera, by_bounces] = [&centre, &bounce].map(|stage| sampler("visible:picks=1", stage));
    let places = bounce.places();
    let counts = |sampler: &dyn AnySampler, at| {
        let mut counts = vec![0.0; bounce.scene().lights().len()];
        assert!(sampler.expected_counts(at, &mut counts));
        counts
    };
    let differ = places.iter().filter(|at| counts(&*by_camera, at) != counts(&*by_bounces, at)).count();
    assert!(places.len() > 20 && 10 * differ > 8 * places.len(), "{differ} of {}", places.len());
}

#[test]
fn a_light_that_no_probe_saw_is_within_reach() {
    let mut parts = courtyard();
    let hidden = 26..34;
    let stage = stage_with(parts.clone(), LeaveOut::No, Offset::SCALED);
    for (counts, at) in expected("visible:cell=4,picks=1", &stage).iter().zip(stage.receivers().iter().step_by(29)) {
        for light in hidden.clone() {
            let above = importance(&stage.scene().lights()[light], at) > 0.0;
            assert_eq!(counts[light] > 0.0, above, "light {light} at {}: {}", at.position, counts[light]);
        }
    }
    // The lid lifted from one side of the box: what few receivers of a cell see is not lost.
    parts.surfaces.truncate(parts.surfaces.len() - 3);
    assert_kept("visible", &stage_with(parts, LeaveOut::No, Offset::SCALED));
}

/// How often lights in the closed box are picked at a receiver, on average.
fn hidden_picks(name: &str, stage: &Stage) -> f64 {
    let counts = expected(name, stage);
    counts.iter().flat_map(|counts| &counts[26..34]).map(|&count| f64::from(count)).sum::<f64>() / counts.len() as f64
}

#[test]
fn lights_that_nobody_sees_get_the_floor_and_what_is_left_of_a_prior() {
    let stage = stage_with(courtyard(), LeaveOut::No, Offset::SCALED);
    let by_weight = hidden_picks(TREE, &stage);
    let found = [0.001, 0.25, 0.5, 1.0].map(|floor| {
        let found = hidden_picks(&format!("visible:cell=3,floor={floor},probes=256,picks=1"), &stage) / by_weight;
        println!("floor {floor}: {found} of the picks that weights alone give them");
        assert!(found > 0.8 * floor, "{found} of {floor}");
        found
    });
    assert!(found.is_sorted() && found[0] < 0.5 && (found[3] - 1.0).abs() < 0.1, "{found:?}");
}

#[test]
fn receivers_too_few_for_a_cell_share_a_larger_one_or_take_the_tree() {
    let stage = stage(courtyard());
    let all = stage.receivers().len();
    assert_eq!(
        bits(&image(&format!("visible:cell=1,least={},picks=1", all + 1), &stage, 2)),
        bits(&image(TREE, &stage, 2)),
        "no cell holds more receivers than there are"
    );
    let bytes = |name: &str| {
        let sampler = sampler(name, &stage);
        let mut counts = vec![0.0; stage.scene().lights().len()];
        stage.receivers().iter().for_each(|at| assert!(sampler.expected_counts(at, &mut counts)));
        sampler.heap_bytes()
    };
    let [each, shared, tree] = ["visible:cell=1,least=1", "visible:cell=1,least=64", TREE].map(bytes);
    println!("{each} bytes with a table however few, {shared} where 64 share one, {tree} without");
    assert!(shared < each && shared > tree);
    assert_kept("visible:cell=1,least=64", &stage);
}

#[test]
fn it_is_unbiased_whatever_the_cells_and_the_tables() {
    let stage = stage(courtyard());
    for name in [
        "visible",
        "visible:cell=0.01",
        "visible:cell=1,probes=1,cut=1",
        "visible:cell=100000,floor=0.001",
        "visible:cell=3,floor=1,points=random",
        "visible:cell=3,picks=4,points=sobol",
        "visible:memory=0",
    ] {
        assert_kept(name, &stage);
    }
}

#[test]
fn a_cluster_of_near_and_far_lights_is_no_trap() {
    let mut parts = courtyard();
    parts.lights.push(point(Vec3::new(3e12, 0.0, 1e12), 1e27));
    parts.lights.push(point(Vec3::new(-2e10, 1e10, 1e9), 1e22));
    let stage = stage_with(parts, LeaveOut::No, Offset::SCALED);
    for name in ["visible:cell=4,least=1,cut=1,picks=1", "visible:cell=4,least=8,cut=24,probes=16,picks=1"] {
        for (counts, at) in expected(name, &stage).iter().zip(stage.receivers().iter().step_by(29)) {
            let sum: f64 = counts.iter().map(|&count| f64::from(count)).sum();
            assert!((sum - 1.0).abs() < 1e-4, "{name}: {sum} picks at {}", at.position);
        }
        assert_kept(name, &stage);
    }
}

#[test]
fn what_is_learned_lowers_the_error() {
    let stage = stage(courtyard());
    let [tree, learned] = [TREE, "visible:cell=3,picks=1"].map(|name| Runs::new(name, &stage, 8, 4).mse());
    println!("MSE {tree:.3e} by the tree, {learned:.3e} by what is seen");
    assert!(learned < 0.5 * tree, "{learned} and {tree}");
}

#[test]
fn tables_are_the_same_whoever_makes_them() {
    let stage = stage(courtyard());
    for name in ["visible:cell=2", "visible:cell=0.2"] {
        let made_in_order = bits(&image(name, &stage, 4));
        for threads in [1, 2, 3] {
            let sampler = sampler(name, &stage);
            // The last receiver first: its cell is learned before all others.
            assert!(sampler.expected_counts(&stage.receivers()[stage.receivers().len() - 1], &mut [0.0; 64]));
            let mut film = Film::new(stage.receivers().len());
            let plan = Plan {
                stage: &stage,
                receivers: stage.receivers(),
                sampler: &*sampler,
                key: RunKey { seed: 1, run: 0 },
            };
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| plan.run_parallel(4, &mut film));
            assert_eq!(bits(&film.image()), made_in_order, "{name} on {threads} threads");
        }
    }
    let strategy = Registry::standard().parse("visible:cell=2").expect("a strategy");
    let counts = |seed| {
        let sampler = strategy.build(BuildContext { stage: &stage, seed }).expect("a sampler");
        let mut counts = [0.0; 64];
        assert!(sampler.expected_counts(&stage.receivers()[100], &mut counts));
        counts
    };
    assert_eq!(counts(5), counts(5));
    assert_ne!(counts(5), counts(6), "probes do not depend on the seed");
}

#[test]
fn a_receiver_that_nobody_knew_of_is_served() {
    let stage = stage(courtyard());
    let at = receiver(Vec3::new(500.0, 3.0, 7.0), Vec3::X);
    let name = "visible:cell=2,picks=1";
    for at in [at, receiver(Vec3::new(1.0, 5.0, 0.0), Vec3::NEG_Y)] {
        let mut counts = vec![0.0; stage.scene().lights().len()];
        let mut by_tree = counts.clone();
        assert!(sampler(name, &stage).expected_counts(&at, &mut counts));
        assert!(sampler(TREE, &stage).expected_counts(&at, &mut by_tree));
        assert_eq!(counts, by_tree);
    }
}

#[test]
fn without_memory_or_need_it_is_the_tree() {
    let one = || {
        let mut parts = ground(12.0, vec![point(Vec3::new(0.0, 0.0, 4.0), 100.0)]);
        parts.surfaces.extend(cuboid(Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 2.0, 3.0)));
        parts
    };
    let open = || ground(12.0, (0..9).map(|i| point(Vec3::new(i as f32 - 4.0, 0.0, 4.0), 100.0)).collect());
    for (what, name, tree, parts) in [
        ("no memory", "visible:memory=0,picks=1", TREE, courtyard()),
        ("one light", "visible:picks=1", "light-tree", one()),
        ("nothing in between", "visible:picks=1", "light-tree", open()),
        ("no light", "visible:picks=1", "light-tree", ground(12.0, Vec::new())),
    ] {
        let stage = stage(parts);
        assert_eq!(bits(&image(name, &stage, 3)), bits(&image(tree, &stage, 3)), "{what}");
        assert!(sampler(name, &stage).heap_bytes() <= sampler(tree, &stage).heap_bytes(), "{what}");
    }
}

#[test]
fn memory_is_bounded_and_what_is_left_out_does_not_depend_on_threads() {
    use citylights::sources::Overrides;
    use citylights::sources::recipe::load;
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
    let stage = Stage::new(load(&path, &Overrides::default()).expect("a scene"), LeaveOut::Yes, Offset::SCALED);
    let tree = sampler(TREE, &stage).heap_bytes();
    let film = |name: &str, threads: usize| {
        let sampler = sampler(name, &stage);
        let mut film = Film::new(stage.receivers().len());
        let plan =
            Plan { stage: &stage, receivers: stage.receivers(), sampler: &*sampler, key: RunKey { seed: 1, run: 0 } };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| plan.run_parallel(1, &mut film));
        (bits(&film.image()), sampler.heap_bytes() - tree)
    };
    let (some, bytes) = film("visible:cell=0.5,least=1,cut=96,memory=1,probes=1", 1);
    let (all, more) = film("visible:cell=0.5,least=1,cut=96,memory=64,probes=1", 1);
    println!("{bytes} bytes of tables, {more} without a bound");
    assert!(bytes <= 1_000_000 && bytes > 300_000 && more > 1_500_000, "{bytes} and {more}");
    assert_ne!(some, all);
    assert_eq!(some, film("visible:cell=0.5,least=1,cut=96,memory=1,probes=1", 2).0);
    // Receivers of a cell that did not fit may be in a larger one, which then counts them.
    let (some, bytes) = film("visible:cell=0.1,least=2,cut=512,memory=1,probes=1", 1);
    assert!(bytes <= 1_000_000, "{bytes} bytes");
    assert_eq!(some, film("visible:cell=0.1,least=2,cut=512,memory=1,probes=1", 2).0);
}

#[test]
fn impossible_parameters_are_refused_with_what_is_allowed() {
    let message =
        |text: &str| Registry::standard().parse(text).err().map(|error| error.to_string()).unwrap_or_default();
    for (text, allowed) in [
        ("visible:cell=0", "0.01 to 100000"),
        ("visible:cell=-3", "0.01 to 100000"),
        ("visible:cell=NaN", "0.01 to 100000"),
        ("visible:least=0", "1 to 65536"),
        ("visible:cut=0", "1 to 4096"),
        ("visible:probes=0", "1 to 256"),
        ("visible:floor=0", "0.001 to 1"),
        ("visible:floor=1.5", "0.001 to 1"),
        ("visible:picks=1025", "0 to 1024"),
        ("visible:memory=-1", "0 to 65536"),
    ] {
        assert!(message(text).contains(allowed), "{text}: {}", message(text));
    }
    assert!(message("visible:cells=3").contains("cell"));
}
