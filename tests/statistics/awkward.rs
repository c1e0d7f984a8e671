//! Scenes where right strategies were accused: rare events that hold most of a value, emitters at the edge of where they
//! shine, equal splits, light too dim for its numbers.

use crate::promises::common::{cuboid, ground, moon, panel, point};
use citylights::base::random::Stream;
use citylights::scene::light::Shape;
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::{Parts, Scene};
use citylights::strategy::Registry;
use citylights::verify::metamorphic::{Copies, Metamorphic, PIXELS};
use citylights::verify::{Check, Verifier, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use std::f32::consts::TAU;

/// The scene in which no receiver gets light that f32 holds with all its digits.
const SUBNORMAL: &str = "subnormal lights";

/// All of them.
pub(super) fn all() -> Vec<Parts> {
    let scenes = [
        ("lamps on the floor", on_the_floor()),
        ("sun and lamps", sun_and_lamps()),
        ("flush panes", flush_panes()),
        ("glowing dome", dome()),
        ("slivers of light", slivers()),
        ("lamps in the ground", in_the_ground()),
        ("equal lights", equal()),
        (SUBNORMAL, subnormal()),
    ];
    scenes.map(|(name, parts)| Parts { name: name.into(), ..parts }).into()
}

/// 225 lamps 1 to 9 mm over the floor: each adds much of what arrives, from so far out of its range that it is kept once
/// in 30,000 passes.
fn on_the_floor() -> Parts {
    let lamp = |i: u32| {
        let place = Vec3::new((i % 15) as f32 * 1.3 - 9.0, (i / 15) as f32 * 1.3 - 9.0, 0.001 * (1 + i % 9) as f32);
        point(place, 1.0)
    };
    ground(12.0, (0..225).map(lamp).collect())
}

/// A place that `stream` draws, and an intensity between powers of ten.
fn anywhere(stream: &mut Stream, powers: [f32; 2]) -> Shape {
    let [x, y, z, power] = std::array::from_fn(|_| stream.uniform());
    let place = Vec3::new(20.0 * x - 10.0, 20.0 * y - 10.0, 0.3 + 4.0 * z);
    point(place, 10f32.powf(powers[0] + (powers[1] - powers[0]) * power))
}

/// 10^5 lx beside lamps of 10^-4 to 10^3 cd.
fn sun_and_lamps() -> Parts {
    let mut stream = Stream::keyed(&[61]);
    let mut lights: Vec<_> = (0..150).map(|_| anywhere(&mut stream, [-4.0, 3.0])).collect();
    lights.push(moon(Vec3::new(0.5, 0.3, 0.8), 1e5));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-3.0, -2.0, 0.0), Vec3::new(-1.0, 1.0, 4.0)));
    parts
}

/// Emitters that lie in the plane of a wall and of the floor.
fn flush_panes() -> Parts {
    let pane = |i: usize| {
        let (x, y) = (2.2 * (i % 8) as f32 - 8.0, (i / 8) as f32);
        let on_wall = panel(Vec3::new(x, 2.0, 1.0 + 0.3 * y), -Vec3::X, Vec3::Z * 0.25, 200.0);
        let on_floor = panel(Vec3::new(x, 0.7 * y - 6.0, 0.0), Vec3::X * 0.5, Vec3::Y * 0.5, 200.0);
        [on_wall, on_floor].concat()
    };
    let mut parts = ground(12.0, (0..16).flat_map(pane).collect());
    parts.surfaces.extend(cuboid(Vec3::new(-10.0, 2.0, 0.0), Vec3::new(10.0, 3.0, 6.0)));
    parts
}

/// A half sphere of emitters around all.
fn dome() -> Parts {
    const RINGS: usize = 6;
    const SECTORS: usize = 12;
    let place = |ring: usize, sector: usize| {
        let (up, around) = (TAU / 4.0 * ring as f32 / RINGS as f32, TAU * sector as f32 / SECTORS as f32);
        25.0 * Vec3::new(up.sin() * around.cos(), up.sin() * around.sin(), up.cos())
    };
    let lit = |corners| Shape::Triangle { corners, radiance: Vec3::splat(10.0) };
    let cell = |i: usize| {
        let (ring, sector) = (i / SECTORS, i % SECTORS);
        let [a, b] = [sector, sector + 1].map(|sector| place(ring, sector));
        let [c, d] = [sector + 1, sector].map(|sector| place(ring + 1, sector));
        [lit([a, b, c]), lit([a, c, d])]
    };
    // Those at the top have no area.
    let lights = (0..RINGS * SECTORS).flat_map(cell).filter(|light| {
        let Shape::Triangle { corners: [a, b, c], .. } = light else { return false };
        (b - a).cross(c - a).length() > 0.1
    });
    ground(12.0, lights.collect())
}

