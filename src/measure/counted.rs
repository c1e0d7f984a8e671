//! How much work is a strategy on a frame, set-up and all, in nominal seconds?
//!
//! Counted by the same code that renders, at the committed [rates](super::work): the same on every machine. Counting a pass over a
//! whole frame takes about as long as rendering it; at some squares of it, a part of that.

use super::target::{Target, squares};
use super::work::{nominal_s, setup_s};
use crate::base::counts::Counts;
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, BuildContext, Configured};

/// Nominal seconds of a strategy's parts on a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Work {
    /// Building the sampler.
    pub setup_s: f64,
    /// Coming to every receiver of the frame once, whatever the number of passes.
    pub arrive_s: f64,
    /// A pass over the frame.
    pub pass_s: f64,
    /// What became of the samples that were counted.
    pub counts: Counts,
}

/// A strategy is too dear where less than so much of a pass fits into the time beside set-up and arrivals.
const LEAST: f64 = 0.25;

/// Passes that work is counted over.
const COUNTED: u32 = 2;

/// How many times dearer than it is a strategy may seem at some squares of the frame: room for those that share work among
/// neighbours further apart than a square, as `visible`.
const SEEMING: f64 = 3.0;

/// Work is counted at so many squares of the frame: a strategy may share what it does among neighbours.
const SQUARES: usize = 16;

/// Builds a sampler that nothing was asked of yet.
pub(crate) type Fresh<'a> = &'a dyn Fn() -> Result<Box<dyn AnySampler>>;

impl Work {
    /// Counted over so many passes, at least two, at some squares of a target's frame; at all of it for a sampler that
    /// draws state for a pass or looks at its whole frame.
    ///
    /// What neighbours share who are further apart than a square, it takes for dearer than it is.
    ///
    /// # Errors
    /// A sampler that cannot be built.
    pub(crate) fn at_squares(target: &Target<'_>, fresh: Fresh<'_>, key: RunKey, passes: u32) -> Result<Self> {
        let sampler = fresh()?;
        let some = some(target, &*sampler);
        Ok(Self::counted(target, [&some, &some], &*sampler, key, passes))
    }

    /// The same, with what comes once counted at a target's whole frame.
    ///
    /// # Errors
    /// A sampler that cannot be built.
    pub(crate) fn of_frame(target: &Target<'_>, fresh: Fresh<'_>, key: RunKey, passes: u32) -> Result<Self> {
        let sampler = fresh()?;
        Ok(Self::counted(target, [&target.frame, &some(target, &*sampler)], &*sampler, key, passes))
    }

    /// What a sampler does that nothing was asked of yet: the first pass at some receivers, and passes at others of them. One
    /// that learns as receivers come does so once, in the first pass: what that takes beyond another pass is no part of a
    /// pass.
    fn counted(
        target: &Target<'_>,
        [at_first, later]: [&[Receiver]; 2],
        sampler: &dyn AnySampler,
        key: RunKey,
        passes: u32,
    ) -> Self {
        let setup_s = setup_s(sampler.heap_bytes());
        let count = |receivers: &[Receiver], passes| {
            let plan = Plan { stage: target.stage, receivers, sampler, key };
            plan.run_counting(passes, &mut Film::new(receivers.len()))
        };
        let seconds = |counts: &Counts, receivers: &[Receiver]| {
            nominal_s(counts) * target.frame.len() as f64 / receivers.len().max(1) as f64
        };
        let first = seconds(&count(at_first, 1), at_first);
        let counts = count(later, passes);
        // State of one pass is drawn anew for each, and so is every arrival; where receivers move, every pass arrives.
        let pass_s = if sampler.most_passes() == 1 || target.stage.visits().moves() {
            seconds(&counts, later) / f64::from(passes)
        } else {
            ((seconds(&counts, later) - seconds(&count(later, 1), later)) / f64::from(passes - 1)).max(0.0)
        };
        Self { setup_s, arrive_s: (first - pass_s).max(0.0), pass_s, counts }
    }

    /// Nominal seconds from nothing to the image of so many passes in one block.
    pub(crate) fn seconds(&self, passes: u32) -> f64 {
        self.setup_s + self.arrive_s + f64::from(passes) * self.pass_s
    }

    /// By what to multiply the relMSE of an image of so many passes, and that of `time_s` follows, where it falls as
    /// 1 / passes: these passes over as many, whole or not, as fit into the time.
    pub(crate) fn at_time(&self, passes: u32, time_s: f64) -> f64 {
        f64::from(passes) * self.pass_s / (time_s - self.setup_s - self.arrive_s)
    }

    /// The number of passes, of those allowed, whose work comes next to `time_s` on a target's frame, and that work; or why
    /// there is none.
    pub(crate) fn next_to(
        target: &Target<'_>,
        strategy: &Configured,
        key: RunKey,
        time_s: f64,
        allowed: &[u32],
    ) -> std::result::Result<(u32, Self), String> {
        let build = || strategy.build(BuildContext { stage: target.stage, seed: key.seed });
        let within = |work: Result<Self>, times: f64| {
            let work = work.map_err(|error| error.to_string())?;
            let beside_s = work.arrive_s + LEAST * work.pass_s;
            let least_s = work.setup_s + beside_s;
            let dear =
                format!("set-up, arrivals and {LEAST} passes are {least_s:.4} s of counted work, more than {time_s} s");
            if work.setup_s + beside_s / times > time_s { Err(dear) } else { Ok(work) }
        };
        // Counting a whole frame of what takes a hundred times that would take as long.
        within(Self::at_squares(target, &build, key, COUNTED), SEEMING)?;
        let work = within(Self::of_frame(target, &build, key, COUNTED), 1.0)?;
        Ok((work.passes_next_to(time_s, allowed), work))
    }

