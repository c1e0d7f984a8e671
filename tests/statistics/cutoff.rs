//! The bias of finite lights: its closed form, its repair, and the test that it fails.

use crate::promises::common::{ALBEDO, expected, ground, point, receiver, sampler, sixteen, spot, stage_with};
use citylights::base::random::{RunKey, Stream};
use citylights::base::statistics::Moments;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::cutoff::{Cutoff, Transfer};
use citylights::scene::light::Shape;
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::shading::contribution::contribution;
use citylights::shading::importance::importance;
use citylights::strategy::{Frame, PickBuffer};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use std::f64::consts::PI;

/// Displayed value of a light's last step: half of 1/255.
const EPS: f64 = 0.5 / 255.0;

fn unshadowed(stage: &Stage, at: &Receiver, light: u32) -> f64 {
    contribution::<0b1111>(LightSampling::Area, &stage.scene().lights()[light as usize], [0.3; 2], at)
        .map_or(0.0, |arrival| f64::from(arrival.radiance.x))
}

#[test]
fn a_plane_of_lamps_loses_the_logarithm_of_its_radius() {
    // One lamp a square metre, of a strength that ends at r_c = 5 m, out to R = 150 m: 70,686 lamps.
    let (r_c, radius) = (5.0f64, 150.0f64);
    let candela = (r_c * r_c * PI * EPS / f64::from(ALBEDO)) as f32;
    let mut stream = Stream::keyed(&[4]);
    let mut lamps = Vec::new();
    for x in -150..150 {
        for y in -150..150 {
            let [u, v] = stream.uniform2();
            let at = Vec3::new(x as f32 + u, y as f32 + v, 10.0);
            if f64::from(at.truncate().length()) < radius {
                lamps.push(point(at, candela));
            }
        }
    }
    assert!(lamps.len() > 70_000);
    // Exposure is 1: radiance is displayed value.
    let stage = stage_with(ground(12.0, lamps), LeaveOut::No, Offset::SCALED);
    let influence = sampler("influence", &stage);
    let block = influence.begin(Frame::new(stage.receivers(), RunKey { seed: 1, run: 0 }), 0..1);
    let (mut worker, mut buffer) = (block.worker(false), PickBuffer::default());
    let orientations = 64;
    let lost: Vec<f64> = (0..orientations)
        .map(|i| {
            let (sin, cos) = (f64::from(i) / f64::from(orientations) * 2.0 * PI).sin_cos();
            let at = receiver(Vec3::new(0.0, 0.0, 10.0), Vec3::new(cos as f32, sin as f32, 0.0));
            let all: f64 = (0..stage.scene().lights().len() as u32).map(|id| unshadowed(&stage, &at, id)).sum();
            worker.fill(&[at], 0..1, true, &mut buffer);
            let picked: f64 =
                buffer.calls().flatten().map(|p| f64::from(p.weight) * unshadowed(&stage, &at, p.light)).sum();
            all - picked
        })
        .collect();
    let n_c = PI * r_c * r_c;
    // Facing every lamp at once: 2 n_c eps ln(R / r_c). A wall sees half of them, at a mean clamped cosine of 1/pi
    // over the whole circle, whichever way it looks.
    let facing = 2.0 * n_c * EPS * (radius / r_c).ln();
    let mean = PI * lost.iter().sum::<f64>() / f64::from(orientations);
    println!("lost {mean} of full white, {facing} by the formula, ratio {}", mean / facing);
    assert!((mean / facing - 1.0).abs() < 0.05, "{mean} for {facing}");
    for (i, one) in lost.iter().enumerate() {
        assert!((one * PI / facing - 1.0).abs() < 0.15, "orientation {i}: {one} for {}", facing / PI);
    }
}

#[test]
fn in_range_and_out_of_range_are_covered_once_each() {
    let stage = stage_with(sixteen(), LeaveOut::No, Offset::SCALED);
    let lights = stage.scene().lights();
    // The tail draws by influence radius; a directional light has none and is always in range.
    let cutoff = Cutoff::new(stage.scene(), 60.0, Transfer::Linear);
    let radius: Vec<f64> =
        lights.iter().map(|l| cutoff.volume(l).map_or(0.0, |volume| f64::from(volume.radius2).sqrt())).collect();
    let (mut inside, mut outside) = (0, 0);
    for at in stage.receivers().iter().step_by(17) {
        let range = expected("influence:cutoff=60", &stage, at);
        let found = expected("influence-tail:cutoff=60,picks=3,tail=2", &stage, at);
        let weight = |i: usize| f64::from(importance(&lights[i], at));
        let total: f64 = (0..lights.len()).filter(|&i| range[i] > 0.0).map(weight).sum();
        for i in 0..lights.len() {
            let wanted = if range[i] > 0.0 {
                inside += 1;
                if total > 0.0 { 3.0 * weight(i) / total } else { 0.0 }
            } else {
                outside += 1;
                2.0 * radius[i] / radius.iter().sum::<f64>()
            };
            assert!((f64::from(found[i]) - wanted).abs() < 1e-6, "light {i}: {} for {wanted}", found[i]);
            assert!(found[i] > 0.0 || weight(i) == 0.0, "light {i} is covered by neither part");
        }
    }
    assert!(inside > 100 && outside > 100, "{inside} in range, {outside} out of it: no test");
}

