//! Which parameters of a strategy reach the least error in a given time?
//!
//! Every point of a grid has the number of passes, of those allowed, whose nominal seconds, set-up in, come next to the time. Its score on a
//! city is V at the time: the time, times the mean relMSE of its runs, times their passes over those that fit into the time beside set-up and
//! arrivals. So who overruns does not gain by it, though set-up is then a smaller part. Over cities, it is the geometric mean. Time is
//! counted, not taken: the same seed finds the same parameters on every machine, with any number of threads.
//!
//! A biased strategy's error does not fall as 1 / passes, so that its score is the relMSE of its runs; a pass that takes longer
//! than the time is charged for that.
//!
//! Who is the least of many by chance looks better than it is. So the choice rests on runs of its own, few of many points and
//! more of those that are left, and the scores of the best, of the next and of the default are of fresh runs, that none of
//! them was chosen by.

mod point;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod toys;

use super::counted::Work;
use super::engine::Engine;
use super::errors::Truth;
use super::experiment::{Experiment, Nowhere};
use super::observer::Observer;
use super::reference::scene_hash;
use super::target::Target;
use super::work::RATES;
use crate::base::error::{Error, Result};
use crate::base::random::{RunKey, hash};
use crate::record::tuned::{Condition, Second, TUNED_SCHEMA, Tuned, TunedStrategy, TuningCity};
use crate::record::{Program, environment};
use crate::strategy::Configured;
use point::{Point, over};

/// A city to tune on.
pub(crate) struct City<'a> {
    /// The frame, and where errors are taken.
    pub target: &'a Target<'a>,
    /// What they are taken against.
    pub truth: &'a Truth,
}

/// What parameters are looked for by.
pub(crate) struct Tuner<'a> {
    /// Who does the runs; its clock is of no account.
    pub engine: &'a Engine<'a>,
    /// Cities of one condition and size, none of which is reported.
    pub cities: &'a [City<'a>],
    /// Nominal CPU seconds of a run, set-up in.
    pub time_s: f64,
    /// The numbers of passes that a run may have, ascending: where receivers move, those that the truth is known after.
    pub passes: &'a [u32],
    /// Independent runs on each city that the choice rests on at its end, and the scores after it once more.
    pub runs: u32,
    /// The user's seed.
    pub seed: u64,
}

/// A part of the choice.
struct Round {
    /// Runs that every point left has done at its end, as a share of all.
    share: f64,
    /// How many times the least score a point may have to go on.
    within: f64,
}

/// The choice: a point that is twice as bad after a quarter of the runs is left, one that is 1.4 times as bad after half of
/// them, and of the others the best is taken. The default is never left.
const ROUNDS: [Round; 3] = [
    Round { share: 0.25, within: 2.0 },
    Round { share: 0.5, within: 1.4 },
    Round { share: 1.0, within: f64::INFINITY },
];

/// No point is left after fewer runs on each city, where there are so many: one may be off by a lamp that it met. Seen of
/// `light-tree` on two cities like downtown: after one run the least score was half of what fresh runs gave any point, and 2
/// picks were left at 2.2 times it, though their own score was within a tenth of the default's by fresh runs.
const FEWEST: u32 = 2;

/// Names the random numbers of the runs that no point is chosen by.
const FRESH: u64 = u64::from_le_bytes(*b"no choic");

