//! Promise: whatever the light and the receiver, what a point adds is nothing or a sound number, and a light that is
//! worth nothing to choose adds nothing.

use citylights::base::triangle::uniform_point;
use citylights::scene::light::{Light, Shape};
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::shading::contribution::contribution;
use citylights::shading::importance::importance;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::Cell;
use std::f64::consts::TAU;

/// Within `[low, high)`. (Proptest's own ranges of f32 fail an assertion of theirs once in a million.)
fn within(low: f32, high: f32) -> impl Strategy<Value = f32> + Clone {
    (0..1u32 << 24).prop_map(move |step| low + (high - low) * (step as f32 / (1u32 << 24) as f32))
}

/// 10 to a uniform power.
fn magnitude(low: f32, high: f32) -> impl Strategy<Value = f32> {
    within(low, high).prop_map(|power| 10f32.powf(power))
}

fn direction() -> impl Strategy<Value = Vec3> {
    let any = (within(-1.0, 1.0), within(0.0, 1.0)).prop_map(|(z, turn)| {
        let (z, turn) = (f64::from(z), f64::from(turn) * TAU);
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z).as_vec3()
    });
    let axes = prop::sample::select(vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]);
    // All but along an axis.
    let nearly = (prop::sample::select(vec![Vec3::X, Vec3::Y, Vec3::NEG_Z]), any.clone(), magnitude(-12.0, -2.0))
        .prop_map(|(axis, off, by)| (axis + off * by).normalize());
    prop_oneof![3 => any, 2 => axes, 1 => nearly]
}

/// Within a cube of 2 m, in whole parts of a metre, or up to 1,000 km away.
fn place() -> impl Strategy<Value = Vec3> {
    let cube = || (within(-1.0, 1.0), within(-1.0, 1.0), within(-1.0, 1.0)).prop_map(|(x, y, z)| Vec3::new(x, y, z));
    let coarse = (-8i32..8, -8i32..8, -8i32..8).prop_map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32) * 0.25);
    let far = (cube(), magnitude(0.0, 6.0)).prop_map(|(at, scale)| at * scale);
    prop_oneof![2 => cube(), 2 => coarse, 2 => far, 1 => Just(Vec3::ZERO)]
}

/// 1e-6 to 1e12, and far beyond; some colours lack a channel.
fn strength() -> impl Strategy<Value = Vec3> {
    let size = prop_oneof![6 => magnitude(-6.0, 12.0), 1 => magnitude(12.0, 37.0), 1 => Just(0.0f32)];
    let channel = || prop_oneof![4 => within(0.05, 1.0), 1 => Just(0.0f32)];
    (size, channel(), channel(), channel()).prop_map(|(size, r, g, b)| Vec3::new(r, g, b) * size)
}

fn shape() -> impl Strategy<Value = Shape> {
    let point = (place(), strength()).prop_map(|(position, intensity)| Shape::Point { position, intensity });
    let spot = (place(), direction(), strength(), within(0.0, 1.0), magnitude(-7.0, 0.0)).prop_map(
        |(position, axis, intensity, cos_outer, width)| {
            let cos_outer = cos_outer.min(1.0 - f32::EPSILON);
            let cos_inner = (cos_outer + width).clamp(cos_outer + 0.5 * f32::EPSILON, 1.0);
            Shape::Spot { position, axis, intensity, cos_inner, cos_outer }
        },
    );
    let directional =
        (direction(), strength()).prop_map(|(towards, irradiance)| Shape::Directional { towards, irradiance });
    let corners = prop_oneof![
        // Of any size.
        3 => (place(), place(), place(), place(), magnitude(-4.0, 3.0)).prop_map(|(at, p, q, r, size)| {
            let flat = |x: Vec3| at + x.clamp(Vec3::splat(-2.0), Vec3::splat(2.0)) * size;
            [flat(p), flat(q), flat(r)]
        }),
        // Slivers.
        2 => (place(), place(), place(), place(), magnitude(-8.0, -1.0)).prop_map(|(at, p, q, r, width)| {
            [at + p, at + q, at + p + (r - p) * width]
        }),
        // In the plane of a floor or a wall.
        1 => (place(), place(), place(), 0..3usize).prop_map(|(p, mut q, mut r, axis)| {
            (q[axis], r[axis]) = (p[axis], p[axis]);
            [p, q, r]
        }),
    ];
    let triangle = (corners, strength()).prop_map(|(corners, radiance)| Shape::Triangle { corners, radiance });
    prop_oneof![2 => point, 2 => spot, 1 => directional, 5 => triangle]
}

