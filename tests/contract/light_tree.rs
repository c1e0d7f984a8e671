//! The light tree: no light lost, probabilities exact, degenerate sets of lights, the same tree on any number of
//! threads.

use crate::promises::common::{
    expected, ground, image, moon, on_sphere, panel, point, receiver, sampler, sixteen, spot, stage, stage_with,
};
use citylights::base::colour::luminance;
use citylights::base::random::{RunKey, Stream};
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::Scene;
use citylights::scene::light::{LightId, Shape};
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::shading::contribution::contribution;
use citylights::strategy::Registry;
use citylights::tree::{How, Tree};
use citylights::verify::{Verifier, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;

/// Every way to weigh and walk that the tree has.
const WAYS: [&str; 15] = [
    "light-tree",
    "light-tree:open=0",
    "light-tree:arity=2,open=0",
    "light-tree:arity=2",
    "light-tree:arity=4",
    "light-tree:importance=classic",
    "light-tree:arity=2,importance=classic",
    "light-tree:distance=minmax",
    "light-tree:facing=rms",
    "light-tree:importance=classic,distance=minmax",
    "light-tree:split=0.5",
    "light-tree:split=0.95,cut=64",
    "light-tree:picks=3",
    "stochastic-lightcuts",
    "stochastic-lightcuts:cut=2",
];

/// Lights of all kinds in clusters, on walls and in rows, over 200 m; strengths over six orders of magnitude.
fn many(count: usize, seed: u64) -> Vec<Shape> {
    let mut rng = Stream::keyed(&[seed]);
    let mut lights = Vec::new();
    while lights.len() < count {
        let at = Vec3::new(rng.uniform() * 200.0 - 100.0, rng.uniform() * 200.0 - 100.0, rng.uniform() * 30.0);
        let strength = 10f32.powf(rng.uniform() * 6.0 - 2.0);
        match rng.below(5) {
            0 => lights.push(point(at, strength)),
            1 => {
                let (axis, inner) = (on_sphere(&mut rng), 0.2 + 0.79 * rng.uniform());
                lights.push(Shape::Spot {
                    position: at,
                    axis,
                    intensity: Vec3::splat(strength),
                    cos_inner: inner,
                    cos_outer: inner * rng.uniform(),
                });
            }
            2 => {
                let edges = [on_sphere(&mut rng), on_sphere(&mut rng)].map(|edge| edge * (0.1 + 3.0 * rng.uniform()));
                lights.extend(panel(at, edges[0], edges[1], strength));
            }
            // Windows of one wall.
            3 => {
                let (along, turned) = if rng.below(2) == 0 { (Vec3::X, Vec3::Z) } else { (Vec3::Z, Vec3::Y) };
                for i in 0..6 {
                    lights.extend(panel(at + along * (3.0 * i as f32), along, turned * 1.5, strength));
                }
            }
            _ => (0..5).for_each(|i| lights.push(spot(at + Vec3::Y * (20.0 * i as f32), Vec3::NEG_Z, strength))),
        }
    }
    lights
}

/// Receivers where weights are hardest to get right: on lights, at the same height, a hair off a wall, among the
/// lights.
fn hard_receivers(lights: &[Shape], count: usize) -> Vec<Receiver> {
    let mut rng = Stream::keyed(&[4]);
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    (0..count)
        .map(|i| {
            let near = match lights[rng.below(lights.len())] {
                Shape::Point { position, .. } | Shape::Spot { position, .. } => position,
                Shape::Triangle { corners, .. } => corners[rng.below(3)],
                Shape::Directional { .. } => Vec3::ZERO,
            };
            let normal = if rng.below(2) == 0 { axes[rng.below(6)] } else { on_sphere(&mut rng) };
            let away = [0.0, 1e-4, 0.1, 3.0, 60.0][i % 5];
            receiver(near + on_sphere(&mut rng) * away, normal)
        })
        .collect()
}

/// Whether a light adds anything from any of its points tried.
fn adds(scene: &Scene, light: LightId, at: &Receiver) -> bool {
    let points = [[0.0, 0.0], [0.999, 0.001], [0.999, 0.999], [0.44, 0.5], [0.999, 0.5], [0.3, 0.01], [0.3, 0.99]];
    points
        .iter()
        .any(|&uv| contribution::<0b1111>(LightSampling::Area, &scene.lights()[light as usize], uv, at).is_ok())
}

fn everything(lights: Vec<Shape>) -> Stage {
    stage_with(ground(150.0, lights), LeaveOut::No, Offset::SCALED)
}

#[test]
fn every_light_that_adds_something_can_be_chosen() {
    let mut lights = many(1_500, 7);
    lights.push(moon(Vec3::new(0.3, -0.5, 0.8), 0.01));
    let receivers = hard_receivers(&lights, 150);
    let stage = everything(lights);
    let scene = stage.scene();
    let (mut adding, mut pairs) = (0, 0);
    for way in WAYS {
        for at in &receivers {
            let counts = expected(way, &stage, at);
            for (light, count) in (0..).zip(&counts) {
                assert!(count.is_finite() && *count >= 0.0, "{way}: light {light} counts {count}");
                pairs += 1;
                if adds(scene, light, at) {
                    adding += 1;
                    assert!(*count > 0.0, "{way}: light {light} adds something at {at:?} and has no chance");
                }
            }
        }
    }
    assert!(adding > pairs / 20, "{adding} of {pairs} pairs add something: too few to prove anything");
}

#[test]
fn the_probabilities_are_those_of_one_pick_or_less() {
    let lights = many(700, 3);
    let receivers = hard_receivers(&lights, 100);
    let stage = everything(lights);
    let many = ["split", "picks", "stochastic"];
    for way in WAYS.iter().filter(|way| !many.iter().any(|word| way.contains(word))) {
        let mut lost = 0.0;
        for at in &receivers {
            let sum: f64 = expected(way, &stage, at).iter().map(|&p| f64::from(p)).sum();
            assert!(sum < 1.0 + 1e-5, "{way}: probabilities sum to {sum} at {at:?}");
            lost += 1.0 - sum;
        }
        let lost = lost / receivers.len() as f64;
        // What ends where nothing adds anything; bounds of twice the size would lose far more.
        assert!(lost < 0.35, "{way}: {lost} of the picks end in nothing");
    }
}

#[test]
fn a_receiver_in_the_open_loses_no_pick() {
    let lights: Vec<Shape> = (0..500).map(|i| point(Vec3::new((i % 25) as f32, (i / 25) as f32, 5.0), 3.0)).collect();
    let stage = everything(lights);
    for way in ["light-tree", "light-tree:arity=2", "light-tree:distance=minmax"] {
        let sum: f32 = expected(way, &stage, &receiver(Vec3::new(3.0, 4.0, 0.0), Vec3::Z)).iter().sum();
        assert!((sum - 1.0).abs() < 1e-5, "{way}: {sum}");
    }
}

/// Sets of lights that a build may trip over, by name.
fn degenerate() -> Vec<(&'static str, Vec<Shape>)> {
    let here = Vec3::new(1.0, 2.0, 3.0);
    let row = |i: usize| point(Vec3::new(0.0, i as f32 * 30.0 - 4_000.0, 8.0), 100.0);
    vec![
        ("none", vec![]),
        ("one", vec![point(here, 1.0)]),
        ("two", vec![point(here, 1.0), point(here + Vec3::X, 1.0)]),
        ("three", (0..3).map(|i| point(here + Vec3::X * i as f32, 1.0)).collect()),
        ("nine", (0..9).map(|i| point(here + Vec3::X * i as f32, 1.0)).collect()),
        ("all in one place", vec![point(here, 1.0); 5_000]),
        ("two places", (0..5_000).map(|i| point(here + Vec3::X * (i % 2) as f32, 1.0)).collect()),
        ("a straight row", (0..1_000).map(row).collect()),
        ("black", vec![point(here, 0.0); 10]),
        ("one of many black", (0..100).map(|i| point(here, (i == 57) as u8 as f32)).collect()),
        (
            "one far stronger",
            (0..1_000).map(|i| point(here + Vec3::X * i as f32, [1e-3, 1e9][(i == 3) as usize])).collect(),
        ),
        ("each stronger than the next", {
            let strength = |i: usize| 10f32.powf(18.0 - 0.05 * i as f32);
            (0..700).map(|i| point(here + Vec3::X * i as f32 * 0.1, strength(i))).collect()
        }),
        ("each farther than the next", { (0..120).map(|i| point(here + Vec3::X * 1.2f32.powi(i), 1.0)).collect() }),
        ("below the ground", (0..50).map(|i| point(Vec3::new(i as f32, 0.0, -3.0), 1.0)).collect()),
        ("the moon alone", vec![moon(Vec3::Z, 0.3)]),
        ("moons", (0..20).map(|i| moon(Vec3::new(0.1 * i as f32 - 1.0, 0.0, 0.5), 10f32.powi(i - 10))).collect()),
        ("the moon and a lamp", vec![moon(Vec3::Z, 0.3), point(here, 1e-6)]),
        ("as strong as f32 allows", vec![point(here, 3e38), point(here + Vec3::X, 3e38), point(here + Vec3::Y, 1e-38)]),
    ]
}

#[test]
fn degenerate_sets_of_lights_keep_every_light() {
    for (name, lights) in degenerate() {
        let stage = everything(lights.clone());
        let mut receivers = vec![receiver(Vec3::new(0.5, 0.5, 0.0), Vec3::Z), receiver(Vec3::ZERO, Vec3::NEG_Z)];
        if !lights.is_empty() {
            receivers.extend(hard_receivers(&lights, 5));
        }
        for way in WAYS {
            for at in &receivers {
                let counts = expected(way, &stage, at);
                for (light, count) in (0..).zip(&counts) {
                    assert!(count.is_finite(), "{name}, {way}: light {light} counts {count}");
                    let lost = adds(stage.scene(), light, at) && *count <= 0.0;
                    assert!(!lost, "{name}, {way}: light {light} adds something at {at:?} and has no chance");
                }
            }
        }
    }
}

fn tree(scene: &Scene) -> Tree<8> {
    let lights: Vec<LightId> = (0..scene.lights().len() as LightId).collect();
    Tree::new(scene, &lights, How::default())
}

#[test]
fn no_set_of_lights_makes_the_tree_deep() {
    for (name, lights) in degenerate() {
        let stage = everything(lights);
        let (wide, ids) = (tree(stage.scene()), (0..stage.scene().lights().len() as LightId).collect::<Vec<_>>());
        let narrow = Tree::<2>::new(stage.scene(), &ids, How::default());
        assert!(wide.depth() <= 60 && narrow.depth() <= 60, "{name}: {} and {}", wide.depth(), narrow.depth());
    }
    // Where nothing tells lights apart they are halved: 5,000 lights, 13 levels of two.
    let stage = everything(vec![point(Vec3::Z, 1.0); 5_000]);
    assert!(tree(stage.scene()).depth() <= 6, "{}", tree(stage.scene()).depth());
}

#[test]
fn black_lights_are_not_in_the_tree() {
    let stage = everything(vec![point(Vec3::Z, 0.0), point(Vec3::Z, 1.0), moon(Vec3::Z, 1.0)]);
    assert_eq!(tree(stage.scene()).len(), 1);
}

#[test]
fn a_row_of_lamps_is_split_along_it() {
    // Shuffled: halved by their place in the table, each half would reach from end to end.
    let lamp = |i: usize| point(Vec3::new(((i * 367) % 1_000) as f32 * 10.0 - 5_000.0, 0.0, 8.0), 100.0);
    let stage = everything((0..1_000).map(lamp).collect());
    let at = receiver(Vec3::new(2.0, 3.0, 0.0), Vec3::Z);
    let counts = expected("light-tree", &stage, &at);
    let near: f32 =
        (0..1_000).filter(|&i| (((i * 367) % 1_000) as f32 * 10.0 - 5_000.0).abs() < 30.0).map(|i| counts[i]).sum();
    assert!(near > 0.8, "the lamps within 30 m get {near}; of the light they are 0.97");
}

#[test]
fn one_thread_and_two_build_the_same_tree() {
    let stage = everything(many(20_000, 9));
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| tree(stage.scene()))
    };
    let (one, two) = (build(1), build(2));
    assert_eq!(one.heap_bytes(), two.heap_bytes());
    for at in hard_receivers(&many(100, 9), 10) {
        let counts = |tree: &Tree<8>| {
            let mut counts = vec![0.0f32; stage.scene().lights().len()];
            tree.expect(&at, 1.0, &mut counts);
            counts.iter().map(|count| count.to_bits()).collect::<Vec<_>>()
        };
        assert!(counts(&one) == counts(&two), "the tree of two threads differs");
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let lights = many(3_000, 5);
    let stage = everything(lights.clone());
    let receivers = hard_receivers(&lights, 20);
    for scale in [0.01, 100.0] {
        let scaled: Vec<Shape> = lights.iter().map(|light| scaled(light, scale)).collect();
        let other = stage_with(ground(150.0 * scale, scaled), LeaveOut::No, Offset::SCALED);
        for way in ["light-tree", "light-tree:arity=2,importance=classic", "light-tree:split=0.5"] {
            let (mut apart, mut pairs) = (0, 0);
            for at in &receivers {
                let there = Receiver { position: at.position * scale, ..*at };
                for (a, b) in expected(way, &stage, at).iter().zip(&expected(way, &other, &there)) {
                    pairs += 1;
                    apart += usize::from((a - b).abs() > 1e-2 * a.max(*b) + 1e-6);
                }
            }
            assert!(apart * 1_000 < pairs, "{way}, times {scale}: {apart} of {pairs} probabilities differ");
        }
    }
}

