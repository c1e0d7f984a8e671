//! What does a sampler do, seen from outside: many draws at a few receivers.
//!
//! Each batch is an independent run, so that batches may be compared whatever the numbers of the passes within one have
//! to do with one another. Where a sampler cannot tell how often it picks a light, a run of its own, before the others,
//! shows which lights are seen often enough to be tested: a choice that does not depend on the draws it is tested by.

use super::impossible::Impossible;
use super::pool::{Bin, Pool};
use super::steady::{Steady, toss};
use super::subject::Subject;
use super::truth::{Truth, grey};
use super::unseen::{Unseen, calls_to_tell};
use crate::base::statistics::{Moments, skewness, unskewed};
use crate::render::exact::shadowed;
use crate::scene::receiver::Receiver;
use crate::strategy::{Frame, Pick, PickBuffer, blocks};
use std::ops::Range;

/// Batches that a t test needs at least; a sampler that takes thousands of lights in a call leaves little to chance.
const FEWEST: usize = 8;

/// From so many expected picks on, the variance measured between batches is trusted alone.
pub(super) const PLENTY: f64 = 1_000.0;

/// Passes that are looked at to share the draws out.
const FIRST: u32 = 8;

/// The run that shows how often a light is picked.
const PILOT: u32 = u32::MAX;

/// A light seen fewer times in it is too rare to tell how often it is picked.
const SEEN: f32 = 10.0;

/// In deeper shadow than this, lights that are hidden take the place of those that are not, and are picked by what they
/// could add: the little that is seen of resampling there says nothing of its mean.
const LIT: f64 = 0.01;

/// A pass that must be begun for a whole frame costs as much as that at so many receivers alone.
const FRAME: usize = 200;

/// One receiver and all that was seen there.
pub(super) struct Site<'a> {
    pub(super) at: Receiver,
    pub(super) truth: &'a Truth,
    /// Calls a batch and batches.
    calls: u32,
    pub(super) batches: u32,
    /// Picks a call of each light: as the sampler tells it, or as the pilot run saw it (0 where it saw too few).
    counts: Vec<f32>,
    told: bool,
    pool: Pool,
    steady: Steady,
    /// Greatest |weight * expected count - 1| of a pick, and its light.
    pub(super) worst_reciprocal: (f64, u32),
    /// Whether each light was ever picked.
    pub(super) seen: Vec<bool>,
    /// Picks that nothing can be done with.
    pub(super) impossible: Impossible,
    /// What calls come to, as far as it was not told how often each light is picked.
    unseen: Unseen,
    current: Batch,
    finished: Vec<Batch>,
}

/// What was seen at all receivers.
pub(super) struct Seen<'a> {
    pub(super) sites: Vec<Site<'a>>,
    /// Of each pass, the sum over receivers of what its call there comes to: as if the image were one receiver.
    pub(super) image: Unseen,
}

/// Sums over a batch, or their means over its calls.
#[derive(Clone, Copy, Default)]
pub(super) struct Batch {
    picks: f64,
    /// Picks of lights that add something, and the sum over those of weight times expected count, less one.
    contributing: f64,
    excess: f64,
    /// The estimate from lights that are hit often enough, and from all.
    pub(super) frequent: f64,
    pub(super) whole: f64,
}

