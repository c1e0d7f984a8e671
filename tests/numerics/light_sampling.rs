//! Points on triangle lights: every way gives the same light on average, and none shows where it takes over from
//! another.

use crate::promises::common::receiver;
use citylights::base::random::Stream;
use citylights::base::triangle::Seen;
use citylights::scene::light::{Light, Shape};
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::shading::contribution::contribution;
use glam::Vec3;
use std::f64::consts::PI;

fn white(position: Vec3, normal: Vec3) -> Receiver {
    Receiver { albedo: Vec3::ONE, ..receiver(position, normal) }
}

/// Mean and standard error of what points on a light add, and what they should.
fn estimate(by: LightSampling, light: &Light, at: &Receiver, samples: u32, rng: &mut Stream) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..samples {
        let x = contribution::<0b1111>(by, light, rng.uniform2(), at).map_or(0.0, |a| f64::from(a.radiance.x));
        sum += x;
        squares += x * x;
    }
    let n = f64::from(samples);
    let mean = sum / n;
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt())
}

/// What a receiver of albedo 1 reflects of a triangle of radiance 1.
fn exact(corners: [Vec3; 3], at: &Receiver) -> f64 {
    let seen = Seen::new(corners.map(|corner| corner.as_dvec3() - at.position.as_dvec3()));
    // With counter-clockwise fronts the solid angle is positive from behind.
    if seen.solid_angle() > 0.0 { 0.0 } else { seen.irradiance(at.normal.as_dvec3()) / PI }
}

/// About the most that one sample can add to what [`exact`] gives.
fn greatest(by: LightSampling, corners: [Vec3; 3], at: &Receiver) -> f64 {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3() - at.position.as_dvec3());
    match by {
        LightSampling::SolidAngle => Seen::new([a, b, c]).solid_angle().abs() / PI,
        LightSampling::Area => {
            const SIDE: u32 = 64;
            let inner = |i: u32, j: u32| a + (b - a) * (f64::from(i) / 64.0) + (c - a) * (f64::from(j) / 64.0);
            let grid = (0..=SIDE).flat_map(|i| (0..=SIDE - i).map(move |j| (i, j)));
            let nearest2 = grid.map(|(i, j)| inner(i, j).length_squared()).fold(f64::INFINITY, f64::min);
            let area = 0.5 * (b - a).cross(c - a).length();
            // The cosine at the light falls as the receiver comes near its plane.
            let height = (b - a).cross(c - a).normalize_or_zero().dot(a).abs();
            area * (height / nearest2.sqrt()).min(1.0) / (nearest2 * PI)
        }
        LightSampling::Projected | LightSampling::Auto => 0.0,
    }
}

fn point(rng: &mut Stream, scale: f32) -> Vec3 {
    Vec3::new(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5) * scale
}

#[test]
fn names_are_read_as_they_are_written() {
    for (name, by) in LightSampling::NAMED {
        assert_eq!((by.name(), LightSampling::named(name)), (name, Some(by)));
    }
    assert_eq!(LightSampling::named("angle"), None);
}