/// The light in another unit of length: intensities and areas grow with its square.
fn scaled(light: &Shape, by: f32) -> Shape {
    match *light {
        Shape::Point { position, intensity } => {
            Shape::Point { position: position * by, intensity: intensity * by * by }
        }
        Shape::Spot { position, axis, intensity, cos_inner, cos_outer } => {
            Shape::Spot { position: position * by, axis, intensity: intensity * by * by, cos_inner, cos_outer }
        }
        Shape::Triangle { corners, radiance } => Shape::Triangle { corners: corners.map(|c| c * by), radiance },
        directional @ Shape::Directional { .. } => directional,
    }
}

#[test]
fn a_light_takes_128_bytes_or_less() {
    let stage = everything(many(10_000, 2));
    let scene = stage.scene();
    let lights: Vec<LightId> = (0..scene.lights().len() as LightId).collect();
    fn bytes<const N: usize>(scene: &Scene, lights: &[LightId]) -> f64 {
        let tree = Tree::<N>::new(scene, lights, How::default());
        tree.heap_bytes() as f64 / tree.len() as f64
    }
    for (arity, bytes) in
        [(2, bytes::<2>(scene, &lights)), (4, bytes::<4>(scene, &lights)), (8, bytes::<8>(scene, &lights))]
    {
        assert!(bytes <= 128.0, "{bytes} bytes a light at arity {arity}");
    }
}

