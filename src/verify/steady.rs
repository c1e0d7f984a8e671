//! Which lights are hit often enough for a t test of the estimate?

use super::truth::Truth;

/// Greatest skewness that the mean of all draws may have. Lights whose rare great weights make it worse are left out of
/// the estimate, on both sides of the comparison; the other checks still hold them.
const SKEWNESS: f64 = 0.25;

/// The lights whose part of the estimate is nearly normal after all draws, and that part's moments.
pub(super) struct Steady {
    lights: Vec<bool>,
    /// Variance and third central moment in a call, were the picks independent and always as many.
    pub(super) variance: f64,
    pub(super) third: f64,
    /// Variance of a batch's mean, were each light picked as evenly as whole numbers can be.
    pub(super) spread: f64,
}

impl Steady {
    /// Leaves out lights, those with the greatest single hits first, until the mean of all draws is no longer lopsided.
    /// Where `counts` are not `told` but seen, lights that were not seen are left out too.
    pub(super) fn new(truth: &Truth, counts: &[f32], told: bool, calls: u32, draws: f64) -> Self {
        let f = truth.lights();
        // A light of no chance at all is for the coverage check; a listed one never varies.
        let mut order: Vec<usize> = (0..f.len()).filter(|&i| counts[i] > 0.0 && counts[i] < 0.5).collect();
        let hit = |i: usize| f[i] / f64::from(counts[i]);
        order.sort_by(|&a, &b| hit(b).total_cmp(&hit(a)));
        let total: f64 = order.iter().map(|&i| f64::from(counts[i])).sum();
        let mut lights: Vec<bool> = counts.iter().map(|&count| told || count > 0.0).collect();
        let mut left_out = 0;
        loop {
            let kept = &order[left_out..];
            let mean = kept.iter().map(|&i| f[i]).sum::<f64>() / total;
            let gone: f64 = order[..left_out].iter().map(|&i| f64::from(counts[i])).sum();
            // Picks of lights that are left out add 0.
            let (mut variance, mut third) = (gone * mean * mean, -gone * mean * mean * mean);
            for &i in kept {
                let (count, off) = (f64::from(counts[i]), hit(i) - mean);
                variance += count * off * off;
                third += count * off * off * off;
            }
            // Variance below rounding, as where lights are chosen by exactly what they add, is none.
            let flat = variance <= 1e-10 * mean * mean * total;
            if kept.is_empty() || flat || third.abs() <= SKEWNESS * variance.powf(1.5) * draws.sqrt() {
                let (variance, third) = if kept.is_empty() || flat { (0.0, 0.0) } else { (variance, third) };
                let spread = spread(f, counts, &lights, calls);
                return Self { lights, variance, third, spread };
            }
            // A thirty-second at a time keeps this near linear in the lights.
            let step = (kept.len() / 32).max(1);
            order[left_out..left_out + step].iter().for_each(|&i| lights[i] = false);
            left_out += step;
        }
    }

    /// Whether a light is among them.
    pub(super) fn holds(&self, light: usize) -> bool {
        self.lights[light]
    }
}

/// Variance of the mean over `calls` calls, were each light picked one of the two whole numbers of times around its
/// expectation: what numbers that are spread evenly leave, and batches may by luck not show.
fn spread(f: &[f64], counts: &[f32], lights: &[bool], calls: u32) -> f64 {
    let picked = || (0..f.len()).filter(|&i| counts[i] > 0.0);
    let value = |i: usize| if lights[i] { f[i] } else { 0.0 };
    let total: f64 = picked().map(|i| f64::from(counts[i])).sum();
    let mean = picked().map(value).sum::<f64>() / total.max(f64::MIN_POSITIVE);
    let calls = f64::from(calls);
    picked()
        .map(|i| {
            let count = f64::from(counts[i]);
            let off = value(i) / count - mean;
            // Only the part that rounding leaves: a listed light has none.
            if count >= 1.0 { 0.0 } else { toss(count * calls) * off * off }
        })
        .sum::<f64>()
        / (calls * calls)
}

/// Variance of a toss between the two whole numbers around `mean`.
pub(super) fn toss(mean: f64) -> f64 {
    let part = mean.fract();
    part * (1.0 - part)
}