impl Tuner<'_> {
    /// Tunes every strategy that has a choice, and says what for.
    ///
    /// # Errors
    /// As [`tune`](Self::tune).
    pub(crate) fn all(
        &self,
        grids: &[Vec<Configured>],
        condition: Condition,
        program: Option<Program>,
        watch: &dyn Observer,
    ) -> Result<Tuned> {
        let grids = grids.iter().filter(|grid| grid.len() > 1);
        let strategies = grids.map(|grid| self.tune(grid, watch)).collect::<Result<_>>()?;
        let city = |city: &City<'_>| {
            let scene = city.target.stage.scene();
            TuningCity { seed: scene.seed(), hash: scene_hash(scene) }
        };
        Ok(Tuned {
            schema: TUNED_SCHEMA,
            program,
            version: environment::version(),
            revision: environment::revision(),
            rates: RATES,
            condition,
            time_s: self.time_s,
            runs: self.runs,
            seed: self.seed,
            cities: self.cities.iter().map(city).collect(),
            strategies,
        })
    }

    /// Finds the best point of a grid, whose first one is the default.
    ///
    /// # Errors
    /// A grid, cities or runs that are none, or a time that is no time; the user's wish to stop; no thread to run on. A
    /// point that cannot be measured says so itself.
    pub(crate) fn tune(&self, grid: &[Configured], watch: &dyn Observer) -> Result<TunedStrategy> {
        self.check(grid)?;
        let mut points = self.counted(grid, watch)?;
        let mut done = 0;
        for (round, number) in ROUNDS.iter().zip(1..) {
            let upto = ((round.share * f64::from(self.runs)).ceil() as u32).max(FEWEST).min(self.runs);
            let left: Vec<usize> = (0..points.len()).filter(|&i| points[i].out.is_none()).collect();
            self.run(&mut points, &left, upto - done, number, watch)?;
            done = upto;
            self.leave(&mut points, round.within, done);
        }
        let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].out.is_none()).collect();
        // Of equals the first: it is nearest to the default.
        order.sort_by(|&a, &b| self.score(&points[a]).total_cmp(&self.score(&points[b])));
        let chosen: Vec<usize> = order.into_iter().take(2).collect();
        let mut fresh = chosen.clone();
        fresh.extend((points[0].out.is_none() && !chosen.contains(&0)).then_some(0));
        for &i in &fresh {
            points[i].chosen_by = Some(self.score(&points[i]));
            points[i].errors.iter_mut().for_each(Vec::clear);
        }
        self.run(&mut points, &fresh, self.runs, FRESH, watch)?;
        Ok(self.found(&points, &chosen))
    }

    fn check(&self, grid: &[Configured]) -> Result<()> {
        let wrong = match (grid, self.cities) {
            ([], _) => "the grid has no points",
            (_, []) => "there is no city to tune on",
            _ if self.passes.is_empty() => "no number of passes is allowed",
            _ if self.runs == 0 => "no runs are asked for",
            _ if !(self.time_s.is_finite() && self.time_s > 0.0) => "the time is no number of seconds above 0",
            _ => return Ok(()),
        };
        Err(Error::Invalid(format!("nothing can be tuned: {wrong}")))
    }

    /// Every point with its passes on every city; or out, where it is too dear or fails.
    fn counted<'g>(&self, grid: &'g [Configured], watch: &dyn Observer) -> Result<Vec<Point<'g>>> {
        let pairs = grid.iter().enumerate().flat_map(|(i, _)| (0..self.cities.len()).map(move |city| (i, city)));
        let units: Vec<(usize, usize)> = pairs.collect();
        let mut works: Vec<Vec<Option<(u32, Work)>>> = grid.iter().map(|_| vec![None; self.cities.len()]).collect();
        let mut points: Vec<Point<'g>> = grid.iter().map(|point| Point::new(point, self.cities.len())).collect();
        let work = |&(i, city): &(usize, usize), _: super::engine::Meter<'_>| Ok(self.work(&grid[i], city));
        self.engine.run("counting", &units, watch, work, |&(i, city), found| {
            match found {
                Ok(work) => works[i][city] = Some(work),
                // Units end in any order: of several reasons the first city's is told.
                Err(why) => points[i].fail(city, why),
            }
            Ok(())
        })?;
        for (point, works) in points.iter_mut().zip(works) {
            if let Some(works) = works.into_iter().collect::<Option<Vec<(u32, Work)>>>() {
                point.passes = works.iter().map(|&(passes, _)| passes).collect();
                point.seconds = works.iter().map(|(passes, work)| work.seconds(*passes)).collect();
                point.at_time = works.iter().map(|(passes, work)| work.at_time(*passes, self.time_s)).collect();
            }
        }
        Ok(points)
    }

    /// The passes of a strategy on a city and their work, or why it is out.
    fn work(&self, strategy: &Configured, city: usize) -> std::result::Result<(u32, Work), String> {
        let key = RunKey { seed: hash(&[self.seed, city as u64]), run: u32::MAX };
        Work::next_to(self.cities[city].target, strategy, key, self.time_s, self.passes)
    }

    /// So many more runs of some points on every city.
    fn run(&self, points: &mut [Point<'_>], those: &[usize], runs: u32, word: u64, watch: &dyn Observer) -> Result<()> {
        for (city, at) in self.cities.iter().enumerate() {
            let left: Vec<usize> = those.iter().copied().filter(|&i| points[i].out.is_none()).collect();
            let strategies: Vec<&Configured> = left.iter().map(|&i| points[i].strategy).collect();
            let ladders: Vec<Vec<u32>> = left.iter().map(|&i| vec![points[i].passes[city]]).collect();
            let experiment = Experiment {
                engine: self.engine,
                target: at.target,
                truth: at.truth,
                strategies: &strategies,
                ladders: &ladders,
                runs,
                seed: hash(&[self.seed, city as u64, word]),
            };
            let (found, _) = experiment.run(&mut Nowhere, watch)?;
            for (runs, i) in found.into_iter().zip(left) {
                match runs.rows.iter().find_map(|row| row.error.clone()) {
                    Some(why) => points[i].fail(city, why),
                    None => points[i].errors[city].extend(runs.rows.iter().map(|row| row.rel_mse)),
                }
            }
        }
        Ok(())
    }

    /// Leaves the points that are more than `within` times as bad as the best, but for the default.
    fn leave(&self, points: &mut [Point<'_>], within: f64, runs: u32) {
        let scores: Vec<f64> =
            points.iter().map(|p| if p.out.is_none() { self.score(p) } else { f64::INFINITY }).collect();
        let least = scores.iter().copied().fold(f64::INFINITY, f64::min);
        for (point, score) in points.iter_mut().zip(scores).skip(1) {
            if point.out.is_none() && score > within * least {
                let times = score / least;
                point.out = Some(format!("left after {runs} runs on each city: {times:.1} times the least score"));
            }
        }
    }

    fn score(&self, point: &Point<'_>) -> f64 {
        point.score(self.time_s)
    }

    /// What was found, from the points and those two that were chosen, the best first.
    fn found(&self, points: &[Point<'_>], chosen: &[usize]) -> TunedStrategy {
        let mut chosen = chosen.iter().map(|&i| &points[i]).filter(|point| point.out.is_none());
        let default = &points[0];
        let best = chosen.next();
        let over_best = |point: &Point<'_>| best.map(|best| over(point, best, self.time_s));
        let second = chosen.next().and_then(|second| {
            let over_best = over_best(second)?;
            Some(Second { name: second.name(), over_best, told_apart: !over_best.holds(1.0) })
        });
        let is_best = best.is_some_and(|best| std::ptr::eq(best, default));
        TunedStrategy {
            default: default.name(),
            best: best.map(Point::name),
            gain: if is_best || default.out.is_some() { None } else { over_best(default) },
            second,
            points: points.iter().map(|point| point.record(self.time_s)).collect(),
        }
    }
}

/// So many seeds of cities to tune on, where `reported` is that of the city, or cities, that will be reported.
pub(crate) fn seeds(reported: u64, count: usize) -> Vec<u64> {
    let word = u64::from_le_bytes(*b"to tune.");
    // Short enough to be typed.
    (0..count as u64).map(|i| hash(&[reported, word, i]) >> 40).collect()
}
