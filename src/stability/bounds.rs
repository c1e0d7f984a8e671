//! Does what bounds things hold them after rounding?

use super::tally::{Finding, Tally, relative};
use super::triangles::{direction, magnitude, point};
use crate::base::discrete::Cumulative;
use crate::base::double_double::DoubleDouble;
use crate::base::random::Stream;
use crate::scene::light::{Light, Shape};
use crate::scene::receiver::Receiver;
use crate::tree::{STEP, centred, relative_variance, steps};
use crate::visibility::offset::Offset;
use glam::{DVec3, Vec3, Vec3A};

/// Names what is drawn.
const SEED: u64 = 27;
/// Boxes that each case tries.
const TRIED: usize = 4000;

/// By how much a box sticks out of its centre and half extents, over its size: up to 1000 km from the origin.
pub(super) fn boxes() -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    let mut stream = Stream::keyed(&[SEED]);
    for _ in 0..TRIED {
        let place = direction(&mut stream) * magnitude(&mut stream, -3.0, 6.0);
        let size = magnitude(&mut stream, -4.0, 5.0);
        let [p, q] = [(); 2].map(|()| (place + point(&mut stream) * size).as_vec3());
        let (low, high) = (p.min(q), p.max(q));
        let (exact_low, exact_high) = (low.as_dvec3(), high.as_dvec3());
        let out = |centre: Vec3, half: Vec3| {
            let (centre, half) = (centre.as_dvec3(), half.as_dvec3());
            let beyond = ((centre - half) - exact_low).max(exact_high - (centre + half));
            beyond.max_element().max(0.0) / (exact_high - exact_low).length().max(f64::MIN_POSITIVE)
        };
        let (centre, half) = centred(Vec3A::from(low), Vec3A::from(high));
        ours.add(f64::from(half.max_element()), out(centre, half));
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        theirs.add(f64::from(half.max_element()), out(centre, half));
    }
    // The check itself rounds, in f64.
    Finding { ours, textbook: Some(theirs), limit: 1e-9 }
}

/// By how much directions stick out of a box of them that is kept in 16 bits a component.
pub(super) fn directions() -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    let mut stream = Stream::keyed(&[SEED, 1]);
    for i in 0..TRIED {
        let spread = magnitude(&mut stream, -7.0, 0.0);
        let about = direction(&mut stream);
        let axes = [Vec3::X, Vec3::NEG_Y, Vec3::Z];
        let draw = |j: usize, stream: &mut Stream| {
            if i % 10 == 0 { axes[j] } else { (about + point(stream) * spread).normalize_or(about).as_vec3() }
        };
        let [p, q, r] = [0, 1, 2].map(|j| draw(j, &mut stream));
        let (low, high) = (p.min(q).min(r), p.max(q).max(r));
        let out = |k: usize, (middle, half): (i16, i16)| {
            let [middle, half] = [middle, half].map(|n| f64::from(n) * f64::from(STEP));
            ((middle - half) - f64::from(low[k])).max(f64::from(high[k]) - (middle + half)).max(0.0)
        };
        for k in 0..3 {
            let held = steps(low[k], high[k]);
            // Outward by two steps at most: else a bound bounds nothing.
            let loose = 2.0 * f64::from(held.1) * f64::from(STEP) - f64::from(high[k] - low[k]);
            let wide = if loose <= 4.0 * f64::from(STEP) { 0.0 } else { loose };
            ours.add_positive(f64::from(held.1), out(k, held).max(wide));
            // To the nearest step.
            let nearest = |x: f32| (x / STEP).round() as i16;
            let (middle, half) = (nearest(0.5 * (low[k] + high[k])), nearest(0.5 * (high[k] - low[k])));
            theirs.add_positive(f64::from(half), out(k, (middle, half)));
        }
    }
    Finding { ours, textbook: Some(theirs), limit: 0.0 }
}

