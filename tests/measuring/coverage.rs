//! How often do the intervals of a table hold what 1,600 runs say?
//!
//! Renders a scene at 64 x 36 in 1,600 independent runs of each row's strategy, takes 16 of them 2,000 times, and
//! summarises these as `compare` does. The truth is the same figure of all 1,600. A figure without an upper end holds
//! whatever is not below its lower end; how often that was so is printed too. CPU seconds are made up, with 3 % of noise
//! for each run, so that other work on the machine has no part in it. `COVERAGE_SCENE`, `COVERAGE_SEED` and
//! `COVERAGE_RUNS` say otherwise:
//! `cargo test --release --lib coverage -- --ignored --nocapture`.

use citylights::base::error::Result;
use citylights::base::random::Stream;
use citylights::measure::curve::Curve;
use citylights::measure::engine::build_seed;
use citylights::measure::errors::Truth;
use citylights::measure::experiment::{Runs, numbers};
use citylights::measure::figure::Figure;
use citylights::measure::observer::Unobserved;
use citylights::measure::reference::Reference;
use citylights::measure::summary::{blank, summarise};
use citylights::measure::target::Target;
use citylights::record::{Interval, Row};
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::sources::{Overrides, open};
use citylights::strategy::{BuildContext, Configured, Registry};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use rayon::prelude::*;
use std::path::Path;

/// Each strategy with its budgets, and those of them that are rows of the table.
const ROWS: [(&str, &[u32], &[u32]); 8] = [
    ("power", &[1, 4, 16, 64], &[4, 64]),
    ("light-tree", &[1, 4, 16, 64], &[4, 64]),
    ("visible", &[1, 4, 16, 64], &[4, 64]),
    ("stochastic-cull", &[1, 4, 16], &[4, 16]),
    ("uniform", &[1, 4], &[4]),
    ("intensity", &[1, 4, 16, 64], &[64]),
    ("resampled", &[1, 4, 16, 32], &[32]),
    ("influence-tail", &[1, 4, 16, 64], &[64]),
];
const ALL: usize = 1_600;
const REDRAWS: u64 = 2_000;
/// CPU seconds of set-up, of arrival and of a pass.
const COST_S: [f64; 3] = [1e-3, 5e-3, 5e-4];
const CPU_NOISE: f64 = 0.03;
const FIGURES: [&str; 4] = ["error", "V", "s to 0.1", "s to 0.01"];

#[test]
#[ignore = "ten minutes of a core"]
fn intervals_hold_what_many_runs_say() -> Result<()> {
    let said = |name: &str| std::env::var(format!("COVERAGE_{name}")).ok();
    let number = |name: &str, otherwise: usize| said(name).map_or(otherwise, |text| text.parse().expect("a number"));
    let file = said("SCENE").unwrap_or_else(|| "scenes/first-night.toml".into());
    let (seed, runs) = (number("SEED", 1) as u64, number("RUNS", 16).clamp(3, ALL / 4));
    let scene = open(Path::new(&file), &Overrides { resolution: Some((64, 36)), ..Overrides::default() })?;
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    let target = Target::whole(&stage);
    let truth = Reference::compute(&target, 1e-6, Path::new("target/citylights-references"), &Unobserved)?.truth;
    println!("{file} at 64 x 36, seed {seed}: {REDRAWS} times {runs} of {ALL} runs, intervals at 95 %");
    println!("of each figure: held %, truth above / below the interval %, no upper end %, upper end / figure (median)");
    println!("{:20}{}", "", FIGURES.map(|figure| format!("{figure:>36}")).concat());
    for (name, budgets, rows) in ROWS {
        let strategy = Registry::standard().parse(name)?;
        let all = Everything::render(&target, &truth, &strategy, budgets, seed)?;
        for &row in rows {
            let found = all.coverage(&truth, &strategy, row, runs, seed);
            println!("{:20}{}", format!("{name} {row}"), found.each_ref().map(ToString::to_string).concat());
            assert!(found.iter().all(|figure| figure.held >= 92.0), "{name} {row}: 95 % intervals that hold less");
        }
    }
    Ok(())
}

/// The rows of a run at each budget, and its images there.
type Run = Vec<(Row, Vec<Vec3>)>;

/// All runs of a strategy.
struct Everything(Vec<Run>);

