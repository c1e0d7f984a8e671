//! Does each light of a light tree keep its chance, however much lights differ?

use super::tally::{Finding, Tally, relative};
use super::triangles::{direction, magnitude, point};
use crate::base::draws::{Points, Sequence};
use crate::base::random::{RunKey, Stream};
use crate::scene::Scene;
use crate::scene::light::{LightId, Shape};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::sources::small;
use crate::strategy::Uncounted;
use crate::tree::{Distance, Facing, How, Memory, Tree, Weighing};
use glam::{DVec3, Vec3};

/// Names the lights.
const SEED: u64 = 15;
/// Lights of a tree that is looked at as a whole.
const LIGHTS: usize = 2000;
/// Receivers that look at it.
const RECEIVERS: usize = 120;
/// All ways to weigh.
const WAYS: [How; 4] = [
    How { weighing: Weighing::Box, distance: Distance::Mean, facing: Facing::Rms },
    How { weighing: Weighing::Box, distance: Distance::MinMax, facing: Facing::Mean },
    How { weighing: Weighing::Box, distance: Distance::Mean, facing: Facing::Mean },
    // Takes the absolute cosine at the receiver: it knows no horizon.
    How { weighing: Weighing::Classic, distance: Distance::Mean, facing: Facing::Mean },
];
/// Those that know the horizon.
const HORIZONS: usize = 3;
/// Rounding of a count to f32, and of a sum of them.
const ROUNDING: f64 = 1e-6;

fn receiver(position: DVec3, normal: DVec3) -> Receiver {
    let (position, normal) = (position.as_vec3(), normal.as_vec3());
    Receiver { position, normal, view: normal, albedo: Vec3::ONE, pixel: 0, surface: 0 }
}

/// Lights over eighteen orders of magnitude of intensity.
fn intensity(stream: &mut Stream) -> f32 {
    magnitude(stream, -6.0, 12.0) as f32
}

/// Of all kinds that have a place, crowded towards one: 1 mm to 10 km away.
fn mixed(stream: &mut Stream) -> Shape {
    let place = direction(stream) * magnitude(stream, -3.0, 4.0);
    let strength = Vec3::splat(intensity(stream));
    match stream.below(3) {
        0 => Shape::Point { position: place.as_vec3(), intensity: strength },
        1 => Shape::Spot {
            position: place.as_vec3(),
            axis: direction(stream).as_vec3().normalize(),
            intensity: strength,
            cos_inner: 0.9,
            cos_outer: 0.5,
        },
        _ => {
            let size = magnitude(stream, -2.0, 1.0);
            let corners = [(); 3].map(|()| (place + point(stream) * size).as_vec3());
            Shape::Triangle { corners, radiance: strength }
        }
    }
}

/// A point light above the ground.
fn above(stream: &mut Stream) -> Shape {
    let place = direction(stream) * magnitude(stream, -1.0, 4.0);
    let place = DVec3::new(place.x, place.y, 0.5 + place.z.abs());
    Shape::Point { position: place.as_vec3(), intensity: Vec3::splat(intensity(stream)) }
}

/// A scene with so many of these lights; `None` cannot be, and would be no result.
fn scene(count: usize, stream: &mut Stream, light: impl Fn(&mut Stream) -> Shape) -> Option<Scene> {
    Scene::new(small::ground(12.0, (0..count).map(|_| light(stream)).collect())).ok()
}

fn all(scene: &Scene) -> Vec<LightId> {
    (0..scene.lights().len() as LightId).collect()
}

/// The expected counts of each way of walking trees of 2 and of 8 slots a node, shown with the way.
fn each_way(scene: &Scene, ways: &[How], mut see: impl FnMut(&dyn Fn(&Receiver) -> Vec<f32>)) {
    let lights = all(scene);
    for &how in ways {
        let (binary, wide) = (Tree::<2>::new(scene, &lights, how), Tree::<8>::new(scene, &lights, how));
        let counts = |expect: &dyn Fn(&mut [f32])| {
            let mut counts = vec![0.0; lights.len()];
            expect(&mut counts);
            counts
        };
        see(&|at| counts(&|counts| binary.expect(at, 1.0, counts)));
        see(&|at| counts(&|counts| wide.expect(at, 1.0, counts)));
    }
}

