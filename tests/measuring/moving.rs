//! What passes visit where receivers move, and the truth and the errors there, against arithmetic of this file: f64, every
//! light, every triangle.

use crate::promises::common::{cuboid, ground, lambert, moon, panel, point, sixteen, spot};
use citylights::base::random::RunKey;
use citylights::measure::clock::Cpu;
use citylights::measure::engine::{Block, Engine};
use citylights::measure::errors::Truth;
use citylights::measure::observer::Unobserved;
use citylights::measure::reference::{Reference, Wanted};
use citylights::measure::target::Target;
use citylights::scene::light::{Light, Shape};
use citylights::scene::receiver::Receiver;
use citylights::scene::{Parts, Scene};
use citylights::strategy::Registry;
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use citylights::visibility::visits::Receivers;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

const MOVING: [Receivers; 2] = [Receivers::Spread, Receivers::Bounce];

fn stage(parts: Parts, receivers: Receivers) -> Stage {
    Stage::visiting(Scene::new(parts).expect("a scene"), LeaveOut::Yes, Offset::SCALED, receivers)
}

/// Boxes on a ground, lit by a lamp, a spot and the moon.
fn boxes() -> Parts {
    let lights = vec![
        point(Vec3::new(1.0, 6.0, 5.0), 200.0),
        Shape::Point { position: Vec3::new(-6.0, 2.0, 4.0), intensity: Vec3::new(200.0, 90.0, 20.0) },
        spot(Vec3::new(0.0, 0.0, 7.0), Vec3::new(0.2, 0.1, -1.0), 500.0),
        moon(Vec3::new(0.3, -0.5, 0.8), 2.0),
    ];
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-4.5, -2.0, 0.0), Vec3::new(-2.5, 1.0, 3.0)));
    parts.surfaces.extend(cuboid(Vec3::new(1.5, 3.0, 0.0), Vec3::new(5.0, 5.0, 2.5)));
    parts
}

/// Whether a straight way meets a triangle of the scene, ends left out.
fn blocked(scene: &Scene, from: DVec3, to: DVec3, but: u32) -> bool {
    let way = to - from;
    scene.surfaces().iter().zip(0..).filter(|(_, i)| *i != but).any(|(surface, _)| {
        let [p, q, r] = surface.corners.map(Vec3::as_dvec3);
        let normal = (q - p).cross(r - p);
        let t = normal.dot(p - from) / normal.dot(way);
        let place = from + way * t;
        let inside = [(p, q), (q, r), (r, p)].iter().all(|&(a, b)| (b - a).cross(place - a).dot(normal) >= 0.0);
        t > 1e-6 && t < 1.0 - 1e-6 && inside
    })
}

/// What a light without extent adds at a receiver, in cd/m^2.
fn adds(scene: &Scene, light: &Light, at: &Receiver) -> DVec3 {
    let (x, n) = (at.position.as_dvec3(), at.normal.as_dvec3());
    let (towards, irradiance, end) = match light.shape() {
        Shape::Directional { towards, irradiance } => {
            let towards = towards.as_dvec3().normalize();
            (towards, irradiance.as_dvec3(), x + towards * 1e3)
        }
        Shape::Point { position, intensity } => {
            let to = position.as_dvec3() - x;
            (to.normalize(), intensity.as_dvec3() / to.length_squared(), position.as_dvec3())
        }
        Shape::Spot { position, axis, intensity, cos_inner, cos_outer } => {
            let to = position.as_dvec3() - x;
            let (inner, outer) = (f64::from(cos_inner), f64::from(cos_outer));
            let ramp = ((-to.normalize().dot(axis.as_dvec3()) - outer) / (inner - outer)).clamp(0.0, 1.0);
            (to.normalize(), intensity.as_dvec3() * ramp * ramp / to.length_squared(), position.as_dvec3())
        }
        Shape::Triangle { .. } => unreachable!("lights without extent"),
    };
    let cosine = n.dot(towards);
    if cosine <= 0.0 || blocked(scene, x + n * 1e-6, end, at.surface) {
        return DVec3::ZERO;
    }
    at.albedo.as_dvec3() / PI * irradiance * cosine
}

