//! Which parameters are best, and what do they lose in cities that they were not found in?

use super::super::cells::cells;
use super::case::Size;
use crate::base::error::Result;
use crate::measure::tuning_cities::{CITIES, OWN_REL_MSE, Search};
use crate::record::Interval;
use crate::record::study::Cell;
use crate::record::study_store::StudyWriter;
use crate::record::tuned::{TunedPoint, TunedStrategy};
use crate::strategy::Configured;
use crate::visibility::stage::Stage;

/// The strategies at what is found best for a size, in the order of their grids: found now, or by the study before it was
/// interrupted. One that no point of its grid can be measured at stays at its default.
pub(super) fn best(size: &Size<'_>, writer: &mut StudyWriter, grids: &[Vec<Configured>]) -> Result<Vec<Configured>> {
    let session = size.cases.session;
    let key = [("receivers", size.receivers.name().into()), ("lights", size.lights.into())];
    if !writer.has("tuned", &key, grids.len()) {
        let found = on(size, grids, &|city| size.other(size.others()?[city], city))?;
        writer.put(
            "grid",
            &key,
            found.iter().flat_map(|one| one.points.iter().map(|point| grid_row(size, one, point))).collect(),
        )?;
        writer.put("tuned", &key, found.iter().map(|one| tuned_row(size, one)).collect())?;
    }
    let (table, rows) = writer.table("tuned");
    let at = |name: &str| table.column(name).expect("a column of this study");
    let (receivers, lights, strategy, best) = (at("receivers"), at("lights"), at("strategy"), at("best"));
    let found = |default: &Configured| {
        let mine = rows.iter().find(|row| {
            row[receivers] == key[0].1 && row[lights] == key[1].1 && row[strategy] == Cell::from(default.name())
        });
        match mine.map(|row| &row[best]) {
            Some(Cell::Text(text)) => text.clone(),
            _ => default.name().to_owned(),
        }
    };
    grids.iter().map(|grid| session.options.registry.parse(&found(&grid[0]))).collect()
}

/// What is found best on cities.
fn on(size: &Size<'_>, grids: &[Vec<Configured>], open: &dyn Fn(usize) -> Result<Stage>) -> Result<Vec<TunedStrategy>> {
    let session = size.cases.session;
    let stages: Vec<Stage> = (0..CITIES).map(open).collect::<Result<_>>()?;
    let (engine, passes) = (session.engine(), size.passes());
    let search = Search {
        engine: &engine,
        time_s: size.time_s(),
        seed: session.options.seed,
        ground: size.ground(&passes, OWN_REL_MSE),
        program: session.options.program.clone(),
    };
    search.with(&stages, session.watch, |tuner| grids.iter().map(|grid| tuner.tune(grid, session.watch)).collect())
}

/// Fills the table of what the best parameters lose where they were not found, for the size in the middle.
pub(super) fn loss(
    size: &Size<'_>,
    writer: &mut StudyWriter,
    grids: &[Vec<Configured>],
    best: &[Configured],
) -> Result<()> {
    let session = size.cases.session;
    let key = [("receivers", size.receivers.name().into()), ("lights", size.lights.into())];
    if writer.has("loss", &key, grids.len()) {
        return Ok(());
    }
    let reported = |city| size.reported(city);
    let there = on(size, grids, &reported)?;
    let there: Vec<Configured> = grids
        .iter()
        .zip(&there)
        .map(|(grid, found)| session.options.registry.parse(found.best.as_deref().unwrap_or(grid[0].name())))
        .collect::<Result<_>>()?;
    let parse = |one: &Configured| session.options.registry.parse(one.name());
    let pair = |(elsewhere, there): (&Configured, &Configured)| {
        let same = elsewhere.name() == there.name();
        Ok(if same { vec![parse(elsewhere)?] } else { vec![parse(elsewhere)?, parse(there)?] })
    };
    let pairs: Vec<Vec<Configured>> = best.iter().zip(&there).map(pair).collect::<Result<_>>()?;
    let other = pairs.iter().filter(|pair| pair.len() > 1);
    let other: Vec<Vec<Configured>> = other.map(|pair| pair.iter().map(parse).collect()).collect::<Result<_>>()?;
    let scored = if other.is_empty() { Vec::new() } else { on(size, &other, &reported)? };
    let mut scored = scored.iter();
    let row = |(grid, pair): (&Vec<Configured>, &Vec<Configured>)| {
        let mut row: Vec<Cell> = vec![key[0].1.clone(), key[1].1.clone(), grid[0].name().into()];
        row.extend([pair[0].name().into(), pair[pair.len() - 1].name().into()]);
        let found = if pair.len() > 1 { scored.next() } else { None };
        row.extend(cells(found.map_or(Some(Interval::certain(1.0)), over_other)));
        row.push(found.map_or(Cell::Missing, why_not));
        row
    };
    writer.put("loss", &key, grids.iter().zip(&pairs).map(row).collect())
}

/// The score of the first of two points over the other's, whichever was chosen; without an interval where one of them was
/// left before the end.
fn over_other(found: &TunedStrategy) -> Option<Interval> {
    let [first, other] = &found.points[..] else { return None };
    let told = found.second.as_ref().map(|second| second.over_best).map(|Interval { mean, low, high }| {
        let is_first = found.best.as_ref() == Some(&found.default);
        if is_first {
            Interval { mean: 1.0 / mean, low: 1.0 / high, high: 1.0 / low }
        } else {
            Interval { mean, low, high }
        }
    });
    let known = || Some(Interval { mean: first.score? / other.score?, ..Interval::NONE });
    told.or_else(known)
}

/// Why there is no score of one of the points.
fn why_not(found: &TunedStrategy) -> Cell {
    let out = found.points.iter().find_map(|point| point.out.as_ref().map(|why| format!("{}: {why}", point.name)));
    out.as_deref().into()
}

fn tuned_row(size: &Size<'_>, found: &TunedStrategy) -> Vec<Cell> {
    let TunedStrategy { default, best, gain, second, .. } = found;
    let mut row: Vec<Cell> = vec![size.receivers.name().into(), size.lights.into(), default.as_str().into()];
    row.push(best.as_deref().into());
    row.extend(cells(*gain));
    row.push(second.as_ref().map(|second| second.name.as_str()).into());
    row.extend(cells(second.as_ref().map(|second| second.over_best)));
    row
}

fn grid_row(size: &Size<'_>, of: &TunedStrategy, point: &TunedPoint) -> Vec<Cell> {
    let cities = &point.cities;
    // Geometric means over the cities.
    let mean = |value: &dyn Fn(usize) -> f64| {
        let n = cities.len();
        (n > 0).then(|| ((0..n).map(|i| value(i).ln()).sum::<f64>() / n as f64).exp())
    };
    vec![
        size.receivers.name().into(),
        size.lights.into(),
        of.default.as_str().into(),
        point.name.as_str().into(),
        mean(&|i| f64::from(cities[i].passes)).into(),
        mean(&|i| cities[i].work_s).into(),
        mean(&|i| cities[i].rel_mse).into(),
        point.score.into(),
        point.out.as_deref().into(),
    ]
}