#[test]
fn all_kinds_of_light_are_in_proportion() {
    let stage = everything(sixteen().lights);
    let at = receiver(Vec3::new(0.0, 1.0, 0.0), Vec3::Z);
    let (tree, exact) = (expected("light-tree", &stage, &at), expected("intensity", &stage, &at));
    for (light, (a, b)) in tree.iter().zip(&exact).enumerate() {
        assert!((a - b).abs() < 0.15, "light {light}: {a} by the tree, {b} by its irradiance");
    }
}

#[test]
fn every_way_keeps_the_contract() {
    let stage = stage(sixteen());
    let verifier = Verifier::new(&stage, VerifyOptions { receivers: 12, draws: 4_000, ..VerifyOptions::default() });
    for way in WAYS {
        for check in verifier.verify(&Registry::standard().parse(way).expect(way)).expect(way) {
            assert!(check.passed, "{way}: {check}");
        }
    }
}

/// Points of two colours over a ground with boxes.
fn lamps() -> Stage {
    let mut parts = sixteen();
    parts.lights = (0..300)
        .map(|i| {
            let at = Vec3::new((i % 20) as f32 - 10.0, (i / 20) as f32 * 1.4 - 10.0, 4.0 + (i % 7) as f32);
            Shape::Point { position: at, intensity: [Vec3::new(9.0, 5.0, 2.0), Vec3::new(2.0, 5.0, 9.0)][i % 2] }
        })
        .collect();
    stage(parts)
}

