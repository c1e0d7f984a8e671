//! What are solid angle and irradiance to twenty-five digits or so?
//!
//! The plain formulas in [`DoubleDouble`] numbers: they cancel as always, but from 31 digits. Results are trustworthy to 1e-16 of
//! themselves unless a corner or an edge comes nearer to the receiver than 1e-12 of the triangle's size.

use crate::base::double_double::DoubleDouble;
use std::array;

/// A vector.
type Point = [DoubleDouble; 3];

fn point(p: [f64; 3]) -> Point {
    p.map(DoubleDouble::from)
}

fn length(p: Point) -> DoubleDouble {
    DoubleDouble::dot(p, p).sqrt()
}

/// Sine and cosine of an f64 angle within `[0, pi]`.
fn sin_cos(angle: f64) -> (DoubleDouble, DoubleDouble) {
    // The series of a 64th, then six times the double angle: 2^-6 pi < 0.05, so 13 terms leave 1e-34.
    let x = DoubleDouble::from(angle / 64.0);
    let x2 = x * x;
    let one = DoubleDouble::from(1.0);
    let series = |first: u32| {
        (1..13u32).rev().fold(one, |sum, k| {
            let (i, j) = (f64::from(2 * k + first - 1), f64::from(2 * k + first));
            one - (x2 * sum).over(DoubleDouble::from(i * j))
        })
    };
    // 1 - cos instead of cos: doubling would lose the digits of a sine that is small.
    let (mut sin, mut cos) = (x * series(1), series(0));
    for _ in 0..6 {
        (sin, cos) = (DoubleDouble::from(2.0) * sin * cos, one - DoubleDouble::from(2.0) * sin * sin);
    }
    (sin, cos)
}

/// The angle of `(x, y)` from the x axis, for `y` of 0 or more.
pub(crate) fn arctan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let about = y.high.atan2(x.high);
    let radius = (x * x + y * y).sqrt();
    if radius.high == 0.0 {
        return DoubleDouble::default();
    }
    // The sine of what is missing is what is missing: its cube is below 1e-45.
    let (sin, cos) = sin_cos(about);
    DoubleDouble::from(about) + (y * cos - x * sin).over(radius)
}

/// Signed solid angle in steradians of a triangle seen from the origin; positive when `a·(b×c) > 0`, 0 when it is 0.
pub(crate) fn solid_angle(corners: [[f64; 3]; 3]) -> f64 {
    of_angle(corners.map(point))
}

fn of_angle([a, b, c]: [Point; 3]) -> f64 {
    let triple = DoubleDouble::dot(a, DoubleDouble::cross(b, c));
    if triple.high == 0.0 {
        return 0.0;
    }
    let (la, lb, lc) = (length(a), length(b), length(c));
    let denominator =
        la * lb * lc + DoubleDouble::dot(a, b) * lc + DoubleDouble::dot(a, c) * lb + DoubleDouble::dot(b, c) * la;
    let half = arctan2(if triple.high < 0.0 { -triple } else { triple }, denominator).high;
    (2.0 * half).copysign(triple.high)
}

/// Where a point of weights `(b1, b2)` lies, in shares of the solid angle: on the first corner's side of the line from the second
/// corner through the point, and of a narrow wedge about that line, before the point.
pub(crate) fn shares(corners: [[f64; 3]; 3], [b1, b2]: [f64; 2]) -> [f64; 2] {
    let one = DoubleDouble::from(1.0);
    let towards = one - DoubleDouble::from(b1);
    let share = DoubleDouble::from(b2).over(towards);
    let [a, b, c] = corners.map(point);
    let mixed = |p: Point, q: Point, t: DoubleDouble| -> Point { array::from_fn(|x| p[x] + (q[x] - p[x]) * t) };
    let end = mixed(a, c, share);
    let at = mixed(b, end, towards);
    // Half-chords: (1 - cos) / 2 of an angle is its half's squared sine.
    let zone = |to: Point| {
        let (cross, dot) = (length(DoubleDouble::cross(b, to)), DoubleDouble::dot(b, to));
        let (sine, _) = sin_cos(0.5 * arctan2(cross, dot).high);
        (sine * sine).high
    };
    [of_angle([a, b, end]) / of_angle([a, b, c]), zone(at) / zone(end)]
}

/// Irradiance for unit radiance of a triangle that shines to both sides, clipped at the horizon of a unit `normal`.
pub(crate) fn irradiance(corners: [[f64; 3]; 3], normal: [f64; 3]) -> f64 {
    let (corners, normal) = (corners.map(point), point(normal));
    let height = |p: Point| DoubleDouble::dot(normal, p);
    let above: Vec<Point> = (0..3)
        .flat_map(|i| {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            let (h, k) = (height(from), height(to));
            let crossing = (h.high < 0.0) != (k.high < 0.0);
            let share = || h.over(h - k);
            [
                (h.high >= 0.0).then_some(from),
                crossing.then(|| array::from_fn(|x| from[x] + (to[x] - from[x]) * share())),
            ]
        })
        .flatten()
        .collect();
    let edges = (0..above.len()).map(|i| {
        let (from, to) = (above[i], above[(i + 1) % above.len()]);
        let cross = DoubleDouble::cross(from, to);
        let sine = length(cross);
        if sine.high == 0.0 {
            return DoubleDouble::default();
        }
        arctan2(sine, DoubleDouble::dot(from, to)) * height(cross).over(sine)
    });
    (0.5 * edges.fold(DoubleDouble::default(), |sum, edge| sum + edge).high).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_has_thirty_digits() {
        // pi = 3.14159265358979311600 (f64) + 1.2246467991473532e-16
        let right = arctan2(DoubleDouble::from(1.0), DoubleDouble::from(0.0));
        assert_eq!(2.0 * right.high, std::f64::consts::PI);
        assert!((2.0 * right.low / 1.224_646_799_147_353_2e-16 - 1.0).abs() < 1e-13, "{right:?}");
    }

    #[test]
    fn an_octant_is_half_pi_and_sends_a_quarter_of_it() {
        let octant = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!((solid_angle(octant) - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!((irradiance(octant, [0.0, 0.0, 1.0]) - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
    }
}
