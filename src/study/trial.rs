//! How good is each strategy within a budget?
//!
//! What an experiment needs of a comparison: the same units by the same engine, without checks and without files. Whole
//! frames are rendered and timed; errors are taken where the target is measured.
//!
//! An oracle is never timed, and looks at each receiver alone: it is run where errors are taken, or at some of these.

use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::measure::engine::Engine;
use crate::measure::errors::Truth;
use crate::measure::experiment::{Experiment, Nowhere, Runs};
use crate::measure::figure::{Figure, error, mean};
use crate::measure::observer::Observer;
use crate::measure::plan::{Budget, Pilot, RECEIVERS};
use crate::measure::summary;
use crate::measure::target::{Target, places};
use crate::record::{Interval, Row, Summary};
use crate::strategy::Configured;

/// What strategies are tried on, and how.
#[derive(Clone, Copy)]
pub(crate) struct Trial<'a> {
    /// Who times it.
    pub engine: &'a Engine<'a>,
    /// The frame, and where errors are taken.
    pub target: &'a Target<'a>,
    /// What the radiance is there.
    pub truth: &'a Truth,
    /// What each strategy may spend in a run.
    pub budget: Budget,
    /// Independent runs.
    pub runs: u32,
    /// The user's seed.
    pub seed: u64,
}

/// The budgets of a strategy: numbers of passes of 1, 4, 16 and so on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Budgets {
    /// The largest that it can afford.
    Largest,
    /// All up to that.
    All,
}

/// What the runs of a strategy gave.
pub(crate) struct Tried {
    /// All of them together.
    pub summary: Summary,
    runs: Runs,
}

/// Nobody looks at an oracle's time: it may do more work than the others, but not for ever.
const PATIENCE: f64 = 4.0;

impl Trial<'_> {
    /// Runs every strategy; one that can afford no pass, or fails, has no figures and says why.
    ///
    /// # Errors
    /// The user's wish to stop; no thread to run on.
    pub(crate) fn run(&self, strategies: &[&Configured], budgets: Budgets, watch: &dyn Observer) -> Result<Vec<Tried>> {
        let mut tried = self.those(false, strategies, budgets, watch)?;
        if strategies.iter().any(|strategy| is_oracle(strategy)) {
            let some: Vec<usize> = places(self.target.places.len(), RECEIVERS).collect();
            let target = Target::of(self.target.stage, self.target.thinned(RECEIVERS).measured());
            let truth = self.truth.only(&some);
            let alone = Trial { target: &target, truth: &truth, ..*self };
            let oracles = alone.those(true, strategies, budgets, watch)?;
            let both = strategies.iter().zip(&mut tried).zip(oracles);
            for ((_, tried), oracle) in both.filter(|((strategy, _), _)| is_oracle(strategy)) {
                *tried = oracle;
                tried.summary.receivers = Some(some.len() as u64);
            }
        }
        Ok(tried)
    }

    /// Runs those that are oracles, or those that are not; the others have no figures.
    fn those(
        &self,
        oracles: bool,
        strategies: &[&Configured],
        budgets: Budgets,
        watch: &dyn Observer,
    ) -> Result<Vec<Tried>> {
        let rough = self.truth.thinned(RECEIVERS);
        watch.begin("pilots", strategies.len() as u64);
        let mut pilots: Vec<Option<Result<Pilot>>> = Vec::new();
        for &strategy in strategies {
            watch.check()?;
            let pilot = || self.engine.alone(|meter| Pilot::run(self.target, &rough, strategy, self.seed, meter));
            pilots.push(if is_oracle(strategy) == oracles { Some(pilot()?) } else { None });
            watch.advance(1);
        }
        watch.end();
        let patience = if oracles { PATIENCE } else { 1.0 };
        let budget = Budget { work_s: patience * self.budget.work_s, ..self.budget };
        let ladder = |pilot: &Option<Result<Pilot>>| {
            let pilot = pilot.as_ref().and_then(|pilot| pilot.as_ref().ok());
            let mut ladder = pilot.map_or_else(Vec::new, |pilot| pilot.ladder(budget, self.runs));
            if budgets == Budgets::Largest {
                ladder.drain(..ladder.len().saturating_sub(1));
            }
            ladder
        };
        let ladders: Vec<Vec<u32>> = pilots.iter().map(ladder).collect();
        let experiment = Experiment {
            engine: self.engine,
            target: self.target,
            truth: self.truth,
            strategies,
            ladders: &ladders,
            runs: self.runs,
            seed: self.seed,
        };
        let (runs, _) = experiment.run(&mut Nowhere, watch)?;
        let tried =
            strategies.iter().zip(&pilots).zip(&ladders).zip(runs).map(|(((strategy, pilot), ladder), runs)| {
                let (summary, _) = summary::of(strategy, pilot.as_ref(), ladder, &runs, self.truth);
                Tried { summary, runs }
            });
        Ok(tried.collect())
    }
}

fn is_oracle(strategy: &Configured) -> bool {
    strategy.info().claim == Claim::Oracle
}

impl Tried {
    /// The mean relMSE times the mean of another value of the runs at a number of passes.
    pub(super) fn error_times(&self, passes: u32, value: fn(&Row) -> f64) -> Figure {
        let rows = self.at(passes);
        Figure::of(vec![error(&rows), mean(&rows, value)], |parts| parts[0] * parts[1])
    }

    /// Its runs at a number of passes; empty where there are none.
    pub(crate) fn at(&self, passes: u32) -> Vec<&Row> {
        self.runs.at(passes)
    }

    /// CPU seconds of a sample of the frame, coming to the receiver included: none of one that is not timed.
    pub(super) fn sample_s(&self, frame: usize) -> Option<Interval> {
        let samples = f64::from(self.summary.passes) * frame as f64;
        self.is_timed().then(|| self.summary.cpu_s.times(1.0 / samples))
    }

    /// Whether its time means something.
    pub(super) fn is_timed(&self) -> bool {
        self.summary.runs > 0 && self.summary.claim != Claim::Oracle
    }
}
