//! What do all cases say together?
//!
//! A city is a replicate: the geometric mean of V over all its cases (sizes, conditions) of one strategy over that of
//! another is a ratio, and the spread of the ratios says how far another city may be from their mean. Cases of one seed share
//! streets and views, and are no replicates of one another.

use super::super::cells::cells;
use super::tables::{CONDITIONS, KINDS, OTHERS, base};
use crate::base::error::Result;
use crate::base::replicates::{Ratio, Replicates};
use crate::record::Interval;
use crate::record::study::{Cell, Cells, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::strategy::Configured;

/// Confidence of the intervals, and the chance that any pair of equal rows is told apart.
const CONFIDENCE: f64 = 0.95;
const LEVEL: f64 = 0.05;

/// Fills the tables over all cases.
pub(super) fn summarise(writer: &mut StudyWriter, grids: &[Vec<Configured>]) -> Result<()> {
    let strategies: Vec<&str> = grids.iter().map(|grid| grid[0].name()).collect();
    let (table, rows) = writer.table("cases");
    let cases = Found { table, rows, strategies: &strategies };
    let summaries = KINDS.map(|kind| (kind, summary(&cases, kind)));
    let over = over(&cases);
    let sizes = CONDITIONS.map(|receivers| (receivers, by_size(&cases, receivers)));
    for (name, rows) in summaries.into_iter().chain(sizes) {
        writer.put(name, &[], rows)?;
    }
    writer.put("over", &[], over)
}

/// What was measured.
struct Found<'a> {
    table: &'a TableRecord,
    rows: &'a [Cells],
    strategies: &'a [&'a str],
}

/// V of each strategy in some cases.
struct Chosen {
    /// By case.
    single: Replicates,
    /// By city: the geometric mean over its cases, none where one of them has no figure.
    cities: Replicates,
    cases: Vec<String>,
}

impl Found<'_> {
    /// The numbers of lights, ascending.
    fn sizes(&self) -> Vec<u64> {
        let lights = self.rows.iter().filter_map(|row| self.cell(row, "lights").number());
        let mut sizes: Vec<u64> = lights.map(|lights| lights as u64).collect();
        sizes.sort_unstable();
        sizes.dedup();
        sizes
    }

    /// The row of the strategy that others are held against.
    fn base(&self) -> usize {
        base(self.strategies)
    }

    fn cell<'r>(&self, row: &'r Cells, column: &str) -> &'r Cell {
        &row[self.table.column(column).expect("a column of this study")]
    }

    /// Of one kind of parameters, in the cases that are `wanted`.
    fn of(&self, kind: &str, wanted: impl Fn(&Cells) -> bool) -> Chosen {
        let text = |cell: &Cell| match cell {
            Cell::Text(text) => text.clone(),
            Cell::Whole(count) => count.to_string(),
            Cell::Missing | Cell::Number(_) => String::new(),
        };
        let name = |row: &Cells| {
            let part = |column| text(self.cell(row, column));
            format!("{}, {} lights, city {}, {}", part("receivers"), part("lights"), part("seed"), part("view"))
        };
        let mine = || self.rows.iter().filter(|row| *self.cell(row, "at") == Cell::from(kind) && wanted(row));
        let mut cases: Vec<String> = Vec::new();
        for case in mine().map(name) {
            if !cases.contains(&case) {
                cases.push(case);
            }
        }
        let seed = |row: &Cells| text(self.cell(row, "seed"));
        let mut seeds: Vec<String> = Vec::new();
        for of_row in mine().map(seed) {
            if !seeds.contains(&of_row) {
                seeds.push(of_row);
            }
        }
        let of = |strategy: &str| {
            mine().filter(move |row| *self.cell(row, "strategy") == Cell::from(strategy)).collect::<Vec<&Cells>>()
        };
        let v = |row: &Cells| self.cell(row, "v").number();
        let single = |strategy: &&str| {
            let rows = of(strategy);
            cases.iter().map(|case| rows.iter().find(|row| name(row) == *case).and_then(|row| v(row))).collect()
        };
        let city = |strategy: &&str| {
            let rows = of(strategy);
            let mean = |wanted: &String| {
                let logs = rows.iter().filter(|row| seed(row) == *wanted).map(|row| v(row).map(f64::ln));
                let logs = logs.collect::<Option<Vec<f64>>>()?;
                Some((logs.iter().sum::<f64>() / logs.len() as f64).exp())
            };
            seeds.iter().map(mean).collect()
        };
        Chosen {
            single: Replicates::of(self.strategies.iter().map(single).collect()),
            cities: Replicates::of(self.strategies.iter().map(city).collect()),
            cases,
        }
    }
}