#[test]
fn lightcuts_without_error_are_the_sum_of_all_lights() {
    let stage = lamps();
    let (exact, cut) = (image("all", &stage, 1), image("lightcuts:error=0,cut=100000", &stage, 1));
    for (a, b) in exact.iter().zip(&cut) {
        assert!((*a - *b).abs().max_element() <= 1e-4 * a.max_element(), "{a} by all, {b} by the cut");
    }
}

#[test]
fn lightcuts_err_by_about_their_bound() {
    let stage = lamps();
    let exact = image("all", &stage, 1);
    let mean_error = |way: &str| {
        let errors = image(way, &stage, 1).into_iter().zip(&exact).map(|(a, b)| {
            let (a, b) = (f64::from(luminance(a)), f64::from(luminance(*b)));
            (a - b).abs() / b.max(1e-9)
        });
        errors.sum::<f64>() / exact.len() as f64
    };
    let (coarse, fine) = (mean_error("lightcuts:error=0.2"), mean_error("lightcuts"));
    // Each cluster may err by 0.02 of the whole; they are many, but neither all at their bounds nor all on one side.
    assert!(fine > 0.0 && fine < 0.04, "a mean error of {fine}");
    assert!(coarse > 1.5 * fine, "{coarse} with ten times the bound, {fine} without");
}

