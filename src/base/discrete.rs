//! Choosing one of many by weight: alias tables for fixed weights, cumulative sums for weights of the moment.

use crate::base::error::{Error, Result};

/// One column of an alias table: the 32-bit threshold below which the column itself is taken, and the other choice.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Column {
    keep: u32,
    alias: u32,
}

/// Weighted choice in constant time.
///
/// Built in f64 (an f32 build leaves probabilities off by up to 0.9 % at 200,000 entries) and drawn with 64 bits: the
/// high half of `bits * n` is the column, its low half the threshold. The stored probabilities are the *realised* ones,
/// after thresholds were rounded to 2^-32: an entry with a positive weight keeps a positive chance.
///
/// Source: Walker 1977; built as Vose, IEEE Trans. Softw. Eng. 17(9), 1991.
#[derive(Clone, Debug)]
pub struct AliasTable {
    columns: Vec<Column>,
    pmf: Vec<f32>,
}

impl AliasTable {
    /// A table over `weights`, which need not add up to 1.
    ///
    /// # Errors
    /// No weights, or only 0; a weight that is negative, infinite or no number.
    pub fn new(weights: &[f64]) -> Result<Self> {
        let n = weights.len();
        let total: f64 = weights.iter().sum();
        if n == 0 || n > u32::MAX as usize || !total.is_finite() || total <= 0.0 || weights.iter().any(|&w| w < 0.0) {
            return Err(Error::Invalid(format!(
                "an alias table needs finite weights of 0 or more with a positive sum; the {n} given sum to {total}"
            )));
        }
        let mut scaled: Vec<f64> = weights.iter().map(|w| w / total * n as f64).collect();
        let (mut under, mut over): (Vec<u32>, Vec<u32>) = (0..n as u32).partition(|&i| scaled[i as usize] < 1.0);
        let mut columns: Vec<Column> = (0..n as u32).map(|i| Column { keep: u32::MAX, alias: i }).collect();
        while let (Some(&small), Some(&large)) = (under.last(), over.last()) {
            under.pop();
            let share = scaled[small as usize];
            columns[small as usize] = Column { keep: threshold(share), alias: large };
            scaled[large as usize] -= 1.0 - share;
            if scaled[large as usize] < 1.0 {
                over.pop();
                under.push(large);
            }
        }
        // What is left over is 1 but for rounding: its column keeps everything (alias = itself).
        let mut pmf = vec![0.0f64; n];
        for (i, column) in columns.iter().enumerate() {
            let keep = f64::from(column.keep) / 4_294_967_296.0;
            pmf[i] += keep;
            pmf[column.alias as usize] += 1.0 - keep;
        }
        let pmf = pmf.iter().map(|p| (p / n as f64) as f32).collect();
        Ok(Self { columns, pmf })
    }

    /// The entry that 64 uniform bits choose.
    #[inline]
    pub fn pick(&self, bits: u64) -> usize {
        let product = u128::from(bits) * self.columns.len() as u128;
        let index = (product >> 64) as usize;
        let column = self.columns[index];
        if ((product as u64) >> 32) as u32 >= column.keep { column.alias as usize } else { index }
    }

    /// The probability that [`pick`](Self::pick) gives `index`.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        self.pmf[index]
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.columns[..]) + size_of_val(&self.pmf[..])
    }
}

/// A share in `[0, 1)` as a 32-bit threshold; a positive share stays positive.
fn threshold(share: f64) -> u32 {
    let scaled = (share * 4_294_967_296.0).min(f64::from(u32::MAX)) as u32;
    if share > 0.0 { scaled.max(1) } else { scaled }
}

/// Weighted choice by a running sum, for weights that are known only at the place of use; storage is reused.
///
/// The sum runs in f64: in f32 a sixth of 10^6 log-normal weights add nothing and can never be chosen.
#[derive(Clone, Debug, Default)]
pub struct Cumulative {
    ends: Vec<f64>,
}

impl Cumulative {
    /// Forgets all weights and keeps the storage.
    #[inline]
    pub fn clear(&mut self) {
        self.ends.clear();
    }

    /// Makes room for so many weights.
    #[inline]
    pub fn reserve(&mut self, weights: usize) {
        self.ends.reserve(weights.saturating_sub(self.ends.len()));
    }

    /// Appends a weight of 0 or more. One that is no number makes every probability none, and no panic.
    #[inline]
    pub fn push(&mut self, weight: f32) {
        self.ends.push(self.total() + f64::from(weight));
    }

