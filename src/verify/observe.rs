//! What does a sampler do, seen from outside: many draws at a few receivers.

use super::Subject;
use super::truth::{Truth, grey};
use crate::base::statistics::Moments;
use crate::render::exact::shadowed;
use crate::scene::receiver::Receiver;
use crate::strategy::erased::PickBuffer;

/// Lights expected fewer times than this in all draws share a bin of the weights check.
const BIN: f64 = 30.0;

/// Lights expected fewer times than this are left out of the estimate, on both sides of the comparison: the mean of a
/// handful of great weights is far from normal.
const FREQUENT: f64 = 100.0;

/// From so many expected picks on, the variance measured between batches is trusted alone.
pub(super) const PLENTY: f64 = 1_000.0;

/// One receiver and all that was seen there.
pub(super) struct Site {
    pub(super) at: Receiver,
    pub(super) truth: Truth,
    /// As the sampler tells it: expected picks a call.
    pub(super) expected: Option<Vec<f32>>,
    /// Calls a batch and batches.
    pub(super) calls: u32,
    pub(super) batches: u32,
    /// Of each batch, a call: picks; picks of lights that add something; the sum over those of weight times
    /// expected count, less one; the estimate from frequent lights.
    pub(super) picks: Moments,
    pub(super) contributing: Moments,
    pub(super) excess: Moments,
    pub(super) frequent: Moments,
    /// The sum that `frequent` should be, over the repetitions of the truth, and the variance that its rarest lights
    /// must have.
    pub(super) wanted: Moments,
    pub(super) rare_variance: f64,
    pub(super) bins: Vec<Bin>,
    /// Greatest |weight * expected count - 1| of a pick, and its light.
    pub(super) worst_reciprocal: (f64, u32),
    /// Whether each light was ever picked.
    pub(super) seen: Vec<bool>,
    /// The estimate of each batch, from frequent lights and from all, for the mean over receivers.
    pub(super) batch_frequent: Vec<f64>,
    pub(super) batch_whole: Vec<f64>,
}

/// Lights that are tested together.
#[derive(Clone, Default)]
pub(super) struct Bin {
    /// Expected sum a call, and how much of its variance is left to chance: the mean of 1 - expected count.
    pub(super) expected: f64,
    pub(super) chance: f64,
    /// Of the batches, a call.
    pub(super) found: Sums,
    pub(super) first: u32,
}

/// A running mean and variance over batches.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    batch: f64,
    sum: f64,
    squares: f64,
}

impl Sums {
    fn close(&mut self) {
        self.sum += self.batch;
        self.squares += self.batch * self.batch;
        self.batch = 0.0;
    }

    /// The moments of the batches' values divided by the calls of a batch.
    pub(super) fn moments(&self, batches: u32, calls: u32) -> Moments {
        let (n, calls) = (f64::from(batches), f64::from(calls));
        let mean = self.sum / n;
        let variance = ((self.squares - n * mean * mean) / (n - 1.0).max(1.0)).max(0.0);
        Moments { n: batches as usize, mean: mean / calls, variance: variance / (calls * calls) }
    }
}

impl Site {
    /// All calls together.
    pub(super) fn draws(&self) -> f64 {
        f64::from(self.calls) * f64::from(self.batches)
    }
}

/// Draws at every receiver of the subject.
pub(super) fn sites(subject: &Subject<'_>) -> Vec<Site> {
    subject.receivers.iter().map(|at| site(subject, at)).collect()
}