impl Chosen {
    /// A strategy over another: over the cities, where both are measured in all of them.
    fn over(&self, strategy: usize, base: usize) -> Option<Ratio> {
        let whole = |row: usize| self.single.measured(row) == self.cases.len();
        (whole(strategy) && whole(base)).then(|| self.cities.over(strategy, base, CONFIDENCE))?
    }
}

/// A row a strategy, best first: its ratio to the base under each condition and under all, its place and its worst case.
fn summary(found: &Found<'_>, kind: &str) -> Vec<Cells> {
    let base = found.base();
    let by_condition =
        CONDITIONS.map(|receivers| found.of(kind, |row| *found.cell(row, "receivers") == Cell::from(receivers)));
    let all = found.of(kind, |_| true);
    let places = all.cities.places(LEVEL);
    let mut order: Vec<usize> = (0..found.strategies.len()).collect();
    let mean = |strategy: usize| all.over(strategy, base).map_or(f64::INFINITY, |ratio| ratio.mean);
    let missing = |strategy: usize| all.cases.len() - all.single.measured(strategy);
    order.sort_by(|&a, &b| (missing(a) > 0).cmp(&(missing(b) > 0)).then(mean(a).total_cmp(&mean(b))));
    let row = |strategy: usize| {
        let mut row: Cells = vec![found.strategies[strategy].into()];
        row.extend(by_condition.iter().flat_map(|of| interval(of.over(strategy, base))));
        row.extend(interval(all.over(strategy, base)));
        let single = all.single.over(strategy, base, CONFIDENCE);
        let place = places[strategy].as_ref();
        let rank = place.map(|place| match place.rank {
            [first, last] if first == last => format!("{first} {}", place.letters),
            [first, last] => format!("{first}-{last} {}", place.letters),
        });
        row.push(rank.as_deref().into());
        row.extend([single.map(|ratio| ratio.least.0).into(), single.map(|ratio| ratio.greatest.0).into()]);
        let worst = single.filter(|_| strategy != base).map(|ratio| all.cases[ratio.greatest.1].as_str());
        row.push(worst.into());
        row.push((all.single.measured(strategy) as u64).into());
        row
    };
    order.into_iter().map(row).collect()
}

/// The ratio of each strategy to the base at each size under a condition, both at their best.
fn by_size(found: &Found<'_>, receivers: &str) -> Vec<Cells> {
    let mut rows = Vec::new();
    for lights in found.sizes() {
        let of = found.of(KINDS[0], |row| {
            *found.cell(row, "receivers") == Cell::from(receivers) && *found.cell(row, "lights") == Cell::from(lights)
        });
        for (strategy, name) in found.strategies.iter().enumerate() {
            let mut row: Cells = vec![lights.into(), (*name).into()];
            row.extend(interval(of.over(strategy, found.base())));
            rows.push(row);
        }
    }
    rows
}

/// The flagship over its rivals, by condition and size: at defaults and at bests.
fn over(found: &Found<'_>) -> Vec<Cells> {
    let place = |name: &str| found.strategies.iter().position(|known| *known == name);
    let Some(own) = place("visible") else { return Vec::new() };
    let mut rows = Vec::new();
    for receivers in CONDITIONS {
        for lights in found.sizes().into_iter().map(Some).chain([None]) {
            let wanted = |row: &Cells| {
                *found.cell(row, "receivers") == Cell::from(receivers)
                    && lights.is_none_or(|lights| *found.cell(row, "lights") == Cell::from(lights))
            };
            let lights = lights.map_or_else(|| "all".to_owned(), |lights| lights.to_string());
            let mut row: Cells = vec![receivers.into(), lights.as_str().into()];
            let kinds = KINDS.map(|kind| found.of(kind, wanted));
            for other in OTHERS {
                for of in &kinds {
                    let ratio = place(other).and_then(|other| of.over(own, other));
                    row.extend(interval(ratio));
                }
            }
            rows.push(row);
        }
    }
    rows
}

fn interval(ratio: Option<Ratio>) -> [Cell; 3] {
    cells(ratio.map(|Ratio { mean, low, high, .. }| Interval { mean, low, high }))
}