impl Site<'_> {
    /// All calls together.
    pub(super) fn draws(&self) -> f64 {
        f64::from(self.calls) * f64::from(self.batches)
    }

    /// Expected picks a call of each light, if the sampler tells.
    pub(super) fn expected(&self) -> Option<&[f32]> {
        self.told.then_some(&self.counts)
    }

    /// Whether a light is expected to be picked, or was often enough to tell.
    pub(super) fn often(&self, light: usize) -> bool {
        self.counts[light] > 0.0
    }

    /// Moments over the batches of picks a call.
    pub(super) fn picks(&self) -> Moments {
        self.moments(|batch| batch.picks)
    }

    /// Of picks of lights that add something.
    pub(super) fn contributing(&self) -> Moments {
        self.moments(|batch| batch.contributing)
    }

    /// Of the sum over those of weight times expected count, less one.
    pub(super) fn excess(&self) -> Moments {
        self.moments(|batch| batch.excess)
    }

    /// The estimate of each batch from lights that are hit often enough.
    pub(super) fn frequent(&self) -> Vec<f64> {
        self.finished.iter().map(|batch| batch.frequent).collect()
    }

    fn moments(&self, of: fn(&Batch) -> f64) -> Moments {
        Moments::of(self.finished.iter().map(of))
    }

    /// The sum that the estimate from lights that are hit often enough should be, over the repetitions of the truth.
    pub(super) fn wanted(&self) -> Moments {
        self.truth.sum(|light| self.steady.holds(light))
    }

    /// What may be missing from the estimate: nothing where it is known how often each light is picked.
    pub(super) fn unseen(&self) -> &Unseen {
        &self.unseen
    }

    /// The batches, a call.
    pub(super) fn batch(&self, batch: usize) -> &Batch {
        &self.finished[batch]
    }

    /// The lights that are tested together.
    pub(super) fn bins(&self) -> &[Bin] {
        self.pool.bins()
    }

    /// Of a bin's batches, a call.
    pub(super) fn found(&self, bin: &Bin) -> Moments {
        Moments::of(bin.batches().map(|sum| sum / f64::from(self.calls)))
    }

    /// A t statistic of batches without their skewness, where that must be measured: the model of picks with told
    /// counts knows it better.
    pub(super) fn unskewed(&self, t: f64, batches: impl IntoIterator<Item = f64> + Clone) -> f64 {
        if self.told { t } else { unskewed(t, skewness(batches), self.batches as usize) }
    }

    /// Variance, least variance and third central moment that the mean of the estimate from frequent lights should
    /// have.
    pub(super) fn model(&self) -> [f64; 3] {
        let (n, batches) = (self.draws(), f64::from(self.batches));
        let Steady { variance, third, spread, .. } = self.steady;
        [variance / n, spread / batches, third / (n * n)]
    }

    /// The variance of the mean of a count, a call, of which `wanted` are expected and the share `chance` is left to
    /// chance.
    ///
    /// Few picks do not show their own variance. It is Poisson's where they are independent and less where they are
    /// spread evenly over passes: then the test is stricter on itself than it need be, and as strong as with
    /// independent picks. However they are spread, a whole number with a mean between n and n + 1 has the variance of a
    /// toss between the two at least; by luck, batches of even numbers may all show the same.
    pub(super) fn variance(&self, found: Moments, wanted: f64, chance: f64) -> f64 {
        let mut variance = found.variance / found.n as f64;
        if self.told {
            if wanted * self.draws() < PLENTY {
                variance = variance.max(wanted * chance / self.draws());
            }
            let calls = f64::from(self.calls);
            variance = variance.max(toss(wanted * calls) / (calls * calls * f64::from(self.batches)));
        }
        variance
    }

    /// Takes calls; adds what each comes to, to its place in `passes`.
    fn take(&mut self, subject: &Subject<'_>, buffer: &PickBuffer, rays: &mut u64, passes: &mut [f64]) {
        for (call, pass) in buffer.calls().zip(passes) {
            let before = self.current.frequent;
            call.iter().for_each(|pick| self.take_pick(subject, pick, rays));
            if !self.told {
                let value = self.current.frequent - before;
                self.unseen.add(value);
                self.pool.end_call();
                *pass += value / f64::from(self.calls);
            }
        }
        self.current.picks += buffer.len() as f64;
    }

    fn take_pick(&mut self, subject: &Subject<'_>, pick: &Pick, rays: &mut u64) {
        let stage = subject.stage;
        let lights = stage.scene().lights();
        if !self.impossible.look(pick, self.at.pixel, lights.len()) {
            return;
        }
        let (id, weight) = (pick.light as usize, f64::from(pick.weight));
        self.seen[id] = true;
        let light = &lights[id];
        let value = self
            .truth
            .of_delta(pick.light, light.kind())
            .unwrap_or_else(|| grey(shadowed(stage, stage.light_sampling(), &self.at, light, pick.uv, rays)));
        let batch = &mut self.current;
        batch.whole += weight * value;
        if self.steady.holds(id) {
            batch.frequent += weight * value;
        }
        let unit = weight * f64::from(self.counts[id]);
        self.pool.add(id, if self.told { unit } else { weight * value });
        if self.told {
            if (unit - 1.0).abs() > self.worst_reciprocal.0 {
                self.worst_reciprocal = ((unit - 1.0).abs(), pick.light);
            }
            if self.truth.adds(id) {
                batch.contributing += 1.0;
                batch.excess += unit - 1.0;
            }
        }
    }

    fn close(&mut self) {
        let Batch { picks, contributing, excess, frequent, whole } = std::mem::take(&mut self.current);
        let calls = f64::from(self.calls);
        self.finished.push(Batch {
            picks: picks / calls,
            contributing: contributing / calls,
            excess: excess / calls,
            frequent: frequent / calls,
            whole: whole / calls,
        });
        self.pool.close();
    }
}

