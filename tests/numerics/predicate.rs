//! On which side of an edge does a line pass? Exactly, whatever finite f32 the numbers are.
//!
//! f64 says so where its rounding cannot turn the sign. Where it can, the determinant is multiplied out into products of
//! three f32 numbers, and these are summed without rounding, in an integer as wide as all their exponents.
//!
//! Source: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", Discrete &
//! Computational Geometry 18, 1997, for the filter; Kulisch and Miranker, "The Arithmetic of the Digital Computer", SIAM
//! Review 28(1), 1986, for the sum.

use glam::{DVec3, Vec3};

/// The determinant of `direction`, `a - origin` and `b - origin`, but for its last digits; zero and its sign are exact.
///
/// Of two edges of a triangle, taken around it, the line through `origin` passes on the same side where the signs are equal.
pub(super) fn side(direction: Vec3, origin: Vec3, a: Vec3, b: Vec3) -> f64 {
    let [d, o, p, q] = [direction, origin, a, b].map(Vec3::as_dvec3);
    let (u, v) = (p - o, q - o);
    let rounded = d.dot(u.cross(v));
    // Seven roundings, of 2^-53 each, to what is summed at most.
    let parts = d.abs().dot(DVec3::new(
        (u.y * v.z).abs() + (u.z * v.y).abs(),
        (u.z * v.x).abs() + (u.x * v.z).abs(),
        (u.x * v.y).abs() + (u.y * v.x).abs(),
    ));
    if rounded.abs() > 1e-15 * parts { rounded } else { exact_side(direction, origin, a, b) }
}

fn exact_side(d: Vec3, o: Vec3, a: Vec3, b: Vec3) -> f64 {
    let mut sum = Sum([0; DIGITS]);
    // (a - o) x (b - o) = a x b - a x o - o x b.
    for (p, q, sign) in [(a, b, 1.0), (a, o, -1.0), (o, b, -1.0)] {
        for axis in 0..3 {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            sum.add([sign * d[axis], p[next], q[last]]);
            sum.add([-sign * d[axis], p[last], q[next]]);
        }
    }
    sum.value()
}

/// Enough for three times the exponents of f32, and for carries.
const DIGITS: usize = 30;

/// A sum of products: digits of 32 bits, the lowest first, of which the last bit stands for 2^-447.
struct Sum([i64; DIGITS]);

impl Sum {
    fn add(&mut self, factors: [f32; 3]) {
        let (mut product, mut shift, mut sign) = (1u128, 0, 1);
        for factor in factors {
            let (exponent, fraction) = ((factor.to_bits() >> 23) & 0xff, factor.to_bits() & 0x7f_ffff);
            product *= u128::from(if exponent == 0 { fraction } else { fraction | 0x80_0000 });
            // In multiples of the smallest f32, 2^-149.
            shift += exponent.max(1) - 1;
            sign *= if factor.is_sign_negative() { -1 } else { 1 };
        }
        let mut product = product << (shift % 32);
        for digit in &mut self.0[(shift / 32) as usize..][..4] {
            *digit += sign * (product & 0xffff_ffff) as i64;
            product >>= 32;
        }
    }

    fn value(mut self) -> f64 {
        for i in 0..DIGITS - 1 {
            self.0[i + 1] += self.0[i] >> 32;
            self.0[i] &= 0xffff_ffff;
        }
        // All digits but the last are positive now: a negative number is turned over before its digits are summed, that its
        // largest do not cancel.
        if self.0[DIGITS - 1] < 0 {
            return -Self(self.0.map(|digit| -digit)).value();
        }
        self.0.iter().zip(0..).map(|(&digit, i)| digit as f64 * 2f64.powi(32 * i - 447)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use citylights::base::random::Stream;

    /// The determinant in integers.
    fn whole(d: [i128; 3], o: [i128; 3], a: [i128; 3], b: [i128; 3]) -> i128 {
        let (u, v) = ([0, 1, 2].map(|i| a[i] - o[i]), [0, 1, 2].map(|i| b[i] - o[i]));
        (0..3).map(|i| d[i] * (u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3])).sum()
    }

    #[test]
    fn sides_are_those_of_integers() {
        let mut stream = Stream::keyed(&[u64::from_le_bytes(*b"integers")]);
        let (mut zeros, mut small) = (0, 0);
        for nth in 0..20_000 {
            // All that f32 holds, or few numbers: then many determinants are zero.
            let most = [1 << 24, 4][nth % 2];
            let mut place = || [0; 3].map(|_| stream.below(2 * most) as i128 - most as i128);
            let (d, o, a) = (place(), place(), place());
            // A third corner on the plane of the line and the second, or next to it.
            let b = if nth % 3 == 0 { [0, 1, 2].map(|i| a[i] + d[i]) } else { place() };
            if b.iter().any(|x| x.abs() > 1 << 24) {
                continue;
            }
            let right = whole(d, o, a, b);
            zeros += u32::from(right == 0);
            small += u32::from(right != 0 && right.abs() < 1 << 50);
            // Any power of two, from far under the smallest normal f32 to near a root of the largest.
            let scale = 2f64.powi(stream.below(240) as i32 - 140) as f32;
            let [d, o, a, b] = [d, o, a, b].map(|at| Vec3::from(at.map(|x| x as f32)));
            let [o, a, b] = [o, a, b].map(|at| at * scale);
            let expected = right as f64 * f64::from(scale).powi(2);
            for given in [side(d, o, a, b), exact_side(d, o, a, b)] {
                assert!((given - expected).abs() <= 1e-13 * expected.abs(), "{given} for {expected}");
                assert_eq!(given == 0.0, right == 0);
            }
        }
        assert!(zeros > 2_000 && small > 1_000, "{zeros} zeros and {small} small ones are too easy");
    }
}