    /// The number of passes whose nominal seconds come next to `seconds`, among those allowed: ascending, at least one.
    fn passes_next_to(&self, seconds: f64, allowed: &[u32]) -> u32 {
        let off = |passes: u32| (self.seconds(passes) - seconds).abs();
        // Of equals the most: what takes nothing may do as much as it can.
        allowed.iter().copied().rev().min_by(|&a, &b| off(a).total_cmp(&off(b))).expect("a number of passes")
    }
}

/// Some squares of a target's frame; all of it for a sampler that draws state for a pass or looks at its whole frame.
fn some(target: &Target<'_>, sampler: &dyn AnySampler) -> Vec<Receiver> {
    if sampler.most_passes() == 1 { target.frame.to_vec() } else { squares(&target.frame, SQUARES) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::draws::Draws;
    use crate::scene::Scene;
    use crate::sources::small;
    use crate::strategy::{Arguments, Claim, Info, LightSampler, Picks, Registry, Strategy, Tally};
    use crate::visibility::offset::Offset;
    use crate::visibility::stage::{LeaveOut, Stage};
    use crate::visibility::visits::Receivers;

    /// Learns once, by a hundred candidates, when it first comes to a receiver; then weighs ten lights in each arrival.
    struct Learning;

    #[derive(Default)]
    struct Learned(std::sync::OnceLock<()>);

    impl Strategy for Learning {
        const INFO: Info =
            Info { name: "learning", summary: "learns once", source: "this test", claim: Claim::Unbiased };
        type Sampler = Learned;

        fn configure(_: &mut Arguments<'_>) -> Result<Self> {
            Ok(Self)
        }

        fn build(&self, _: BuildContext<'_>) -> Result<Learned> {
            Ok(Learned::default())
        }
    }

    impl LightSampler for Learned {
        type Scratch = ();

        fn arrive<T: Tally>(&self, _: &Receiver, (): &mut (), tally: &mut T) {
            self.0.get_or_init(|| tally.candidates(1_000_000));
            tally.weighed(10);
        }

        fn sample<T: Tally>(&self, _: &Receiver, _: &mut Draws, (): &mut (), out: &mut Picks<'_, T>) {
            out.push(0, 1.0);
        }

        fn expected_counts(&self, _: &Receiver, _: &mut [f32]) -> bool {
            false
        }

        fn heap_bytes(&self) -> usize {
            0
        }
    }

    #[test]
    fn what_is_learned_once_is_no_part_of_a_pass() {
        let strategy = Registry::empty().with::<Learning>().parse("learning").expect("a strategy");
        for receivers in [Receivers::Centre, Receivers::Spread] {
            let scene = Scene::new(small::sixteen()).expect("a scene");
            let stage = Stage::visiting(scene, LeaveOut::Yes, Offset::SCALED, receivers);
            let target = Target::whole(&stage).after([1, 4]);
            let key = RunKey { seed: 1, run: 0 };
            let fresh = || strategy.build(BuildContext { stage: &stage, seed: 1 });
            let work = Work::of_frame(&target, &fresh, key, 4).expect("built");
            let learned_s = nominal_s(&Counts { candidates: 1_000_000, ..Counts::default() });
            let frame = target.frame.len() as f64;
            assert!(work.arrive_s > 0.99 * learned_s, "{work:?}, learning {learned_s}");
            assert!(work.pass_s < 400e-9 * frame, "{work:?} of {frame} receivers");
        }
    }

    #[test]
    fn who_overruns_gains_nothing_by_it() {
        let work = Work { setup_s: 0.01, arrive_s: 0.09, pass_s: 0.1, counts: Counts::default() };
        // Five passes fit into 0.6 s, half a one into 0.15 s: with errors of 1 / passes all see what those would have.
        for (time_s, fits) in [(0.6, 5.0), (0.15, 0.5)] {
            for passes in [1, 5, 40] {
                let error = work.at_time(passes, time_s) / f64::from(passes);
                assert!((error * fits - 1.0).abs() < 1e-9, "{passes} passes, {time_s} s: {error}");
            }
        }
    }

    #[test]
    fn passes_come_next_to_a_time_from_either_side() {
        let work = Work { setup_s: 0.01, arrive_s: 0.09, pass_s: 0.1, counts: Counts::default() };
        let every: Vec<u32> = (1..=64).collect();
        for (seconds, passes) in [(0.0, 1), (0.24, 1), (0.26, 2), (1.14, 10), (1.16, 11), (1e9, 64)] {
            assert_eq!(work.passes_next_to(seconds, &every), passes, "{seconds} s");
        }
        assert_eq!([0.3, 0.55, 0.71].map(|seconds| work.passes_next_to(seconds, &[1, 4, 8])), [1, 4, 8]);
        assert!((work.seconds(10) - 1.1).abs() < 1e-12);
        let nothing = Work { pass_s: 0.0, ..work };
        assert_eq!(nothing.passes_next_to(1.0, &every), 64);
    }
}