/// Triangles a hundred thousandth as wide as they are long, among lamps.
fn slivers() -> Parts {
    let mut stream = Stream::keyed(&[62]);
    let sliver = |y: f32, z: f32, width: f32| {
        let corners = [Vec3::new(6.0, y, z), Vec3::new(-6.0, y + width, z), Vec3::new(-6.0, y, z)];
        Shape::Triangle { corners, radiance: Vec3::splat(1e6) }
    };
    let mut lights = vec![sliver(0.0, 3.0, 1e-4), sliver(4.0, 2.0, 3e-5), sliver(-3.0, 1.0, 1e-3)];
    lights.extend((0..5).map(|_| anywhere(&mut stream, [1.5, 1.8])));
    ground(12.0, lights)
}

/// Lamps at no height and at almost none.
fn in_the_ground() -> Parts {
    let mut stream = Stream::keyed(&[63]);
    let heights = [0.0, 0.0, 1e-7, 1e-30];
    let low = heights.iter().zip(0u8..).map(|(&z, i)| point(Vec3::new(f32::from(i) * 3.0 - 5.0, 1.0, z), 100.0));
    let mut lights: Vec<_> = low.collect();
    lights.extend((0..12).map(|_| anywhere(&mut stream, [1.5, 1.8])));
    ground(12.0, lights)
}

/// A regular grid: every split into halves has its equal.
fn equal() -> Parts {
    let place = |i: u32| Vec3::new(2.0 * (i % 8) as f32 - 7.0, 2.0 * (i / 8) as f32 - 7.0, 3.0);
    ground(12.0, (0..64).map(|i| point(place(i), 20.0)).collect())
}

/// Intensities below the least that f32 holds with all its digits.
fn subnormal() -> Parts {
    let mut stream = Stream::keyed(&[64]);
    ground(12.0, (0..20).map(|_| anywhere(&mut stream, [-44.0, -38.0])).collect())
}

/// What `citylights verify` finds wrong with a scene, its arithmetic aside: every strategy, and the scene changed in ways that
/// change no strategy's contract.
pub(super) fn failures(scene: &Scene, options: VerifyOptions) -> Vec<String> {
    let parts = scene.parts();
    let shrunk = Parts { camera: parts.camera.shrunk(PIXELS), ..parts };
    let stage = Stage::new(Scene::new(shrunk).expect("a scene"), LeaveOut::Yes, Offset::SCALED);
    let verifier = Verifier::new(&stage, options);
    // Elsewhere statistics would look at nothing.
    let most = if scene.name() == SUBNORMAL { options.receivers } else { options.receivers / 4 };
    assert!(verifier.dim() <= most, "{}: {} receivers are dim", scene.name(), verifier.dim());
    let copies = Copies::new(scene, Offset::SCALED, LightSampling::default()).expect("changed scenes");
    let metamorphic = Metamorphic::new(&copies, options.fewer());
    let failed = |strategy: &str, checks: Vec<Check>| -> Vec<String> {
        let wrong = checks.into_iter().filter(|check| !check.passed);
        wrong.map(|check| format!("{}, seed {}: {strategy} {check}", scene.name(), options.seed)).collect()
    };
    let mut all = failed("(the image)", metamorphic.image());
    for info in Registry::standard().infos() {
        let strategy = Registry::standard().parse(info.name).expect(info.name);
        let mut checks = verifier.verify(&strategy).expect(info.name);
        assert!(checks.len() >= 9, "{} was not looked at", info.name);
        checks.extend(metamorphic.verify(&strategy).expect(info.name));
        all.extend(failed(info.name, checks));
    }
    all
}

#[test]
fn right_strategies_pass_where_statistics_are_hard() {
    let options = VerifyOptions { receivers: 8, draws: 4_000, level: 2e-3, ..VerifyOptions::default() };
    let failed: Vec<String> =
        all().into_iter().flat_map(|parts| failures(&Scene::new(parts).expect("a scene"), options)).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
