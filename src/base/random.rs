//! Random streams: one per (seed, run, pass, pixel), so that results never depend on threads or order.
//!
//! The generator is xoshiro256++ (Blackman and Vigna, ACM TOMS 47(4), 2021), named so that numbers stay the same on
//! every platform. Keys are mixed, not added: neighbouring pixels and passes get unrelated states. Changing a PCG's
//! stream number instead would give affine copies of one sequence, correlated up to 0.29.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Stream(Xoshiro256PlusPlus);

impl Stream {
    /// The stream that belongs to a list of words; equal words give equal numbers, in any order of calls.
    pub fn keyed(words: &[u64]) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(hash(words)))
    }

    /// Uniform in `[0, 1)`, a multiple of 2^-24: never 1.
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        (self.0.next_u64() >> 40) as f32 * (1.0 / 16_777_216.0)
    }

    /// Two independent numbers in `[0, 1)` from one draw of 64 bits.
    #[inline]
    pub fn uniform2(&mut self) -> [f32; 2] {
        let bits = self.0.next_u64();
        let scale = 1.0 / 16_777_216.0;
        [(bits >> 40) as f32 * scale, ((bits >> 8) & 0xff_ffff) as f32 * scale]
    }

    /// Uniform in `[0, 1)`, a multiple of 2^-53: enough to choose among many lights.
    #[inline]
    pub fn uniform64(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// 64 random bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in `0..n`; `n` of 0 gives 0.
    #[inline]
    pub fn below(&mut self, n: usize) -> usize {
        below(self.bits(), n)
    }

    /// A stream of its own, named by 64 bits of this one.
    #[inline]
    pub(crate) fn split(&mut self) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(self.bits()))
    }

    /// The generator itself, for the distributions of `rand_distr`.
    pub fn generator(&mut self) -> &mut (impl Rng + use<>) {
        &mut self.0
    }
}

/// 64 uniform bits as a number uniform in `0..n`. The bias of the multiply-shift is below n / 2^64.
#[inline]
pub(crate) fn below(bits: u64, n: usize) -> usize {
    ((u128::from(bits) * n as u128) >> 64) as usize
}

/// What names the streams of one run: everything random in a run follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunKey {
    /// The user's seed.
    pub seed: u64,
    /// The independent run, from 0.
    pub run: u32,
}

impl RunKey {
    /// The stream of one pixel in one pass.
    #[inline]
    pub fn stream(self, pass: u32, pixel: u32) -> Stream {
        Stream::keyed(&[self.seed, (u64::from(self.run) << 32) | u64::from(pass), u64::from(pixel)])
    }
}

/// A 64-bit hash of a list of words.
#[inline]
pub(crate) fn hash(words: &[u64]) -> u64 {
    // An arbitrary odd start, so that an all-zero key does not stay zero.
    words.iter().fold(0x9e37_79b9_7f4a_7c15, |state, &word| mix(state ^ word).wrapping_add(0xd1b5_4a32_d192_ed03))
}

/// Stafford's variant 13 of the 64-bit finaliser, as used by SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
#[inline]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_keys_give_uncorrelated_streams() {
        let key = RunKey { seed: 1, run: 0 };
        let n = 4096;
        for (pass, pixel) in [(0, 1), (1, 0), (1, 1)] {
            let correlation: f64 = (0..n)
                .map(|i| {
                    let a = key.stream(2 * i, 2 * i).uniform64() - 0.5;
                    let b = key.stream(2 * i + pass, 2 * i + pixel).uniform64() - 0.5;
                    12.0 * a * b
                })
                .sum::<f64>()
                / f64::from(n);
            assert!(correlation.abs() < 4.0 / f64::from(n).sqrt(), "correlation {correlation} at ({pass}, {pixel})");
        }
    }

    #[test]
    fn uniform_stays_below_one() {
        let mut stream = Stream::keyed(&[7]);
        assert!((0..100_000).all(|_| (0.0..1.0).contains(&stream.uniform())));
    }

    #[test]
    fn below_reaches_every_value_equally() {
        let mut stream = Stream::keyed(&[3]);
        let mut counts = [0u32; 7];
        (0..70_000).for_each(|_| counts[stream.below(7)] += 1);
        let chi2: f64 = counts.iter().map(|&c| (f64::from(c) - 10_000.0).powi(2) / 10_000.0).sum();
        assert!(chi2 < 27.9, "chi-squared {chi2}, limit 27.9 (6 degrees of freedom, 1e-4), seed 3");
    }
}