/// A point of the light; any point, of one that is so far away that it has none.
fn on_light(shape: &Shape, [u, v]: [f32; 2]) -> Vec3 {
    match *shape {
        Shape::Point { position, .. } | Shape::Spot { position, .. } => position,
        Shape::Directional { towards, .. } => towards * u,
        Shape::Triangle { corners: [a, b, c], .. } => {
            let [b1, b2] = uniform_point([u, v]);
            a + (b - a) * b1 + (c - a) * b2
        }
    }
}

/// A light, a receiver that is badly placed for it, and numbers for a point.
fn posed() -> impl Strategy<Value = (Shape, Receiver, [f32; 2])> {
    let number = || {
        let ends = vec![0.0f32, 1e-30, 1e-7, 0.5, 1.0 - 0.5 * f32::EPSILON];
        prop_oneof![4 => within(0.0, 1.0), 1 => prop::sample::select(ends)]
    };
    let albedo = prop_oneof![3 => within(0.0, 1.0), 1 => Just(1.0f32), 1 => Just(0.0f32)];
    let numbers = ([number(), number()], [number(), number()]);
    (shape(), numbers, (direction(), direction()), magnitude(-6.0, 6.0), 0..6u32, albedo).prop_map(
        |(shape, (uv, foot), (away, turned), distance, way, albedo)| {
            let foot = on_light(&shape, foot);
            let up = match shape {
                Shape::Triangle { corners: [a, b, c], .. } => (b - a).cross(c - a).normalize_or(away),
                Shape::Spot { axis, .. } => axis,
                _ => turned,
            };
            let along = (away - up * up.dot(away)).normalize_or(Vec3::X);
            let (position, normal) = match way {
                // Anywhere.
                0 => (foot + away * distance, turned),
                // Facing it.
                1 => (foot + away * distance, -away),
                // On the light.
                2 => (foot, turned),
                // On its plane, but for rounding.
                3 => (foot + along * distance, turned),
                // Straight in front, so that light and receiver face each other.
                4 => (foot + up * distance, -up),
                // The light on the receiver's horizon, but for rounding.
                _ => (foot + away * distance, away.any_orthonormal_vector()),
            };
            let receiver =
                Receiver { position, normal, view: normal, albedo: Vec3::new(albedo, 1.0, 0.5), pixel: 0, surface: 0 };
            (shape, receiver, uv)
        },
    )
}

/// What the cases were: with light and without, for the way that each kind of sampling gives a point.
#[derive(Default)]
struct Seen {
    lit: Cell<u32>,
    worthless: Cell<u32>,
}

fn sound(shape: &Shape, at: &Receiver, uv: [f32; 2], seen: &Seen) -> Result<(), TestCaseError> {
    let light = Light::from(*shape);
    let worth = importance(&light, at);
    prop_assert!(worth.is_finite() && worth >= 0.0, "worth {}", worth);
    seen.worthless.set(seen.worthless.get() + u32::from(worth == 0.0));
    let last = 1.0 - 0.5 * f32::EPSILON;
    // The point itself, and the corners of the square: those of the triangle are among them.
    for uv in [uv, [0.0, 0.0], [last, 0.0], [0.0, last], [last, last]] {
        for (name, by) in LightSampling::NAMED {
            let Ok(arrival) = contribution::<0b1111>(by, &light, uv, at) else { continue };
            seen.lit.set(seen.lit.get() + 1);
            let radiance = arrival.radiance;
            prop_assert!(radiance.is_finite() && radiance.min_element() >= 0.0, "{}: radiance {}", name, radiance);
            let length = arrival.direction.as_dvec3().length();
            prop_assert!((length - 1.0).abs() < 1e-6, "{}: a direction {} long", name, length);
            prop_assert!(arrival.distance > 0.0, "{}: {} m away", name, arrival.distance);
            prop_assert!(worth > 0.0, "{}: a light worth nothing adds {} by {:?}", name, radiance, uv);
        }
    }
    Ok(())
}

fn run(cases: u32) {
    // The same each time.
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]));
    let seen = Seen::default();
    let found = runner.run(&posed(), |(shape, at, uv)| sound(&shape, &at, uv, &seen));
    found.unwrap_or_else(|error| panic!("{error}"));
    let (lit, worthless) = (seen.lit.get(), seen.worthless.get());
    assert!(lit > 5 * cases, "{lit} points of {cases} lights add anything");
    assert!(worthless > cases / 5 && worthless < cases * 4 / 5, "{worthless} of {cases} lights are worth nothing");
}

#[test]
fn ten_thousand_points_are_sound() {
    run(10_000);
}

#[test]
#[ignore = "a minute: a million points"]
fn a_million_points_are_sound() {
    run(1_000_000);
}
