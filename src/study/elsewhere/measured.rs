//! What does each strategy come to in a case: at its best, and at its defaults?

use super::super::cells::cells;
use super::case::{Size, view};
use crate::base::error::Result;
use crate::base::random::{RunKey, hash};
use crate::measure::counted::Work;
use crate::measure::experiment::{Experiment, Nowhere, Runs};
use crate::measure::figure::{Figure, error, mean};
use crate::measure::target::Target;
use crate::record::Row;
use crate::record::study::{Cell, Cells};
use crate::record::study_store::StudyWriter;
use crate::strategy::{BuildContext, Configured};

/// Passes that work is counted over.
const COUNTED: u32 = 2;
/// A pass may take so many times the time; a strategy whose pass takes longer is left out.
const DEAREST: f64 = 4.0;

/// Names the random numbers of the runs that are reported: none that anything was chosen by.
const REPORTED: u64 = u64::from_le_bytes(*b"reported");

/// Measures a case, unless it was measured before: every strategy at its defaults, and at its `best`.
pub(super) fn case(
    size: &Size<'_>,
    city: usize,
    writer: &mut StudyWriter,
    grids: &[Vec<Configured>],
    best: &[Configured],
) -> Result<()> {
    let session = size.cases.session;
    let key = [
        ("receivers", size.receivers.name().into()),
        ("lights", size.lights.into()),
        ("city", (city as u64 + 1).into()),
    ];
    if writer.has("cases", &key, 2 * grids.len()) {
        return Ok(());
    }
    let stage = size.reported(city)?;
    let (target, reference) = size.target(&stage)?;
    let defaults = || grids.iter().map(|grid| &grid[0]);
    // What is found best may be the default: measured once, it stands in both rows.
    let mut strategies: Vec<&Configured> = defaults().collect();
    for one in best {
        if strategies.iter().all(|known| known.name() != one.name()) {
            strategies.push(one);
        }
    }
    let (time_s, allowed, seed) = (size.cases.time_s, size.passes(), session.options.seed);
    session.watch.begin("counting", strategies.len() as u64);
    let passes: Vec<std::result::Result<u32, String>> = strategies
        .iter()
        .map(|strategy| {
            session.watch.check()?;
            let passes = session.engine().alone(|_| affordable(&target, strategy, time_s, allowed, seed))?;
            session.watch.advance(1);
            Ok(passes)
        })
        .collect::<Result<_>>()?;
    session.watch.end();
    let ladders: Vec<Vec<u32>> = passes.iter().map(|passes| passes.iter().copied().collect()).collect();
    let experiment = Experiment {
        engine: &session.engine(),
        target: &target,
        truth: &reference.truth,
        strategies: &strategies,
        ladders: &ladders,
        runs: size.cases.runs,
        seed: hash(&[session.options.seed, REPORTED]),
    };
    let (runs, _) = experiment.run(&mut Nowhere, session.watch)?;
    let row = |at: &str, default: &Configured, one: &Configured| -> Cells {
        let which = strategies.iter().position(|known| known.name() == one.name()).expect("one of them");
        let mut row: Cells = key.iter().map(|(_, cell)| cell.clone()).collect();
        row.extend([stage.scene().seed().into(), view(city).name().into(), default.name().into(), at.into()]);
        row.push(one.name().into());
        row.extend(figures(&runs[which], &passes[which], &target));
        row
    };
    let of_default = defaults().map(|default| row("default", default, default));
    let of_best = defaults().zip(best).map(|(default, best)| row("best", default, best));
    writer.put("cases", &key, of_default.chain(of_best).collect())
}

/// The number of passes that come next to the time, by counted work; or why there are none.
fn affordable(
    target: &Target<'_>,
    strategy: &Configured,
    time_s: f64,
    allowed: &[u32],
    seed: u64,
) -> std::result::Result<u32, String> {
    let key = RunKey { seed, run: u32::MAX };
    let context = BuildContext { stage: target.stage, seed };
    let sampler = strategy.build(context).map_err(|error| error.to_string())?;
    Work::affordable(target, sampler.as_ref(), key, COUNTED, DEAREST * time_s)
        .map(|work| work.passes_next_to(time_s, allowed))
        .map_err(|first_s| format!("one pass is {first_s:.2} s of counted work, more than {DEAREST} times {time_s} s"))
}

/// Passes, receivers, relMSE, CPU seconds, V and a remark.
fn figures(runs: &Runs, passes: &std::result::Result<u32, String>, target: &Target<'_>) -> Cells {
    let nothing = |why: &str| -> Cells {
        let mut row = vec![Cell::Missing; 11];
        row.push(why.into());
        row
    };
    let passes = match passes {
        Ok(passes) => *passes,
        Err(why) => return nothing(why),
    };
    if let Some(why) = runs.rows.iter().find_map(|row| row.error.as_ref()) {
        return nothing(why);
    }
    let rows = runs.at(passes);
    let seconds = || mean(&rows, Row::total_cpu_s);
    let v = Figure::of(vec![error(&rows), seconds()], |parts| parts[0] * parts[1]);
    let mut row: Cells = vec![u64::from(passes).into(), (target.places.len() as u64).into()];
    row.extend(cells(error(&rows).interval()));
    row.extend(cells(seconds().interval()));
    row.extend(cells(v.interval()));
    row.push(Cell::Missing);
    row
}