/// Draws at every receiver of the subject.
pub(super) fn seen<'a>(subject: &Subject<'a>) -> Seen<'a> {
    let options = subject.options;
    let (frame, receivers) = (subject.frame, subject.receivers);
    let first = subject.calls(frame, receivers, 0..FIRST);
    let picks = |calls: &[Vec<_>]| calls.iter().map(Vec::len).sum::<usize>() as f64 / f64::from(FIRST);
    let per_call: Vec<f64> = first.chunks(FIRST as usize).map(|calls| picks(calls).max(1.0)).collect();
    let most = per_call.iter().fold(1.0, |a: f64, &b| a.max(b));
    let draws = if subject.sampler.most_passes() == u32::MAX {
        options.draws as f64
    } else {
        options.draws as f64 * (FRAME as f64 / frame.len().max(1) as f64).min(1.0)
    };
    let mut counts = told(subject);
    let batches = ((draws / most) as usize).clamp(FEWEST, (options.batches as usize).max(FEWEST)) as u32;
    let calls = per_call.iter().zip(&counts).map(|(a_call, counts)| {
        // So many that what they may not have shown is little.
        let least = if counts.told { 1.0 } else { calls_to_tell(options.level) };
        ((draws / a_call).max(least) / f64::from(batches)).ceil().max(1.0) as u32
    });
    let calls: Vec<u32> = calls.collect();
    pilot(subject, &mut counts, &calls.iter().map(|calls| calls * batches).collect::<Vec<_>>());
    let mut sites: Vec<Site<'a>> = (subject.receivers.iter().zip(subject.truths))
        .zip(calls.iter().zip(counts))
        .map(|((at, truth), (&calls, Counts { counts, told }))| {
            let draws = f64::from(calls) * f64::from(batches);
            Site {
                at: *at,
                calls,
                batches,
                pool: Pool::new(truth, &counts, told, draws),
                steady: Steady::new(truth, &counts, told, calls, draws),
                seen: counts.iter().map(|&count| !told && count > 0.0).collect(),
                truth,
                counts,
                told,
                worst_reciprocal: (0.0, 0),
                impossible: Impossible::default(),
                unseen: Unseen::default(),
                current: Batch::default(),
                finished: Vec::new(),
            }
        })
        .collect();
    let (mut rays, mut image) = (0, Unseen::default());
    let longest = calls.iter().copied().max().unwrap_or(0);
    for batch in 0..batches {
        let mut passes = vec![0.0; longest as usize];
        run(subject, batch, &calls, |site, first, buffer| {
            sites[site].take(subject, buffer, &mut rays, &mut passes[first as usize..]);
        });
        sites.iter_mut().for_each(Site::close);
        passes.iter().for_each(|sum| image.add(sum * f64::from(longest)));
    }
    Seen { sites, image }
}

/// One independent run: `calls` passes at each receiver, a buffer of picks at a time. Shows `take` the receiver, the
/// first pass and the picks.
fn run(subject: &Subject<'_>, run: u32, calls: &[u32], mut take: impl FnMut(usize, u32, &PickBuffer)) {
    let frame = Frame::new(subject.frame, subject.key(run));
    let mut buffer = PickBuffer::default();
    for block in blocks(subject.sampler, 0..calls.iter().copied().max().unwrap_or(0)) {
        let begun = subject.sampler.begin(frame, block.clone());
        let mut worker = begun.worker(false);
        for (site, (at, &calls)) in subject.receivers.iter().zip(calls).enumerate() {
            // Thousands of calls at once would not fit.
            let mut next = block.start;
            while next < block.end.min(calls) {
                let passes: Range<u32> = next..block.end.min(calls).min(next.saturating_add(256));
                next = passes.end;
                worker.fill(&[*at], passes.clone(), true, &mut buffer);
                take(site, passes.start, &buffer);
            }
        }
    }
}

/// Picks a call of each light at a receiver, and whether the sampler told them.
struct Counts {
    counts: Vec<f32>,
    told: bool,
}

/// As the sampler tells them.
fn told(subject: &Subject<'_>) -> Vec<Counts> {
    let lights = subject.stage.scene().lights().len();
    let of = |at| {
        let mut counts = vec![0.0; lights];
        let told = subject.sampler.expected_counts(at, &mut counts);
        Counts { counts, told }
    };
    subject.receivers.iter().map(of).collect()
}

/// Where it does not, as so many calls show them.
fn pilot(subject: &Subject<'_>, counts: &mut [Counts], calls: &[u32]) {
    if counts.iter().any(|counts| !counts.told) {
        counts.iter_mut().filter(|counts| !counts.told).for_each(|counts| counts.counts.fill(0.0));
        run(subject, PILOT, calls, |site, _, buffer| {
            let Counts { counts, told } = &mut counts[site];
            if !*told {
                for pick in buffer.calls().flatten() {
                    // What is beyond the table is counted where the picks are looked at.
                    if let Some(count) = counts.get_mut(pick.light as usize) {
                        *count += 1.0;
                    }
                }
            }
        });
        let sites = counts.iter_mut().zip(calls).zip(subject.truths);
        for ((Counts { counts, .. }, &calls), truth) in sites.filter(|((counts, _), _)| !counts.told) {
            let least = if truth.lit() < LIT { f32::INFINITY } else { SEEN };
            counts.iter_mut().for_each(|count| *count = if *count < least { 0.0 } else { *count / calls as f32 });
        }
    }
}

/// Degrees of freedom of what was measured between batches.
pub(super) fn freedom(sites: &[Site<'_>]) -> usize {
    sites.first().map_or(1, |site| site.batches as usize - 1)
}
