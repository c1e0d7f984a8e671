//! What does a sampler do, seen from outside: many draws at a few receivers.

use super::Subject;
use super::truth::{Truth, grey};
use crate::base::statistics::Moments;
use crate::render::exact::shadowed;
use crate::scene::receiver::Receiver;
use crate::strategy::erased::PickBuffer;

/// Lights expected fewer times than this in all draws share a bin of the weights check.
const BIN: f64 = 30.0;

/// Greatest skewness that the mean of all draws may have. Lights whose rare great weights make it worse are left out of
/// the estimate, on both sides of the comparison; the other checks still hold them.
const SKEWNESS: f64 = 0.25;

/// Batches that a t test needs at least.
const FEWEST: usize = 30;

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
    /// The sum that `frequent` should be, over the repetitions of the truth.
    pub(super) wanted: Moments,
    /// Variance and third central moment of `frequent` in one call, were the picks independent and always as many.
    pub(super) model: (f64, f64),
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
    let mut buffer = PickBuffer::default();
    let block = subject.begin(0..8);
    let mut worker = block.worker(false);
    let mut picks = |at: &Receiver| {
        worker.fill(&[*at], 0..8, true, &mut buffer);
        buffer.len() / 8
    };
    let most = subject.receivers.iter().map(&mut picks).max().unwrap_or(0);
    // A sampler that takes thousands of lights in a call has little left to chance: fewer batches will do.
    let batches = (subject.options.draws / most.max(1)).clamp(FEWEST, u32::MAX as usize) as u32;
    let batches = batches.min(subject.options.batches).max(2);
    subject.receivers.iter().map(|at| site(subject, at, batches)).collect()
}

/// Degrees of freedom of what was measured between batches.
pub(super) fn freedom(sites: &[Site]) -> usize {
    sites.first().map_or(1, |site| site.batches as usize - 1)
}

fn site(subject: &Subject<'_>, at: &Receiver, batches: u32) -> Site {
    let (stage, options) = (subject.stage, subject.options);
    let lights = stage.scene().lights();
    let truth = Truth::new(stage, at, options.points, options.seed);
    let mut counts = vec![0.0f32; lights.len()];
    let expected = subject.sampler.expected_counts(at, &mut counts).then_some(counts);
    let block = subject.begin(0..u32::MAX);
    let mut worker = block.worker(false);
    let mut buffer = PickBuffer::default();
    // A first look, to share the draws out: its passes come again below.
    worker.fill(&[*at], 0..8, true, &mut buffer);
    let a_call = (buffer.len() as f64 / 8.0).max(1.0);
    let calls = ((options.draws as f64 / a_call / f64::from(batches)).ceil() as u32).max(1);
    let draws = f64::from(calls) * f64::from(batches);
    let (mut bins, bin_of) = bins(&truth, expected.as_deref(), draws);
    let steady = expected.as_ref().map(|counts| steady(&truth, counts, draws));
    let often = |light: usize| steady.as_ref().is_none_or(|steady| steady.lights[light]);
    let (mut picks, mut contributing, mut excess) = (Vec::new(), Vec::new(), Vec::new());
    let (mut whole, mut frequent) = (Vec::new(), Vec::new());
    let mut worst_reciprocal = (0.0f64, 0);
    let mut seen = vec![false; lights.len()];
    let mut rays = 0;
    for batch in 0..batches {
        worker.fill(&[*at], batch * calls..(batch + 1) * calls, true, &mut buffer);
        let [mut n_contributing, mut sum_excess, mut sum_whole, mut sum_frequent] = [0.0f64; 4];
        for pick in buffer.calls().flatten() {
            let (id, weight) = (pick.light as usize, f64::from(pick.weight));
            seen[id] = true;
            let light = &lights[id];
            let value = truth
                .of_delta(pick.light, light.kind())
                .unwrap_or_else(|| grey(shadowed(stage, at, light, pick.uv, &mut rays)));
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
        model: steady.as_ref().map_or((0.0, 0.0), |steady| steady.moments),
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

/// The lights whose part of the estimate is nearly normal after all draws, and that part's moments in a call.
struct Steady {
    lights: Vec<bool>,
    moments: (f64, f64),
}

/// Leaves out lights, those with the greatest single hits first, until the mean of all draws is no longer lopsided.
fn steady(truth: &Truth, counts: &[f32], draws: f64) -> Steady {
    let f = truth.lights();
    // A light of no chance at all is for the coverage check; a listed one never varies.
    let mut order: Vec<usize> = (0..f.len()).filter(|&i| counts[i] > 0.0 && counts[i] < 0.5).collect();
    let hit = |i: usize| f[i] / f64::from(counts[i]);
    order.sort_by(|&a, &b| hit(b).total_cmp(&hit(a)));
    let total: f64 = order.iter().map(|&i| f64::from(counts[i])).sum();
    let mut lights = vec![true; f.len()];
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
            let moments = if kept.is_empty() || flat { (0.0, 0.0) } else { (variance, third) };
            return Steady { lights, moments };
        }
        // A thirty-second at a time keeps this near linear in the lights.
        let step = (kept.len() / 32).max(1);
        order[left_out..left_out + step].iter().for_each(|&i| lights[i] = false);
        left_out += step;
    }
}
