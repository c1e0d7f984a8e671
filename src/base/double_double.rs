//! What is a sum of products when f64 has too few digits?
//!
//! A [`DoubleDouble`] is the unevaluated sum of two f64 numbers: 31 decimal digits, twenty times the price. For the rare case
//! that cancels, and for checks.
//!
//! Source: Dekker, Numerische Mathematik 18, 1971; Knuth, The Art of Computer Programming 2, 4.2.2, for the sum.

use std::ops::{Add, Mul, Neg, Sub};

/// A number as `high + low`, where `low` is at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DoubleDouble {
    /// The number, rounded to f64.
    pub high: f64,
    /// What is missing.
    pub low: f64,
}

/// The sum of two numbers and what it lacks.
#[inline]
fn sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    DoubleDouble { high, low: (a - (high - part)) + (b - part) }
}

/// The same for `|a| >= |b|`.
#[inline]
fn sum_ordered(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// A number's upper 26 bits and its lower ones.
#[inline]
fn halves(a: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * a; // 2^27 + 1
    let upper = shifted - (shifted - a);
    (upper, a - upper)
}

/// The product of two numbers and what it lacks.
#[inline]
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let ((au, al), (bu, bl)) = (halves(a), halves(b));
    DoubleDouble { high, low: al * bl - (((high - au * bu) - al * bu) - au * bl) }
}

impl DoubleDouble {
    /// The square root; 0 of what is not positive.
    pub(crate) fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::default();
        }
        // One step of Newton's from the f64 root doubles its digits.
        let root = self.high.sqrt();
        sum_ordered(root, (self - product(root, root)).high / (2.0 * root))
    }

    /// The quotient.
    pub(crate) fn over(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        let quotient = sum_ordered(first, second);
        quotient + (rest.high / other.high).into()
    }

    /// Scalar product of two vectors.
    pub(crate) fn dot(a: [Self; 3], b: [Self; 3]) -> Self {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// Cross product of two vectors.
    pub(crate) fn cross(a: [Self; 3], b: [Self; 3]) -> [Self; 3] {
        let at = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
        [at(1, 2), at(2, 0), at(0, 1)]
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let DoubleDouble { high, low: rest } = sum_ordered(high.high, high.low + low.high);
        sum_ordered(high, rest + low.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let DoubleDouble { high, low } = product(self.high, other.high);
        sum_ordered(high, low + (self.high * other.low + self.low * other.high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_beyond_f64_survive() {
        let tiny = 2f64.powi(-80);
        let number = DoubleDouble::from(1.0) + tiny.into();
        assert_eq!((number - 1.0.into()).high, tiny);
        // (1 + e)(1 - e) - 1 = -e^2
        let e = 2f64.powi(-50);
        let cancelled = DoubleDouble::from(1.0 + e) * (1.0 - e).into() - 1.0.into();
        assert_eq!(cancelled.high, -e * e);
    }

    #[test]
    fn roots_and_quotients_come_back() {
        for value in [2.0, 3e-40, 7.7e55, 1.0 / 3.0] {
            let root = DoubleDouble::from(value).sqrt();
            assert!(((root * root - value.into()).high / value).abs() < 1e-31, "{value}");
            let third = DoubleDouble::from(value).over(3.0.into());
            assert!(((third * 3.0.into() - value.into()).high / value).abs() < 1e-31, "{value}");
        }
        assert_eq!(DoubleDouble::from(0.0).sqrt(), DoubleDouble::default());
    }
}