#[test]
fn every_way_gives_the_same_light() {
    const CASES: u32 = 300;
    // 4 ways, two sides: 1e-3 over all.
    const LIMIT: f64 = 5.2;
    let mut rng = Stream::keyed(&[41]);
    let (mut lit, mut heavy) = (0, 0);
    for case in 0..CASES {
        // From far away to almost touching.
        let corners = [point(&mut rng, 2.0), point(&mut rng, 2.0), point(&mut rng, 2.0)];
        let distance = 10f32.powf(rng.uniform() * 3.0 - 1.5);
        let normal = (point(&mut rng, 1.0) + 1e-3).normalize();
        let at = white(corners[0] + point(&mut rng, 2.0) * distance, normal);
        let light = Light::from(Shape::Triangle { corners, radiance: Vec3::ONE });
        let exact = exact(corners, &at);
        lit += u32::from(exact > 0.0);
        for (name, by) in LightSampling::NAMED {
            let (mean, error) = estimate(by, &light, &at, 2_000, &mut rng);
            // Rounding in f32, and the rare point of an area next to the receiver, which no 2,000 samples need to meet.
            let slack = 2e-5 * exact;
            let off = (mean - exact).abs();
            let settled = by.settled(&light, &at);
            // Told beforehand, never by the estimate: where the mean is a small share of the greatest sample, rare points decide.
            if exact > 0.0 && exact < 0.02 * greatest(settled, corners, &at) {
                heavy += 1;
                continue;
            }
            assert!(off <= LIMIT * error + slack, "case {case}, {name}: {mean} +- {error}, exact {exact}");
            if settled == LightSampling::Projected {
                assert!(
                    error <= slack,
                    "case {case}, {name}: every point is worth the same, yet +- {error} of {exact}"
                );
            }
        }
    }
    assert!(heavy < CASES, "{heavy} estimates that rare points decide");
    assert!(lit > CASES / 6, "{lit} of {CASES} receivers see their light");
}

#[test]
fn auto_shows_no_step_where_it_switches() {
    // Along a wall in front of a panel: the expectation by either way is the closed form on both sides of the switch.
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let light = Light::from(Shape::Triangle { corners, radiance: Vec3::ONE });
    let by = LightSampling::Auto;
    let place = |z: f32| white(Vec3::new(0.3, 0.3, z), Vec3::NEG_Z);
    let settled = |z: f32| by.settled(&light, &place(z));
    let (mut near, mut far) = (0.1f32, 10.0f32);
    assert_ne!(settled(near), settled(far), "it never switches");
    while far - near > 1e-5 {
        let middle = 0.5 * (near + far);
        if settled(middle) == settled(far) { far = middle } else { near = middle }
    }
    let mut rng = Stream::keyed(&[42]);
    let spreads = [near, far].map(|z| {
        let at = place(z);
        let (mean, error) = estimate(by, &light, &at, 400_000, &mut rng);
        let exact = exact(corners, &at);
        assert!((mean - exact).abs() <= 4.0 * error + 1e-5 * exact, "at {z} m: {mean} +- {error}, exact {exact}");
        error * 400_000f64.sqrt() / exact
    });
    // Nor in the noise, which is never below that of choosing the light: 1 in these units.
    let [by_angle, by_area] = spreads.map(|spread| (1.0 + spread * spread).sqrt());
    assert!(by_area / by_angle < 1.5, "a sample spreads by {spreads:?}");
}

#[test]
fn auto_takes_a_near_end_by_angle() {
    // A sign 3.2 m long that hangs out over a wall, seen from a point of the wall beside its near end: its centroid is far
    // enough for its area.
    let corners = [Vec3::new(0.25, 0.1, 0.0), Vec3::new(3.45, 0.1, 1.1), Vec3::new(0.25, 0.1, 1.1)];
    let light = Light::from(Shape::Triangle { corners, radiance: Vec3::ONE });
    // By either side of the plane, one is lit.
    let places = [Vec3::ZERO, Vec3::new(0.0, 0.2, 0.0)];
    let lit = places.map(|position| white(position, Vec3::X)).into_iter().find(|at| exact(corners, at) > 0.0);
    let at = lit.expect("a side that the sign lights");
    assert_eq!(LightSampling::Auto.settled(&light, &at), LightSampling::SolidAngle);
    let away = Receiver { position: at.position - Vec3::X * 3.0, ..at };
    assert_eq!(LightSampling::Auto.settled(&light, &away), LightSampling::Area);
    let mut rng = Stream::keyed(&[43]);
    let [by_area, auto] =
        [LightSampling::Area, LightSampling::Auto].map(|by| estimate(by, &light, &at, 100_000, &mut rng));
    for (mean, error) in [by_area, auto] {
        assert!((mean - exact(corners, &at)).abs() <= 4.0 * error, "{mean} +- {error}");
    }
    assert!(auto.1 < 0.5 * by_area.1, "by area +- {}, auto +- {}", by_area.1, auto.1);
}