#[test]
fn lightcuts_are_without_noise() {
    let stage = lamps();
    let (one, many) = (image("lightcuts", &stage, 1), image("lightcuts", &stage, 3));
    assert!(one.iter().zip(&many).all(|(a, b)| (*a - *b).abs().max_element() <= 1e-6 * a.max_element()));
}

#[test]
fn what_is_doubly_dark_costs_lightcuts_nothing() {
    // A wall of windows behind the receiver's horizon, turned away from it too, and one lamp in front.
    let window = |i: i32| {
        let corner = Vec3::new((i % 20) as f32 - 10.0, -0.5, (i / 20) as f32 * 0.5);
        panel(corner, Vec3::X * 0.3, Vec3::Z * 0.3, 100.0)
    };
    let mut lights: Vec<Shape> = (0..300).flat_map(window).collect();
    lights.push(point(Vec3::new(0.0, 3.0, 4.0), 50.0));
    let stage = stage_with(ground(12.0, lights), LeaveOut::No, Offset::SCALED);
    let at = [receiver(Vec3::new(0.0, 0.0, 2.0), Vec3::Y)];
    let sampler = sampler("lightcuts:error=0", &stage);
    let plan = Plan { stage: &stage, receivers: &at, sampler: &*sampler, key: RunKey { seed: 1, run: 0 } };
    let nodes = plan.run_counting(1, &mut Film::new(1)).nodes;
    // The way to the lamp, and nothing beside it, of 600 nodes.
    assert!(nodes < 40, "{nodes} nodes were opened: clusters that add nothing were refined");
}
