//! What does each strategy come to in a case: at its best, and at its defaults?

use super::super::cells::cells;
use super::case::{Size, view};
use crate::base::error::Result;
use crate::base::random::{RunKey, hash};
use crate::measure::counted::Work;
use crate::measure::experiment::{Experiment, Nowhere, Runs};
use crate::measure::figure::{Figure, error, mean};
use crate::measure::reference::Reference;
use crate::measure::target::Target;
use crate::record::Row;
use crate::record::study::{Cell, Cells};
use crate::record::study_store::StudyWriter;
use crate::strategy::Configured;

/// The truth's own relMSE, where its work allows; where receivers move, that after one pass.
const OWN_REL_MSE: f64 = 1e-6;

/// Counted work that is so many times more or less than the time is said.
const UNEQUAL: f64 = 1.5;

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
    let allowed = size.passes();
    let (target, reference) = size.ground(&allowed, OWN_REL_MSE).of(&stage, session.watch)?;
    let defaults = || grids.iter().map(|grid| &grid[0]);
    // What is found best may be the default: measured once, it stands in both rows.
    let mut strategies: Vec<&Configured> = defaults().collect();
    for one in best {
        if strategies.iter().all(|known| known.name() != one.name()) {
            strategies.push(one);
        }
    }
    let (time_s, seed) = (size.time_s(), session.options.seed);
    session.watch.begin("counting", strategies.len() as u64);
    let key_of_counts = RunKey { seed: hash(&[seed, city as u64]), run: u32::MAX };
    let works: Vec<Affordable> = strategies
        .iter()
        .map(|strategy| {
            session.watch.check()?;
            let work = session.engine().alone(|_| Work::next_to(&target, strategy, key_of_counts, time_s, &allowed))?;
            session.watch.advance(1);
            Ok(work)
        })
        .collect::<Result<_>>()?;
    session.watch.end();
    let ladders: Vec<Vec<u32>> = works.iter().map(|work| work.iter().map(|(passes, _)| *passes).collect()).collect();
    let experiment = Experiment {
        engine: &session.engine(),
        target: &target,
        truth: &reference.truth,
        strategies: &strategies,
        ladders: &ladders,
        runs: size.cases.runs,
        seed: hash(&[seed, REPORTED, size.receivers as u64, size.lights, city as u64]),
    };
    let (runs, _) = experiment.run(&mut Nowhere, session.watch)?;
    let row = |at: &str, default: &Configured, one: &Configured| -> Cells {
        let which = strategies.iter().position(|known| known.name() == one.name()).expect("one of them");
        let mut row: Cells = key.iter().map(|(_, cell)| cell.clone()).collect();
        row.extend([stage.scene().seed().into(), view(city).name().into(), default.name().into(), at.into()]);
        row.push(one.name().into());
        row.extend(figures(&runs[which], &works[which], time_s, &target, &reference));
        row
    };
    let of_default = defaults().map(|default| row("default", default, default));
    let of_best = defaults().zip(best).map(|(default, best)| row("best", default, best));
    writer.put("cases", &key, of_default.chain(of_best).collect())
}

/// The passes of a strategy and their work, or why there are none.
type Affordable = std::result::Result<(u32, Work), String>;

/// Passes, pixels, the truth's own relMSE, counted seconds, relMSE, CPU seconds, V and a remark.
fn figures(runs: &Runs, work: &Affordable, time_s: f64, target: &Target<'_>, reference: &Reference) -> Cells {
    let nothing = |why: &str| -> Cells {
        let mut row = vec![Cell::Missing; 13];
        row.push(why.into());
        row
    };
    let (passes, work) = match work {
        Ok(affordable) => affordable,
        Err(why) => return nothing(why),
    };
    if let Some(why) = runs.rows.iter().find_map(|row| row.error.as_ref()) {
        return nothing(why);
    }
    let rows = runs.at(*passes);
    let seconds = || mean(&rows, Row::total_cpu_s);
    let (counted_s, own) = (work.seconds(*passes), reference.truth.after(*passes).own_rel_mse());
    if error(&rows).estimate <= own {
        return nothing(&format!("the error is not above the truth's own, {own:.1e}"));
    }
    // What it would be in just that time: see `Work::at_time`.
    let at_time = work.at_time(*passes, time_s) * time_s / counted_s;
    let v = Figure::of(vec![error(&rows), seconds()], move |parts| parts[0] * parts[1] * at_time);
    let mut row: Cells =
        vec![u64::from(*passes).into(), (target.places.len() as u64).into(), own.into(), counted_s.into()];
    row.extend(cells(error(&rows).interval()));
    row.extend(cells(seconds().interval()));
    row.extend(cells(v.interval()));
    let mut remarks = Vec::new();
    if counted_s > UNEQUAL * time_s || UNEQUAL * counted_s < time_s {
        remarks.push(format!("{:.1} times the time", counted_s / time_s));
    }
    if own > 0.01 * error(&rows).estimate {
        remarks.push("the truth's own error is more than a hundredth of this".to_owned());
    }
    row.push(remarks.join("; ").as_str().into());
    row
}
