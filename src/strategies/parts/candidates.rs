//! Candidates of another sampler, and one chosen among them: resampled importance sampling.
//!
//! Every sampler gives weighted picks, so that its probabilities need not be known: a candidate of weight w and target
//! value p stands for `p w / m`, m being the calls made. Chosen in proportion to that, it gets the weight
//! `(sum of all) / p`. For any function g of the point on a light, the expectation over the choice is the sum of
//! `w g / m` over candidates with p > 0: the inner sampler's own mean. So the contract holds wherever it holds for the
//! inner sampler and p > 0 wherever the light adds anything; the candidates may depend on one another.
//!
//! Source: Talbot, Cline, Egbert, EGSR 2005; the weights as in Lin et al., ACM TOG 41(4), 2022.

use super::target_function::TargetFunction;
use crate::base::counts::Counts;
use crate::base::discrete::Cumulative;
use crate::base::draws::Draws;
use crate::base::error::{Error, Result};
use crate::scene::light::Kind;
use crate::scene::receiver::Receiver;
use crate::strategy::{AnySampler, Arguments, BuildContext, Claim, Configured, Pick, Source, Tally};
use std::any::Any;

/// Where candidates come from, and how many.
pub(in crate::strategies) struct Recipe {
    from: Configured,
    calls: u32,
}

impl Recipe {
    /// Reads `from` and `m`.
    pub(in crate::strategies) fn configure(arguments: &mut Arguments<'_>) -> Result<Self> {
        let from = arguments.strategy("from", "light-tree", "strategy that the candidates come from")?;
        let calls = arguments.count("m", 4, 1..=1024, "calls of that strategy for one choice")?;
        Ok(Self { from, calls })
    }

    /// What the strategy of the candidates promises, which is all that a choice among them can.
    pub(in crate::strategies) fn claim(&self) -> Claim {
        self.from.info().claim
    }

    /// The candidates for a scene.
    pub(in crate::strategies) fn build(&self, context: BuildContext<'_>) -> Result<Candidates> {
        let sampler = self.from.build(context)?;
        if sampler.source().is_none() {
            let text = "needs a state of its own for each pass and gives no candidates to others";
            return Err(Error::Invalid(format!("`{}` {text}", self.from.name())));
        }
        Ok(Candidates { sampler, calls: self.calls, target: TargetFunction::new(context) })
    }
}

/// What a candidate is valued by.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::strategies) enum Value {
    /// Its light, nothing in between; the point is left to the harness unless the inner sampler has its own.
    Light,
    /// A point on it, nothing in between.
    Point,
    /// A point on it, 0 where it is hidden.
    VisiblePoint,
}

/// Candidates for a scene.
pub(in crate::strategies) struct Candidates {
    sampler: Box<dyn AnySampler>,
    calls: u32,
    pub(in crate::strategies) target: TargetFunction,
}

/// One worker's candidates at a receiver.
#[derive(Default)]
pub(in crate::strategies) struct Pool {
    scratch: Option<Box<dyn Any + Send>>,
    picks: Vec<Pick>,
    values: Vec<f32>,
    sums: Cumulative,
}

impl Candidates {
    fn source(&self) -> &dyn Source {
        self.sampler.source().expect("checked when it was built")
    }

    /// Comes to a receiver.
    pub(in crate::strategies) fn arrive<T: Tally>(&self, at: &Receiver, pool: &mut Pool, tally: &mut T) {
        let scratch = pool.scratch.get_or_insert_with(|| self.source().scratch());
        let mut work = T::COUNTS.then(Counts::default);
        self.source().arrive(at, &mut **scratch, work.as_mut());
        tally.add(work.unwrap_or_default());
    }

    /// Draws new candidates at the receiver that was come to, and values them.
    pub(in crate::strategies) fn draw<T: Tally>(
        &self,
        by: Value,
        at: &Receiver,
        draws: &mut Draws,
        pool: &mut Pool,
        tally: &mut T,
    ) {
        let Pool { scratch, picks, values, sums } = pool;
        let scratch = scratch.as_mut().expect("a receiver is come to before candidates are drawn");
        let mut work = T::COUNTS.then(Counts::default);
        picks.clear();
        for j in 0..self.calls {
            draws.nested(j, self.calls, |draws| {
                let first = picks.len();
                self.source().sample(at, draws, &mut **scratch, work.as_mut(), picks);
                if by != Value::Light {
                    (0..).zip(&mut picks[first..]).for_each(|(slot, pick)| self.settle(slot, pick, draws));
                }
            });
        }
        tally.add(work.unwrap_or_default());
        tally.candidates(picks.len() as u64);
        values.clear();
        sums.clear();
        for pick in picks.iter() {
            let value = match by {
                Value::Light => self.target.of_light(pick, at, tally),
                Value::Point => self.target.of_point(pick, at, tally),
                Value::VisiblePoint => self.target.of_visible_point(pick, at, tally),
            };
            values.push(value);
            sums.push((value * pick.weight).min(f32::MAX));
        }
    }

    /// Settles the point of a candidate: one that is tested must be the one that is shaded.
    fn settle(&self, slot: u32, pick: &mut Pick, draws: &mut Draws) {
        if pick.uv == Pick::DRAW {
            let extended = self.target.scene().lights()[pick.light as usize].kind() == Kind::Triangle;
            pick.uv = if extended { draws.point(slot) } else { [0.0; 2] };
        }
    }

    /// The candidate that `u` in `[0, 1)` chooses, with the weight that it gets and its target value; `None` if none is
    /// worth anything.
    pub(in crate::strategies) fn choose(&self, pool: &Pool, u: f64) -> Option<(Pick, f32)> {
        let (index, _) = pool.sums.pick(u)?;
        let value = pool.values[index];
        let weight = pool.sums.total() / (f64::from(value) * f64::from(self.calls));
        // Above f32 only where a candidate is worth nothing beside the others, which are then never passed over.
        let weight = weight.min(f64::from(f32::MAX)) as f32;
        Some((Pick { weight, ..pool.picks[index] }, value))
    }

    pub(in crate::strategies) fn heap_bytes(&self) -> usize {
        self.sampler.heap_bytes()
    }
}
