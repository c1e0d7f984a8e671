//! Which numbers does a sample get: independent ones, or ones spread evenly over a pixel's passes?
//!
//! Each number alone is uniform and each sample alone unbiased, whatever the [`Points`]: sequences are rotated or
//! scrambled anew for each run and pixel. Spread evenly, the numbers of many passes leave no gaps, so that their mean
//! is more certain; a single pass gains nothing. Passes of one run and pixel are then no longer independent of one
//! another: whoever needs independent estimates takes several runs.

use super::random::{RunKey, Stream, hash};

/// How the numbers of a pixel are spread over its passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Points {
    /// Independent.
    #[default]
    Random,
    /// Owen-scrambled Sobol points (Burley, JCGT 9(4), 2020).
    Sobol,
    /// Multiples of irrational numbers, rotated (Cranley and Patterson, SIAM J. Numer. Anal. 13(6), 1976): of the
    /// golden ratio for choices, of the powers of the plastic number for points on lights (Roberts' R2, 2018).
    R2,
}

impl Points {
    /// All of them, in the order of [`NAMES`](Self::NAMES).
    pub const ALL: [Self; 3] = [Self::Random, Self::Sobol, Self::R2];
    /// What they are called.
    pub const NAMES: [&str; 3] = ["random", "sobol", "r2"];
}

/// 2^64 over the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
/// 2^64 over the plastic number and over its square.
const PLASTIC: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1d];

/// The sequences of one pixel in one run.
#[derive(Clone, Copy, Debug)]
pub struct Sequence {
    key: RunKey,
    pixel: u32,
    points: Points,
    /// Names the rotation or scrambling.
    name: u64,
}

impl Sequence {
    /// The sequences of a pixel.
    #[inline]
    pub fn new(key: RunKey, pixel: u32, points: Points) -> Self {
        let words = [key.seed, u64::from(key.run), u64::from(pixel), u64::from_le_bytes(*b"sequence")];
        let name = if points == Points::Random { 0 } else { hash(&words) };
        Self { key, pixel, points, name }
    }

    /// The numbers of one pass.
    #[inline]
    pub fn pass(&self, pass: u32) -> Draws {
        Draws { of: *self, pass, stream: None, index: u64::from(pass) }
    }
}

/// The numbers of one call of a sampler.
#[derive(Clone, Debug)]
pub struct Draws {
    of: Sequence,
    pass: u32,
    /// Made when it is first needed: most choices by R2 do without.
    stream: Option<Stream>,
    /// The place in the sequence: the pass, refined where calls are nested.
    index: u64,
}

impl Draws {
    /// The `j`-th of the `of` choices that this call makes, as 64 bits: enough to choose among many lights.
    ///
    /// Over a pixel's passes all its choices are one sequence. So they may be used for terms that are added or for
    /// candidates of one choice; two numbers that are to span a plane must not both come from here.
    #[inline]
    pub fn choice_bits(&mut self, j: u32, of: u32) -> u64 {
        let index = self.index * u64::from(of) + u64::from(j);
        match self.of.points {
            Points::Random => self.stream().bits(),
            Points::R2 => self.of.name.wrapping_add(index.wrapping_mul(GOLDEN)),
            // 23 bits from the sequence, the rest at random below them.
            Points::Sobol => {
                let high = (sobol(index, 0, self.of.name) * 8_388_608.0) as u64;
                (high << 41) | (self.stream().bits() >> 23)
            }
        }
    }