impl Everything {
    fn render(target: &Target<'_>, truth: &Truth, strategy: &Configured, budgets: &[u32], seed: u64) -> Result<Self> {
        let receivers = &target.frame;
        let run = |run: u32| -> Result<Run> {
            let one = |&passes: &u32| {
                let key = numbers(seed, run, passes);
                let sampler = strategy.build(BuildContext { stage: target.stage, seed: build_seed(key) })?;
                let plan = Plan { stage: target.stage, receivers, sampler: &*sampler, key };
                let mut film = Film::new(receivers.len());
                plan.run(passes, &mut film);
                let row = Row::blank("scene".into(), strategy.name().into(), run, passes);
                Ok((truth.errors(&film.image()).written_to(row), film.image()))
            };
            budgets.iter().map(one).collect()
        };
        Ok(Self((0..ALL as u32).into_par_iter().map(run).collect::<Result<_>>()?))
    }

    /// What some of the runs say, up to a budget.
    fn figures(
        &self,
        truth: &Truth,
        strategy: &Configured,
        last: u32,
        some: &[usize],
        mut noise: impl FnMut() -> f64,
    ) -> [Interval; 4] {
        let [setup_s, arrival_s, pass_s] = COST_S;
        let mut runs = Runs::default();
        for run in some.iter().map(|&run| &self.0[run]) {
            for (row, image) in run.iter().filter(|(row, _)| row.passes <= last) {
                let cpu_s = (arrival_s + f64::from(row.passes) * pass_s) * noise();
                runs.rows.push(Row { setup_cpu_s: setup_s * noise(), cpu_s, wall_s: cpu_s, ..row.clone() });
                if row.passes == last {
                    runs.images.push(image.clone());
                }
            }
        }
        let ladder: Vec<u32> = self.0[0].iter().map(|(row, _)| row.passes).filter(|&passes| passes <= last).collect();
        let (summary, _) = summarise(blank(strategy), truth, &runs, &ladder);
        let curve = Curve::of(&runs, &ladder);
        let until = |error| curve.seconds_to(error, Figure::certain(0.0)).1.interval();
        [summary.rel_mse, summary.variance_seconds, until(0.1), until(0.01)]
    }

    /// How often the intervals of a row's figures hold them.
    fn coverage(&self, truth: &Truth, strategy: &Configured, last: u32, runs: usize, seed: u64) -> [Tally; 4] {
        let everyone: Vec<usize> = (0..ALL).collect();
        let right = self.figures(truth, strategy, last, &everyone, || 1.0);
        let redraw = |redraw: u64| {
            let mut stream = Stream::keyed(&[seed, redraw, u64::from_le_bytes(*b"coverage")]);
            let mut chosen = everyone.clone();
            for i in 0..runs {
                chosen.swap(i, i + stream.below(ALL - i));
            }
            let noise = || 1.0 + CPU_NOISE * (12.0f64.sqrt() * (stream.uniform64() - 0.5));
            self.figures(truth, strategy, last, &chosen[..runs], noise)
        };
        let found: Vec<[Interval; 4]> = (0..REDRAWS).into_par_iter().map(redraw).collect();
        std::array::from_fn(|i| {
            Tally::of(right[i].mean, &found.iter().map(|figures| figures[i]).collect::<Vec<Interval>>())
        })
    }
}

/// How one figure's intervals fared.
struct Tally {
    held: f64,
    above: f64,
    below: f64,
    open: f64,
    reach: f64,
}

impl Tally {
    fn of(truth: f64, found: &[Interval]) -> Self {
        let percent = |of: fn(&Interval, f64) -> bool| {
            100.0 * found.iter().filter(|interval| of(interval, truth)).count() as f64 / REDRAWS as f64
        };
        let mut reaches: Vec<f64> = found.iter().map(|interval| interval.high / interval.mean).collect();
        reaches.sort_by(f64::total_cmp);
        Self {
            held: percent(Interval::holds),
            above: percent(|interval, truth| truth > interval.high),
            below: percent(|interval, truth| truth < interval.low),
            open: percent(|interval, _| interval.high.is_infinite()),
            reach: reaches[reaches.len() / 2],
        }
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { held, above, below, open, reach } = self;
        write!(f, "{held:9.1} {above:5.1} /{below:4.1} {open:6.1} {reach:7.2}")
    }
}