/// Relative error of the variance of 1/d^2 over its squared mean, distances spread evenly over a cluster.
pub(super) fn variance() -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    let mut stream = Stream::keyed(&[SEED, 2]);
    for _ in 0..TRIED {
        let near = magnitude(&mut stream, -3.0, 6.0) as f32;
        let far = (near + magnitude(&mut stream, -2.0, 3.0) as f32).max(near.next_up());
        // E[g^2] / E[g]^2 - 1, with E[g] = 1 / (a b) and E[g^2] = (a^2 + a b + b^2) / (3 a^3 b^3).
        let (a, b) = (DoubleDouble::from(f64::from(near)), DoubleDouble::from(f64::from(far)));
        let product = a * b;
        let exact = ((a * a + product + b * b).over(DoubleDouble::from(3.0) * product) - DoubleDouble::from(1.0)).high;
        let found = relative_variance(f64::from(near), f64::from(far));
        ours.add_positive(found, relative(found, exact));
        let mean = 1.0 / (near * far);
        let square = (near * near + near * far + far * far) / (3.0 * (near * far).powi(3));
        let found = f64::from((square - mean * mean) / (mean * mean));
        theirs.add_positive(found, relative(found, exact));
    }
    Finding { ours, textbook: Some(theirs), limit: 1e-12 }
}

/// By how much a number stretched over the share that it fell into leaves `[0, 1)`, or a weight of 0 is chosen.
pub(super) fn stretched() -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    let mut stream = Stream::keyed(&[SEED, 3]);
    let mut sums = Cumulative::default();
    let off = |u: f64| -> f64 { if (0.0..1.0).contains(&u) { 0.0 } else { 1.0 } };
    for _ in 0..TRIED {
        let weights = [(); 8].map(|()| {
            let weight = magnitude(&mut stream, -6.0, 12.0) as f32;
            if stream.below(4) == 0 { 0.0 } else { weight }
        });
        sums.clear();
        weights.iter().for_each(|&weight| sums.push(weight));
        // A boundary, or next to it.
        let edge = (0..stream.below(8)).map(|i| sums.pmf(i)).sum::<f64>();
        let u = (edge + (stream.below(5) as f64 - 2.0) * f64::EPSILON).clamp(0.0, 1.0 - 0.5 * f64::EPSILON);
        let Some((index, pmf, left)) = sums.pick_stretched(u) else { continue };
        ours.add_positive(left, off(left).max(if weights[index] > 0.0 && pmf > 0.0 { 0.0 } else { 1.0 }));
        // (u - p) / (1 - p) of the second of two, in f32.
        let (u, p) = (stream.uniform(), 1.0 - magnitude(&mut stream, -8.0, -4.0) as f32);
        let u = u.max(p);
        let left = f64::from((u - p) / (1.0 - p));
        theirs.add_positive(left, off(left));
    }
    Finding { ours, textbook: Some(theirs), limit: 0.0 }
}

/// How far a shadow ray's start leaves what is allowed: above the surface, and within 0.1 mm and four units of it in a city
/// of 800 m.
pub(super) fn push() -> Finding {
    const SIZE: f32 = 800.0;
    let mut stream = Stream::keyed(&[SEED, 4]);
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    let light = Light::from(Shape::Point { position: Vec3::ZERO, intensity: Vec3::ONE });
    for i in 0..TRIED {
        // A place on a surface that is rounded to f32 as a receiver.
        let place = if i % 20 == 0 { DVec3::ZERO } else { direction(&mut stream) * magnitude(&mut stream, -3.0, 6.0) };
        // Level, upright or neither.
        let normal = [DVec3::Z, DVec3::NEG_X, direction(&mut stream)][i % 3];
        let (position, normal) = (place.as_vec3(), normal.as_vec3());
        let at = Receiver { position, normal, view: normal, albedo: Vec3::ONE, pixel: 0, surface: 0 };
        let unit = place.abs().max_element() * f64::from(f32::EPSILON);
        for (policy, tally) in [(Offset::SCALED, &mut ours), (Offset::ORIGIN_PUSH, &mut theirs)] {
            let pushed = policy.within(SIZE).segment(&at, &light, Vec3::Z, 1.0).origin.as_dvec3() - place;
            let height = pushed.dot(normal.as_dvec3());
            let beyond = (pushed.length() - 1e-4 - 4.0 * unit).max(0.0);
            tally.add_positive(height, if height > 0.0 { beyond } else { f64::INFINITY });
        }
    }
    Finding { ours, textbook: Some(theirs), limit: 1e-9 }
}