/// The sum of all probabilities less 1, where every light adds something: nothing is lost, nothing counted twice.
pub(super) fn sum() -> Finding {
    let mut stream = Stream::keyed(&[SEED]);
    let mut ours = Tally::default();
    if let Some(scene) = scene(LIGHTS, &mut stream, above) {
        let receivers: Vec<Receiver> = (0..RECEIVERS / 4)
            .map(|_| {
                let place = direction(&mut stream) * magnitude(&mut stream, -3.0, 4.0);
                receiver(DVec3::new(place.x, place.y, 0.0), DVec3::Z)
            })
            .collect();
        each_way(&scene, &WAYS, |counts| {
            for at in &receivers {
                let sum: f64 = counts(at).into_iter().map(f64::from).sum();
                ours.add_positive(sum, (sum - 1.0).abs());
            }
        });
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}

/// Whether lights that add something have a probability that f32 can hold: 0 for it, 1 for a light that is lost.
pub(super) fn reach() -> Finding {
    let mut stream = Stream::keyed(&[SEED, 1]);
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    if let Some(scene) = scene(LIGHTS, &mut stream, mixed) {
        reached(&scene, f32::MIN_POSITIVE, &mut stream, &mut ours);
        let strengths: Vec<f32> = scene.lights().iter().map(|light| light.peak_intensity().x).collect();
        halves(&strengths, 1.0, &mut theirs);
    }
    Finding { ours, textbook: Some(theirs), limit: 0.0 }
}

/// The same, some lights so far away that in f32 their distance is finite and its fourth power is not.
pub(super) fn far_apart() -> Finding {
    apart(1e18, f32::MIN_POSITIVE)
}

/// Some lights at the ends of f32: sizes are infinite. A chance of none is then all that counts as lost.
pub(super) fn infinite() -> Finding {
    apart(3e38, 0.0)
}

fn apart(distance: f64, least: f32) -> Finding {
    let mut stream = Stream::keyed(&[SEED, 2]);
    let mut ours = Tally::default();
    let light = |stream: &mut Stream| {
        let far = stream.below(4) == 0;
        let place = direction(stream) * if far { distance } else { magnitude(stream, -3.0, 4.0) };
        Shape::Point { position: place.as_vec3(), intensity: Vec3::splat(intensity(stream)) }
    };
    if let Some(scene) = scene(LIGHTS, &mut stream, light) {
        reached(&scene, least, &mut stream, &mut ours);
    }
    Finding { ours, textbook: None, limit: 0.0 }
}

/// Receivers among the lights, every other one exactly at a light. A light with a chance of `least` or less is lost.
fn reached(scene: &Scene, least: f32, stream: &mut Stream, tally: &mut Tally) {
    let receivers: Vec<Receiver> = (0..RECEIVERS / 4)
        .map(|i| {
            let place = if i % 2 == 0 {
                direction(stream) * magnitude(stream, -3.0, 4.0)
            } else {
                scene.lights()[stream.below(scene.lights().len())].position.as_dvec3()
            };
            receiver(place, direction(stream))
        })
        .collect();
    let uv = stream.uniform2();
    each_way(scene, &WAYS, |counts| {
        for at in &receivers {
            for (light, pmf) in scene.lights().iter().zip(counts(at)) {
                // The count of one that is too small is given as the smallest normal number.
                if contribution::<0b1111>(LightSampling::Area, light, uv, at).is_ok() {
                    tally.add_positive(f64::from(pmf), if pmf > least { 0.0 } else { 1.0 });
                }
            }
        }
    });
}

/// Probabilities by halves in f32, the second half's as what the first leaves of 1.
fn halves(strengths: &[f32], pmf: f32, tally: &mut Tally) {
    let (first, second) = strengths.split_at(strengths.len() / 2);
    if first.is_empty() {
        tally.add_positive(f64::from(pmf), if pmf > f32::MIN_POSITIVE { 0.0 } else { 1.0 });
        return;
    }
    let total: f32 = strengths.iter().sum();
    let share = first.iter().sum::<f32>() / total;
    halves(first, pmf * share, tally);
    halves(second, pmf * (1.0 - share), tally);
}

/// How far the probability that comes with a pick is from the one that is told without picking.
pub(super) fn walk() -> Finding {
    let mut stream = Stream::keyed(&[SEED, 3]);
    let mut ours = Tally::default();
    if let Some(scene) = scene(LIGHTS, &mut stream, mixed) {
        for how in WAYS {
            walked(&Tree::<2>::new(&scene, &all(&scene), how), &mut stream, &mut ours);
            walked(&Tree::<8>::new(&scene, &all(&scene), how), &mut stream, &mut ours);
        }
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}

fn walked<const N: usize>(tree: &Tree<N>, stream: &mut Stream, tally: &mut Tally) {
    let mut memory = Memory::default();
    for pixel in 0..10 {
        let at = receiver(direction(stream) * magnitude(stream, -3.0, 4.0), direction(stream));
        let mut counts = vec![0.0; LIGHTS];
        tree.expect(&at, 1.0, &mut counts);
        tree.walk(&at, &mut memory, &mut Uncounted).arrive();
        let sequence = Sequence::new(RunKey { seed: SEED, run: 0 }, pixel, Points::Random);
        for pass in 0..100 {
            let mut draws = sequence.pass(pass);
            let u = stream.uniform64();
            let picked = tree.walk(&at, &mut memory, &mut Uncounted).pick(u, &mut draws);
            if let Some((light, pmf)) = picked {
                tally.add_positive(pmf, relative(pmf, f64::from(counts[light as usize])));
            }
        }
    }
}

/// The sum of all probabilities where every light is behind the horizon.
pub(super) fn dark() -> Finding {
    let mut stream = Stream::keyed(&[SEED, 4]);
    let mut ours = Tally::default();
    if let Some(scene) = scene(LIGHTS, &mut stream, above) {
        each_way(&scene, &WAYS[..HORIZONS], |counts| {
            for i in 0..20 {
                let at = receiver(DVec3::new(f64::from(i), 0.0, 0.0), DVec3::NEG_Z);
                let sum: f64 = counts(&at).into_iter().map(f64::from).sum();
                ours.add_positive(sum, sum);
            }
        });
    }
    Finding { ours, textbook: None, limit: 0.0 }
}

/// One, two, three or a hundred thousand lights alike in one place: how far each is from its part of 1.
pub(super) fn identical() -> Finding {
    let mut stream = Stream::keyed(&[SEED, 5]);
    let mut ours = Tally::default();
    for count in [1, 2, 3, 100_000] {
        let light = |_: &mut Stream| small::point(Vec3::new(1.0, 1.0, 5.0), 100.0);
        let Some(scene) = scene(count, &mut stream, light) else { continue };
        let tree = Tree::<8>::new(&scene, &all(&scene), How::default());
        let mut counts = vec![0.0; count];
        tree.expect(&receiver(DVec3::ZERO, DVec3::Z), 1.0, &mut counts);
        for pmf in counts {
            ours.add_positive(f64::from(pmf), relative(f64::from(pmf), 1.0 / count as f64));
        }
    }
    Finding { ours, textbook: None, limit: ROUNDING }
}