    /// [`choice_bits`](Self::choice_bits) as a number in `[0, 1)`, a multiple of 2^-53.
    #[inline]
    pub fn choice(&mut self, j: u32, of: u32) -> f64 {
        (self.choice_bits(j, of) >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// A point in `[0, 1)^2` for the pick in place `slot` of this call.
    #[inline]
    pub fn point(&mut self, slot: u32) -> [f32; 2] {
        match self.of.points {
            Points::Random => self.stream().uniform2(),
            Points::R2 => {
                // Of its own for each place, so that the points of several picks are independent of one another.
                let turn = hash(&[self.of.name, u64::from(slot)]);
                let at = |start: u64, step: u64| {
                    (start.wrapping_add(self.index.wrapping_mul(step)) >> 40) as f32 * (1.0 / 16_777_216.0)
                };
                [at(turn, PLASTIC[0]), at(turn << 32, PLASTIC[1])]
            }
            Points::Sobol => {
                // The first place shares its scrambling with the choice: three dimensions of one sequence.
                let name = if slot == 0 { self.of.name } else { hash(&[self.of.name, u64::from(slot)]) };
                [sobol(self.index, 1, name), sobol(self.index, 2, name)]
            }
        }
    }

    /// A point in `[0, 1)^2` for what `name` names in this call: it depends on no other draw, so that leaving others
    /// out does not change it. As a place, a name must not be that of a [`point`](Self::point).
    #[inline]
    pub fn point_of(&mut self, name: u32) -> [f32; 2] {
        match self.of.points {
            Points::Random => {
                let RunKey { seed, run } = self.of.key;
                let words = [seed, u64::from(run), u64::from(self.of.pixel), self.index, u64::from(name)];
                Stream::keyed(&words).uniform2()
            }
            Points::R2 | Points::Sobol => self.point(name),
        }
    }

    /// Independent numbers.
    #[inline]
    pub fn stream(&mut self) -> &mut Stream {
        self.stream.get_or_insert_with(|| self.of.key.stream(self.pass, self.of.pixel))
    }

    /// Lets another sampler make the `j`-th of `of` calls within this one.
    #[inline]
    pub fn nested<R>(&mut self, j: u32, of: u32, call: impl FnOnce(&mut Self) -> R) -> R {
        let outer = self.index;
        self.index = outer * u64::from(of) + u64::from(j);
        let result = call(self);
        self.index = outer;
        result
    }
}

/// A coordinate of an Owen-scrambled Sobol point. The library's sequence ends after 2^16 points: each such block is
/// scrambled anew.
fn sobol(index: u64, dimension: u32, name: u64) -> f32 {
    sobol_burley::sample((index & 0xffff) as u32, dimension, hash(&[name, index >> 16]) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draws(points: Points, run: u32, pass: u32) -> Draws {
        Sequence::new(RunKey { seed: 4, run }, 17, points).pass(pass)
    }

    #[test]
    fn every_number_alone_is_uniform_over_runs() {
        for points in Points::ALL {
            // Third pass, second of three choices, second place.
            let mut counts = [[0u32; 16]; 3];
            for run in 0..32_000 {
                let mut draws = draws(points, run, 2);
                let [u, v] = draws.point(1);
                for (counts, x) in counts.iter_mut().zip([draws.choice(1, 3), f64::from(u), f64::from(v)]) {
                    counts[(x * 16.0) as usize] += 1;
                }
            }
            for counts in counts {
                let chi2: f64 = counts.iter().map(|&c| (f64::from(c) - 2_000.0).powi(2) / 2_000.0).sum();
                assert!(chi2 < 44.3, "{points:?}: chi-squared {chi2}, limit 44.3 (15 degrees of freedom, 1e-4)");
            }
        }
    }

    #[test]
    fn numbers_of_many_passes_leave_no_gaps() {
        for (points, widest) in [(Points::R2, 3.0), (Points::Sobol, 2.0)] {
            let n = 256;
            let mut choices: Vec<f64> = (0..n).map(|pass| draws(points, 3, pass).choice(0, 1)).collect();
            choices.sort_by(f64::total_cmp);
            let gap = choices.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            assert!(gap * f64::from(n) <= widest, "{points:?}: a gap of {gap}");
            // Each of 8 x 8 squares gets about 4 of 256 points.
            let mut squares = [0u32; 64];
            for pass in 0..n {
                let [u, v] = draws(points, 3, pass).point(0);
                squares[(u * 8.0) as usize * 8 + (v * 8.0) as usize] += 1;
            }
            assert!(squares.iter().all(|&count| (1..=8).contains(&count)), "{points:?}: {squares:?}");
        }
    }

    #[test]
    fn nested_calls_share_the_outer_sequence() {
        for points in [Points::R2, Points::Sobol] {
            let mut outer = draws(points, 0, 5);
            let inner = outer.nested(2, 4, |draws| draws.choice(0, 1));
            let direct = outer.choice(2, 4);
            // The bits below a Sobol number's own 23 are random.
            assert!((inner - direct).abs() < 2e-7, "{points:?}: {inner} and {direct}");
        }
    }
}