fn truth<'a>(target: &Target<'a>, own_rel_mse: f64) -> Truth {
    let cache = tempfile::tempdir().expect("a folder");
    let wanted = Wanted { work_s: 1e9, ..Wanted::new(own_rel_mse) };
    let (kept, reference) = Reference::bounded(target, wanted, cache.path(), &Unobserved).expect("a reference");
    assert_eq!(kept.places, target.places);
    reference.truth
}

/// The mean over the first passes of what `at_receiver` says of those that are visited; `shift` passes later.
fn mean(target: &Target<'_>, passes: u32, shift: u32, at_receiver: impl Fn(&Receiver) -> DVec3) -> Vec<DVec3> {
    let of = |&place: &usize| {
        let visited = |pass| target.stage.visited(&target.frame[place], pass + shift);
        (0..passes).filter_map(visited).map(|at| at_receiver(&at)).sum::<DVec3>() / f64::from(passes)
    };
    target.places.iter().map(of).collect()
}

/// Greatest difference as a share of the radiance there, or of the mean radiance where that is more.
fn apart(truth: &Truth, wanted: &[DVec3]) -> f64 {
    let scale = wanted.iter().copied().sum::<DVec3>() / wanted.len() as f64;
    let off = |(a, b): (&Vec3, &DVec3)| ((a.as_dvec3() - b).abs() / b.max(scale)).max_element();
    truth.mean().iter().zip(wanted).map(off).fold(0.0, f64::max)
}

#[test]
fn the_truth_is_the_sum_over_all_lights_at_the_very_receivers_of_each_pass() {
    for receivers in MOVING {
        let stage = stage(boxes(), receivers);
        let target = Target::whole(&stage).after([1, 16]);
        let visited = target.visited().len();
        assert!(visited >= 200, "{}: {visited} receivers", receivers.name());
        let found = truth(&target, 1e-8);
        let sum = |at: &Receiver| {
            let scene = stage.scene();
            scene.lights().iter().map(|light| adds(scene, light, at)).sum()
        };
        for passes in [1, 16] {
            let found = found.after(passes);
            let off = apart(found, &mean(&target, passes, 0, sum));
            println!("{}: {visited} receivers, {passes} passes: {off:.1e} of the mean apart", receivers.name());
            assert!(off < 1e-6, "{}: {off}", receivers.name());
            let beside = apart(found, &mean(&target, passes, 1, sum));
            assert!(beside > 1e-3, "{}: the receivers of other passes have the same sum: {beside}", receivers.name());
        }
        assert_eq!(found.own_rel_mse(), 0.0);
    }
}

#[test]
fn the_truth_under_triangles_is_off_by_what_it_says() {
    // Nothing stands in between: Lambert's formula is the answer.
    let mut parts = ground(12.0, panel(Vec3::new(-1.0, -1.0, 3.5), Vec3::Y * 2.0, Vec3::X * 3.0, 400.0).to_vec());
    let [a, b, c, d] =
        [[-12.0, 12.0, 0.0], [12.0, 12.0, 0.0], [12.0, 12.0, 3.0], [-12.0, 12.0, 3.0]].map(Vec3::from_array);
    for corners in [[a, b, c], [a, c, d]] {
        parts.surfaces.push(citylights::scene::Surface { corners, material: 0 });
    }
    for receivers in MOVING {
        let stage = stage(parts.clone(), receivers);
        let target = Target::whole(&stage).thinned(128).after([16]);
        let found = truth(&target, 1e-6);
        let exact = |at: &Receiver| {
            let from = |light: &Light| {
                let clear = light.corners().into_iter().all(|corner| at.normal.dot(corner - at.position) > 0.0);
                let front = light.c.dot(at.position - light.position) > 0.0;
                let value = if clear && front { lambert(light.corners(), at.position, at.normal) } else { 0.0 };
                light.colour.as_dvec3() * at.albedo.as_dvec3() / PI * value
            };
            stage.scene().lights().iter().map(from).sum()
        };
        let wanted = mean(&target, 16, 0, exact);
        let square = |i: usize| (found.mean()[i].as_dvec3() - wanted[i]).powf(2.0) * found.weight(i);
        let (off, own) = (found.mean_over(square), found.own_rel_mse());
        println!("{}: relMSE {off:.1e}, and {own:.1e} by its own halves", receivers.name());
        assert!(off > 0.0 && off < 2.0 * own && own < 1e-6, "{}: {off} and {own}", receivers.name());
    }
}

