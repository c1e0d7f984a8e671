//! Which angle has these sides, and what is its sine, in a third of the C library's time?
//!
//! Kept here because triangles need half a dozen of either for each sample: the C library's `atan2` alone takes 30 ns.
//! Polynomials are Chebyshev fits; errors stay below 4e-16.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_8, PI};

/// tan(pi/16), tan(pi/8) and tan(3 pi/16).
const TAN_PI_16: f64 = 0.198_912_367_379_658;
const TAN_PI_8: f64 = 0.414_213_562_373_095_03;
const TAN_3_PI_16: f64 = 0.668_178_637_919_298_9;

/// `(1 - atan(t)/t) / t^2` in powers of `t^2`, for t up to tan(pi/16): error 4e-17 in atan(t)/t.
const NEAR: [f64; 7] = [
    0.333_333_333_333_332_37,
    -0.199_999_999_997_609_9,
    0.142_857_141_888_827_23,
    -0.111_110_963_729_656_47,
    0.090_898_379_007_095_28,
    -0.076_521_309_422_432_61,
    0.059_098_572_131_161_47,
];

/// The same for t up to tan(pi/8): error 1.5e-16.
const FAR: [f64; 10] = [
    0.333_333_333_333_332_5,
    -0.199_999_999_998_984_07,
    0.142_857_142_660_966_2,
    -0.111_111_096_365_343_61,
    0.090_908_525_571_760_49,
    -0.076_910_551_583_931_5,
    0.066_496_136_952_916_69,
    -0.057_363_321_659_076_43,
    0.044_833_346_222_728_86,
    -0.022_750_526_993_361_67,
];

/// `(1 - sin(x)/x) / x^2` in powers of `x^2`, for x up to pi/2: error 1e-18.
const SINE: [f64; 8] = [
    0.166_666_666_666_666_66,
    -0.008_333_333_333_333_316,
    0.000_198_412_698_412_549_74,
    -2.755_731_921_916_323_4e-6,
    2.505_210_761_699_618_2e-8,
    -1.605_897_731_246_408_7e-10,
    7.643_970_296_798_572e-13,
    -2.731_444_766_986_399_5e-15,
];

/// The largest `t^2` that [`arctan_defect`] takes: the square of tan(pi/8).
pub(super) const DEFECT_LIMIT: f64 = 0.171_572_875_253_809_9;

/// A polynomial of ten terms or fewer, lowest power first.
///
/// In pairs of terms (Estrin's scheme), so that few multiplications wait for one another.
#[inline(always)]
fn polynomial<const N: usize>(c: &[f64; N], z: f64) -> f64 {
    const { assert!(N <= 10) };
    let term = |i: usize| if i < N { c[i] } else { 0.0 };
    let pair = |i: usize| if i + 1 < N { c[i] + z * c[i + 1] } else { term(i) };
    let z2 = z * z;
    let (low, middle, high) = (pair(0) + z2 * pair(2), pair(4) + z2 * pair(6), pair(8));
    let z4 = z2 * z2;
    if N > 8 { low + z4 * (middle + z4 * high) } else { low + z4 * middle }
}

/// The angle of `(x, y)` from the x axis, for `y` of 0 or more: within `[0, pi]`, accurate relative to itself; 0 for `(0, 0)`.
#[inline(always)]
pub(super) fn arctan2(y: f64, x: f64) -> f64 {
    // Most triangles are small. Strictly less, so that nothing over nothing is left to the other way.
    if y < TAN_PI_16 * x { small(y / x) } else { wide(y, x) }
}

/// The angle of this tangent, up to tan(pi/16) in magnitude.
#[inline(always)]
fn small(t: f64) -> f64 {
    let z = t * t;
    t - t * (z * polynomial(&NEAR, z))
}

/// As [`arctan2`], of any angle.
#[inline(never)]
fn wide(y: f64, x: f64) -> f64 {
    let width = x.abs();
    let (low, high) = if y > width { (width, y) } else { (y, width) };
    // The triangle is turned back by a multiple of pi/8 so that a short polynomial does. (Tables or masks in place of the
    // branches, which are hard to foresee: no faster.)
    let (turn_tan, turn) = if low <= TAN_PI_16 * high {
        (0.0, 0.0)
    } else if low <= TAN_3_PI_16 * high {
        (TAN_PI_8, FRAC_PI_8)
    } else {
        (1.0, FRAC_PI_4)
    };
    // The smallest number: nothing over nothing.
    let t = (low - turn_tan * high) / (high + turn_tan * low + f64::MIN_POSITIVE);
    let angle = turn + small(t);
    let angle = if y > width { FRAC_PI_2 - angle } else { angle };
    if x < 0.0 { PI - angle } else { angle }
}

/// `1 - atan(t)/t` for `z = t^2` up to [`DEFECT_LIMIT`]: of all digits, however small.
#[inline(always)]
pub(super) fn arctan_defect(z: f64) -> f64 {
    z * polynomial(&FAR, z)
}

/// The sine of an angle within `[0, pi]`.
#[inline(always)]
pub(super) fn sine(angle: f64) -> f64 {
    let x = angle.min(PI - angle);
    let z = x * x;
    x - x * z * polynomial(&SINE, z)
}

/// `x - sin(x)` for `x` within `[0, 2 pi]`, of all digits however small.
#[inline]
pub(super) fn angle_minus_sine(x: f64) -> f64 {
    if x < FRAC_PI_2 {
        let z = x * x;
        x * z * polynomial(&SINE, z)
    } else {
        x - x.sin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_and_sines_are_the_c_librarys() {
        for i in 0..400_000 {
            let angle = PI * f64::from(i) / 399_999.0;
            let (y, x) = angle.sin_cos();
            let y = y.max(0.0);
            let (found, wanted) = (arctan2(y, x), y.atan2(x));
            assert!((found - wanted).abs() <= 5e-16 * wanted.max(1e-300), "angle {wanted}: {found}");
            assert!((sine(angle) - y).abs() <= 5e-16, "sine of {angle}: {} for {y}", sine(angle));
        }
        assert_eq!(arctan2(0.0, 0.0), 0.0);
        assert_eq!(arctan2(0.0, -1.0), PI);
    }

    #[test]
    fn small_differences_keep_their_digits() {
        for exponent in 1..60 {
            let x = 0.08 * 2f64.powi(-exponent);
            let wanted = x * x / 6.0 * x * (1.0 - x * x / 20.0 * (1.0 - x * x / 42.0 * (1.0 - x * x / 72.0)));
            assert!((angle_minus_sine(x) / wanted - 1.0).abs() < 1e-13, "{x}");
            let z = x * x;
            let wanted = z * (1.0 / 3.0 - z * (0.2 - z * (1.0 / 7.0 - z * (1.0 / 9.0 - z / 11.0))));
            assert!((arctan_defect(z) / wanted - 1.0).abs() < 1e-12, "{z}");
        }
        let step = angle_minus_sine(FRAC_PI_2) - angle_minus_sine(FRAC_PI_2.next_down());
        assert!(step.abs() < 1e-15, "{step}");
    }
}