    /// The sum of all weights.
    #[inline]
    pub fn total(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// The index that `u` in `[0, 1)` chooses, never one of weight 0, and its probability; `None` if all are 0.
    #[inline]
    pub fn pick(&self, u: f64) -> Option<(usize, f64)> {
        self.pick_stretched(u).map(|(index, pmf, _)| (index, pmf))
    }

    /// As [`pick`](Self::pick), with what is left of `u`: uniform in `[0, 1)` again, of as many digits less.
    #[inline]
    pub fn pick_stretched(&self, u: f64) -> Option<(usize, f64, f64)> {
        let total = self.total();
        if total <= 0.0 {
            return None;
        }
        let target = u * total;
        // Strictly above the target: an entry of weight 0 ends where the one before it does and is never first.
        // Rounding can bring the target up to the total; the last entry that adds something is then the choice.
        let index = self.ends.partition_point(|&end| end <= target);
        let index = if index < self.ends.len() { index } else { self.ends.partition_point(|&end| end < total) };
        let start = if index == 0 { 0.0 } else { self.ends[index - 1] };
        let left = (target - start) / (self.ends[index] - start);
        Some((index, self.pmf(index), left.clamp(0.0, 1.0 - f64::EPSILON / 2.0)))
    }

    /// The probability that [`pick`](Self::pick) gives `index`; 0 if all weights are 0.
    #[inline]
    pub fn pmf(&self, index: usize) -> f64 {
        let start = if index == 0 { 0.0 } else { self.ends[index - 1] };
        let total = self.total();
        if total > 0.0 { (self.ends[index] - start) / total } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    #[test]
    fn alias_table_realises_its_probabilities() {
        // Log-uniform over 18 orders of magnitude: the implied probability of each entry must be the stored one.
        let mut stream = Stream::keyed(&[5]);
        let weights: Vec<f64> = (0..10_000).map(|_| 10f64.powf(stream.uniform64() * 18.0 - 6.0)).collect();
        let table = AliasTable::new(&weights).expect("positive weights");
        let total: f64 = weights.iter().sum();
        for (i, w) in weights.iter().enumerate() {
            let (stored, wanted) = (f64::from(table.pmf(i)), w / total);
            assert!(stored > 0.0, "entry {i} of weight {w} can never be chosen");
            assert!(
                (stored - wanted).abs() <= 1e-6 * wanted + 2.0 / 4_294_967_296.0,
                "entry {i}: {stored} for {wanted}"
            );
        }
        let sum: f64 = (0..weights.len()).map(|i| f64::from(table.pmf(i))).sum();
        assert!((sum - 1.0).abs() < 1e-6, "sum {sum}");
    }

    #[test]
    fn alias_table_draws_follow_it() {
        let table = AliasTable::new(&[1.0, 0.0, 3.0, 4.0]).expect("positive weights");
        let mut stream = Stream::keyed(&[9]);
        let mut counts = [0u32; 4];
        (0..80_000).for_each(|_| counts[table.pick(stream.bits())] += 1);
        assert_eq!(counts[1], 0);
        let chi2: f64 =
            [(0, 1e4), (2, 3e4), (3, 4e4)].iter().map(|&(i, e)| (f64::from(counts[i]) - e).powi(2) / e).sum();
        assert!(chi2 < 18.4, "chi-squared {chi2}, limit 18.4 (2 degrees of freedom, 1e-4), seed 9");
    }

    #[test]
    fn bad_weights_are_refused() {
        for weights in [&[][..], &[0.0, 0.0], &[f64::NAN], &[1.0, -0.5], &[f64::INFINITY]] {
            assert!(AliasTable::new(weights).is_err(), "{weights:?}");
        }
    }

    #[test]
    fn cumulative_never_picks_a_weight_of_zero() {
        let mut sums = Cumulative::default();
        [0.0, 2.0, 0.0, 0.0, 1.0, 0.0].into_iter().for_each(|w| sums.push(w));
        for u in [0.0, 0.3, 2.0 / 3.0, 0.9, 1.0 - f64::EPSILON, 1.0] {
            let (index, p) = sums.pick(u).expect("positive total");
            assert!(index == 1 && (p - 2.0 / 3.0).abs() < 1e-12 || index == 4, "{index} at {u}");
        }
        sums.clear();
        assert!(sums.pick(0.5).is_none());
    }
}