#[test]
fn errors_of_a_strategy_of_known_variance_are_that_variance() {
    const PASSES: u32 = 4;
    const RUNS: u32 = 300;
    let strategy = Registry::standard().parse("uniform:points=random").expect("a strategy");
    for receivers in MOVING {
        let stage = stage(boxes(), receivers);
        let target = Target::whole(&stage).after([PASSES]);
        let truth = truth(&target, 1e-8);
        let truth = truth.after(PASSES);
        let lights = stage.scene().lights();
        // One of n lights with the chance 1/n: the variance of a call is n sum f^2 - (sum f)^2.
        let variance = |at: &Receiver| {
            let each: Vec<DVec3> = lights.iter().map(|light| adds(stage.scene(), light, at)).collect();
            let sum: DVec3 = each.iter().sum();
            each.iter().map(|f| f * f).sum::<DVec3>() * lights.len() as f64 - sum * sum
        };
        let variances = mean(&target, PASSES, 0, variance);
        let wanted = truth.mean_over(|i| variances[i] / f64::from(PASSES) * truth.weight(i));
        let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
        let errors = engine
            .alone(|meter| {
                let error = |run| {
                    let key = RunKey { seed: 3, run };
                    let block =
                        Block { stage: &stage, receivers: &target.frame, strategy: &strategy, key, passes: PASSES };
                    truth.errors(&target.at_places(&block.run(meter).expect("an image").image)).rel_mse
                };
                (0..RUNS).map(error).collect::<Vec<f64>>()
            })
            .expect("a pool");
        let found = errors.iter().sum::<f64>() / f64::from(RUNS);
        println!("{}: relMSE {found:.5}, by the known variance {wanted:.5}", receivers.name());
        assert!((found / wanted - 1.0).abs() < 0.02, "{}: {found} for {wanted}", receivers.name());
    }
}

#[test]
fn a_bounce_that_leaves_the_scene_has_no_light_and_no_error() {
    let stage = stage(ground(12.0, vec![point(Vec3::new(1.0, 6.0, 5.0), 200.0)]), Receivers::Bounce);
    assert!(!stage.receivers().is_empty());
    assert!(stage.receivers().iter().all(|at| (0..8).all(|pass| stage.visited(at, pass).is_none())));
    let target = Target::whole(&stage).after([8]);
    let truth = truth(&target, 1e-8);
    let strategy = Registry::standard().parse("uniform").expect("a strategy");
    let engine = Engine { clock: &Cpu::new(), workers: 1, seed: 1 };
    let key = RunKey { seed: 3, run: 0 };
    let block = Block { stage: &stage, receivers: &target.frame, strategy: &strategy, key, passes: 8 };
    let done = engine.alone(|meter| block.run(meter)).expect("a pool").expect("an image");
    assert!(done.image.iter().all(|&radiance| radiance == Vec3::ZERO));
    assert_eq!(truth.after(8).errors(&done.image).rel_mse, 0.0);
}

#[test]
fn nothing_is_left_out_for_receivers_that_are_not_known_yet() {
    // The lamp under the camera's side of a wall lights what no pixel sees, and what bounces find.
    let lights = |receivers| stage(sixteen(), receivers).lights().len();
    assert_eq!(lights(Receivers::Bounce), 16);
    assert!(lights(Receivers::Centre) <= 16);
}
