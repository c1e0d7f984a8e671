//! Can each of many lights be chosen, as often as it should?

use super::tally::{Finding, Tally, relative};
use crate::base::discrete::{AliasTable, Cumulative};
use crate::base::random::Stream;
use rand_distr::{Distribution, StandardNormal};

/// Lights to choose from.
const LIGHTS: usize = 1_000_000;
/// Names the weights.
const SEED: u64 = 16;

/// Log-normal weights over some nine orders of magnitude.
fn weights() -> Vec<f32> {
    let mut stream = Stream::keyed(&[SEED]);
    let mut normal = || -> f64 { StandardNormal.sample(stream.generator()) };
    (0..LIGHTS).map(|_| (2.0 * normal()).exp() as f32).collect()
}

/// Relative errors of the probabilities of an f32 running sum, as textbooks write it.
fn textbook(weights: &[f32], total: f64) -> Tally {
    let mut tally = Tally::default();
    let mut sum = 0.0f32;
    let ends: Vec<f32> = weights
        .iter()
        .map(|weight| {
            sum += weight;
            sum
        })
        .collect();
    let mut start = 0.0;
    for (end, weight) in ends.iter().zip(weights) {
        let pmf = f64::from((end - start) / sum);
        tally.add_positive(pmf, relative(pmf, f64::from(*weight) / total));
        start = *end;
    }
    tally
}

/// Relative errors of a running sum's probabilities; 1 for a light that can never be chosen.
pub(super) fn cumulative() -> Finding {
    let weights = weights();
    let total: f64 = weights.iter().copied().map(f64::from).sum();
    let mut sums = Cumulative::default();
    weights.iter().for_each(|weight| sums.push(*weight));
    let mut ours = Tally::default();
    for (index, weight) in weights.iter().enumerate() {
        let pmf = sums.pmf(index);
        ours.add_positive(pmf, relative(pmf, f64::from(*weight) / total));
    }
    Finding { ours, textbook: Some(textbook(&weights, total)), limit: 1e-4 }
}

/// How far an alias table's probabilities are from the weights', over the mean probability.
pub(super) fn alias() -> Finding {
    let weights: Vec<f64> = weights().into_iter().map(f64::from).collect();
    let total: f64 = weights.iter().sum();
    let mut ours = Tally::default();
    // Weights that are finite and positive make a table; none would be no result, and fail.
    if let Ok(table) = AliasTable::new(&weights) {
        for (index, weight) in weights.iter().enumerate() {
            let (pmf, wanted) = (f64::from(table.pmf(index)), weight / total);
            let lost = if pmf > 0.0 { 0.0 } else { f64::INFINITY };
            // Thresholds are multiples of 2^-32 of the mean, and the probability is kept in f32.
            ours.add_positive(pmf, lost + (pmf - wanted).abs() / wanted.max(1.0 / LIGHTS as f64));
        }
    }
    Finding { ours, textbook: None, limit: 1e-6 }
}

/// By how much the largest of many uniform numbers reaches 1, where an index would fall off its table.
pub(super) fn uniform() -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    let mut stream = Stream::keyed(&[SEED, 18]);
    for _ in 0..LIGHTS {
        let drawn = f64::from(stream.uniform());
        ours.add_positive(drawn, if drawn < 1.0 { 0.0 } else { 1.0 });
    }
    // 32 bits over 2^32 as f32: all of the last 128 values round to 1.
    for bits in (0..LIGHTS as u32).map(|i| u32::MAX - i) {
        let drawn = f64::from(bits as f32 * (1.0 / 4_294_967_296.0));
        theirs.add_positive(drawn, if drawn < 1.0 { 0.0 } else { 1.0 });
    }
    Finding { ours, textbook: Some(theirs), limit: 0.0 }
}

#[cfg(test)]
mod tests {
    #[test]
    fn choices_are_right_and_the_textbooks_are_not() {
        for (name, finding) in
            [("cumulative", super::cumulative()), ("alias", super::alias()), ("uniform", super::uniform())]
        {
            assert!(finding.passed(), "{name}: {:e} of {:e}", finding.ours.worst(), finding.limit);
            if let Some(textbook) = finding.textbook {
                assert!(!textbook.holds(finding.limit), "{name}: the textbook is right too");
            }
        }
    }
}