fn site(subject: &Subject<'_>, at: &Receiver) -> Site {
    let (stage, options, key) = (subject.stage, subject.options, subject.key());
    let lights = stage.scene().lights();
    let truth = Truth::new(stage, at, options.points, options.seed);
    let mut counts = vec![0.0f32; lights.len()];
    let expected = subject.sampler.expected_counts(at, &mut counts).then_some(counts);
    let mut worker = subject.sampler.worker();
    let mut buffer = PickBuffer::default();
    // A first look, to share the draws out: its passes come again below.
    worker.fill(&[*at], 0..8, key, true, &mut buffer);
    let a_call = (buffer.len() as f64 / 8.0).max(1.0);
    let batches = options.batches.max(2);
    let calls = ((options.draws as f64 / a_call / f64::from(batches)).ceil() as u32).max(1);
    let draws = f64::from(calls) * f64::from(batches);
    let (mut bins, bin_of) = bins(&truth, expected.as_deref(), draws);
    let often = |light: usize| {
        expected.as_ref().is_none_or(|counts| f64::from(counts[light]) * draws >= FREQUENT) || truth.lights()[light] == 0.0
    };
    let (mut picks, mut contributing, mut excess) = (Vec::new(), Vec::new(), Vec::new());
    let (mut whole, mut frequent) = (Vec::new(), Vec::new());
    let mut worst_reciprocal = (0.0f64, 0);
    let mut seen = vec![false; lights.len()];
    let mut rays = 0;
    for batch in 0..batches {
        worker.fill(&[*at], batch * calls..(batch + 1) * calls, key, true, &mut buffer);
        let [mut n_contributing, mut sum_excess, mut sum_whole, mut sum_frequent] = [0.0f64; 4];
        for pick in buffer.calls().flatten() {
            let (id, weight) = (pick.light as usize, f64::from(pick.weight));
            seen[id] = true;
            let light = &lights[id];
            let value = truth.of_delta(pick.light, light.kind()).unwrap_or_else(|| {
                grey(shadowed(stage, at, light, pick.uv, &mut rays))
            });
            sum_whole += weight * value;
            if often(id) {
                sum_frequent += weight * value;
            }
            let adds = truth.adds(id);
            n_contributing += f64::from(u8::from(adds));
            let mut unit = 1.0;
            if let Some(counts) = &expected {
                unit = f64::from(counts[id]);
                let off = (weight * unit - 1.0).abs();
                if off > worst_reciprocal.0 {
                    worst_reciprocal = (off, pick.light);
                }
                if adds {
                    sum_excess += weight * unit - 1.0;
                }
            }
            if let Some(bin) = bins.get_mut(bin_of[id] as usize) {
                bin.found.batch += weight * unit;
            }
        }
        bins.iter_mut().for_each(|bin| bin.found.close());
        let a_call = 1.0 / f64::from(calls);
        picks.push(buffer.len() as f64 * a_call);
        contributing.push(n_contributing * a_call);
        excess.push(sum_excess * a_call);
        whole.push(sum_whole * a_call);
        frequent.push(sum_frequent * a_call);
    }
    let wanted = truth.sum(often);
    let rare_variance = expected.as_ref().map_or(0.0, |counts| rare_variance(&truth, counts, draws));
    let of = |values: &[f64]| Moments::of(values.iter().copied());
    Site {
        at: *at,
        expected,
        calls,
        batches,
        picks: of(&picks),
        contributing: of(&contributing),
        excess: of(&excess),
        frequent: of(&frequent),
        wanted,
        rare_variance,
        bins,
        worst_reciprocal,
        seen,
        batch_frequent: frequent,
        batch_whole: whole,
        truth,
    }
}

/// Pools the lights that add something, sorted by expected count, and gives each light's bin.
///
/// A bin's statistic is the sum of weight times expected count: each pick of an honest light adds 1. Where expected
/// counts cannot be told it is the sum of weights, in eight bins by contribution.
fn bins(truth: &Truth, expected: Option<&[f32]>, draws: f64) -> (Vec<Bin>, Vec<u32>) {
    let count = |light: usize| expected.map_or(1.0, |counts| f64::from(counts[light]));
    let mut order: Vec<usize> = (0..truth.lights().len()).filter(|&i| truth.adds(i) && count(i) > 0.0).collect();
    match expected {
        Some(_) => order.sort_by(|&a, &b| count(a).total_cmp(&count(b))),
        None => order.sort_by(|&a, &b| truth.lights()[a].total_cmp(&truth.lights()[b])),
    }
    let full = if expected.is_some() { BIN } else { order.len().div_ceil(8) as f64 * draws };
    let mut bins: Vec<Bin> = Vec::new();
    let mut bin_of = vec![u32::MAX; truth.lights().len()];
    let mut left: f64 = order.iter().map(|&light| count(light)).sum();
    for light in order {
        let full_enough = bins.last().is_none_or(|bin| bin.expected * draws >= full);
        // What would not fill another joins the last.
        if bins.is_empty() || full_enough && left * draws >= full {
            bins.push(Bin { first: light as u32, ..Bin::default() });
        }
        left -= count(light);
        let at = bins.len() - 1;
        bins[at].expected += count(light);
        bins[at].chance += count(light) * (1.0 - count(light)).max(0.0);
        bin_of[light] = at as u32;
    }
    for bin in &mut bins {
        bin.chance /= bin.expected;
    }
    (bins, bin_of)
}

/// Variance of a call's estimate that comes from lights of 100 to 1,000 expected picks, which so few picks cannot be
/// trusted to show: that of independent picks, of a fixed number in all.
fn rare_variance(truth: &Truth, counts: &[f32], draws: f64) -> f64 {
    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0);
    for (f, &c) in truth.lights().iter().zip(counts) {
        let c = f64::from(c);
        if *f > 0.0 && (FREQUENT..PLENTY).contains(&(c * draws)) && c < 0.5 {
            squares += f * f / c;
            sum += f;
            count += c;
        }
    }
    if count > 0.0 { (squares - sum * sum / count).max(0.0) } else { 0.0 }
}