#[test]
fn the_hierarchy_lists_exactly_the_lights_whose_volume_holds_the_point() {
    // Triangles that face an axis but for a fraction of a degree: the flat side of their half ball is nearly a box's.
    let mut stream = Stream::keyed(&[8]);
    let mut signed = |half: f32| (stream.uniform() * 2.0 - 1.0) * half;
    let mut lights = Vec::new();
    for i in 0..600 {
        let axis = i % 3;
        let mut normal = Vec3::new(signed(1e-3), signed(1e-3), signed(1e-3));
        normal[axis] = if i % 2 == 0 { 1.0 } else { -1.0 };
        let normal = normal.normalize();
        let (u, v) = (normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector()));
        let at = Vec3::new(signed(50.0), signed(50.0), signed(50.0));
        lights.push(Shape::Triangle { corners: [at, at + u * 0.5, at + v * 0.5], radiance: Vec3::splat(100.0) });
        lights.push(point(Vec3::new(signed(50.0), signed(50.0), signed(50.0)), 2.0));
    }
    let stage = stage_with(ground(12.0, lights), LeaveOut::No, Offset::SCALED);
    let cutoff = Cutoff::new(stage.scene(), 0.5, Transfer::Linear);
    let volumes: Vec<_> =
        stage.scene().lights().iter().map(|light| cutoff.volume(light).expect("a local light")).collect();
    let sampler = sampler("influence", &stage);
    let (mut rim, mut listed) = (0, 0);
    for (i, volume) in volumes.iter().enumerate() {
        // A point anywhere, and one just in front of the flat side near its rim.
        let towards = volume.axis.any_orthonormal_vector();
        let turned = towards * signed(1.0) + volume.axis.cross(towards) * signed(1.0);
        let on_rim =
            volume.centre + (turned.normalize_or(towards) + volume.axis * 1e-5) * (volume.radius2.sqrt() * 0.999);
        for position in [Vec3::new(signed(60.0), signed(60.0), signed(60.0)), on_rim] {
            let at = receiver(position, Vec3::Z);
            let mut counts = vec![0.0; volumes.len()];
            sampler.expected_counts(&at, &mut counts);
            for (j, volume) in volumes.iter().enumerate() {
                assert_eq!(counts[j], f32::from(u8::from(volume.contains(position))), "light {j} at {position}");
                listed += counts[j] as usize;
            }
            rim += usize::from(position == on_rim && counts[i] == 1.0 && volume.axis != Vec3::ZERO);
        }
    }
    assert!(rim > 300 && listed > 10_000, "{rim} points near a rim, {listed} listed: no test");
}

/// Mean radiance over the image, of 16 independent runs.
fn mean(strategy: &str, stage: &Stage) -> Moments {
    let sampler = sampler(strategy, stage);
    let receivers = stage.receivers();
    let runs: Vec<f64> = (0..16)
        .map(|run| {
            let mut film = Film::new(receivers.len());
            Plan { stage, receivers, sampler: &*sampler, key: RunKey { seed: 6, run } }.run_parallel(16, &mut film);
            film.image().iter().map(|rgb| f64::from(rgb.x)).sum::<f64>() / receivers.len() as f64
        })
        .collect();
    Moments::of(runs.iter().copied())
}

#[test]
fn splitting_a_lamp_keeps_the_image_of_all_but_the_cut_off() {
    // Lamps that end within the picture: at 25 steps of 1/255 a lamp of 40 cd reaches 6 m, a tenth of it 2 m.
    let lamp = |at: Vec3, parts: usize| vec![point(at, 40.0 / parts as f32); parts];
    let scene = |parts: usize| {
        let mut lights = lamp(Vec3::new(2.0, 1.0, 3.0), parts);
        lights.extend(lamp(Vec3::new(-5.0, 4.0, 3.0), parts));
        lights.push(spot(Vec3::new(3.0, 8.0, 6.0), Vec3::new(-0.2, 0.0, -1.0), 100.0));
        stage_with(ground(12.0, lights), LeaveOut::Yes, Offset::SCALED)
    };
    let (one, ten) = (scene(1), scene(10));
    for name in ["all", "uniform", "power", "intensity", "influence-tail:cutoff=25"] {
        let (a, b) = (mean(name, &one), mean(name, &ten));
        let error = a.standard_error().hypot(b.standard_error()) + 1e-6 * a.mean;
        let t = (a.mean - b.mean).abs() / error;
        println!("{name}: {} whole, {} split, t = {t}", a.mean, b.mean);
        assert!(t < 4.5, "{name}: {} whole, {} split, t = {t}, seed 6", a.mean, b.mean);
        assert!(error < 0.02 * a.mean, "{name}: the error {error} is too great to see anything");
    }
    for name in ["influence:cutoff=25", "influence-pick:cutoff=25"] {
        let (a, b) = (mean(name, &one), mean(name, &ten));
        println!("{name}: {} whole, {} split", a.mean, b.mean);
        assert!(b.mean < 0.9 * a.mean, "{name}: {} whole, {} split: ranges should have shrunk", a.mean, b.mean);
    }
}
