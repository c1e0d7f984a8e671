//! What stands in the tables of `study elsewhere`?

use super::super::columns::{column, interval, plot};
use super::case::{Cases, MOVING, STAYING};
use crate::measure::tuning_cities::CITIES;
use crate::record::study::{ColumnRecord, Format, TableRecord};
use crate::strategy::Configured;
use crate::visibility::visits::Receivers;

/// The conditions, in the order of the tables.
pub(super) const CONDITIONS: [&str; 3] = [Receivers::NAMED[0].0, Receivers::NAMED[1].0, Receivers::NAMED[2].0];
/// Which parameters a row is measured at; a summary table is named by each.
pub(super) const KINDS: [&str; 2] = ["best", "default"];
/// What `visible` is held against.
pub(super) const OTHERS: [&str; 3] = ["light-tree", "stochastic-cull", "intensity"];

/// All tables: what all cases say together first.
pub(super) fn all(cases: &Cases<'_>, grids: &[Vec<Configured>]) -> Vec<TableRecord> {
    let names: Vec<&str> = grids.iter().map(|grid| grid[0].name()).collect();
    let base = names[base(&names)];
    let mut tables = vec![
        summary("best", &format!("each strategy at its best: V over that of {base}"), base),
        summary("default", &format!("each strategy at its defaults: V over that of {base}"), base),
        over(),
    ];
    tables.extend(CONDITIONS.map(|receivers| by_size(receivers, base)));
    tables.extend([loss(), tuned(), grid(), measured(cases)]);
    tables
}

/// The strategy that others are held against: the light tree, or where it is not asked for the first.
pub(super) fn base(strategies: &[&str]) -> usize {
    strategies.iter().position(|name| *name == "light-tree").unwrap_or(0)
}

fn group() -> [ColumnRecord; 2] {
    [column("receivers", "receivers", Format::Name), column("lights", "lights", Format::Whole)]
}

fn summary(name: &str, title: &str, base: &str) -> TableRecord {
    let mut columns = vec![column("strategy", "strategy", Format::Name)];
    for receivers in CONDITIONS.iter().chain(&["all"]) {
        columns.extend(interval(&format!("ratio_{receivers}"), receivers, Format::Number));
    }
    columns.extend([
        column("rank", "rank,\nletters", Format::Words),
        column("least", "least", Format::Number),
        column("greatest", "greatest", Format::Number),
        column("worst_case", "worst case", Format::Words),
        column("cases", "cases", Format::Whole),
    ]);
    let parameters = if name == "best" {
        "Parameters are those of the table of tuning: found in counted work for each condition and size, on cities of other \
         seeds than those that are reported."
    } else {
        "Parameters are the defaults: nobody has tuned anything, and an order can turn round where somebody does."
    };
    TableRecord {
        name: name.to_owned(),
        title: title.to_owned(),
        columns,
        notes: vec![
            format!(
                "V is the mean relMSE times the mean CPU seconds of a run, set-up and every arrival in, at one time for all (see the \
                 table of cases); {base} has 1 in every case. Less is better."
            ),
            format!(
                "geometric means over all sizes of {CITIES} cities, seen from a street, a roof and the sky in turn; under `all` over \
                 all conditions too. 95 % intervals by Student's t over the cities: sizes and conditions of one seed count as one. \
                 A rank of 2-4 may be any of these, and rows that share a letter are not told apart (paired t tests over the \
                 cities, Holm, 5 % in all)."
            ),
            parameters.to_owned(),
            "where receivers move, errors are of the choice of lights alone: more picks at one receiver then always pay, up to the \
             most that a grid has, though what a path tracer sees depends on where its paths go as well."
                .to_owned(),
            "without a figure: not measured in every case of the column, as where a pass takes too long among many lights; the \
             tables by size have the rest. least, greatest and worst case are of single cases."
                .to_owned(),
        ],
        plots: Vec::new(),
    }
}

fn over() -> TableRecord {
    let mut columns = vec![column("receivers", "receivers", Format::Name), column("lights", "lights", Format::Words)];
    for other in OTHERS {
        for kind in KINDS {
            let name = format!("over_{}_{kind}", other.replace('-', "_"));
            columns.extend(interval(&name, &format!("over {other},\n{kind}"), Format::Number));
        }
    }
    TableRecord {
        name: "over".to_owned(),
        title: "V of visible over that of another strategy".to_owned(),
        columns,
        notes: vec![
            "both at their best, and both at their defaults; below 1 where `visible` is better. Geometric means over cities with \
             95 % intervals over them; `all` sizes of a city count as one, and have no figure where one size has none."
                .to_owned(),
        ],
        plots: Vec::new(),
    }
}

fn by_size(receivers: &str, base: &str) -> TableRecord {
    let mut columns = vec![column("lights", "lights", Format::Whole), column("strategy", "strategy", Format::Name)];
    columns.extend(interval("ratio", &format!("V over that\nof {base}"), Format::Number));
    let drawn = plot(
        receivers,
        &format!("{receivers}: V over that of {base}, each at its best"),
        "strategy",
        ("lights", "lights"),
        ("ratio", "V over V, less is better"),
    );
    TableRecord {
        name: receivers.to_owned(),
        title: format!("{receivers}: each strategy at its best, by the number of lights"),
        columns,
        notes: vec![format!("geometric means over {CITIES} cities, with 95 % intervals over them.")],
        plots: vec![drawn],
    }
}

fn loss() -> TableRecord {
    let mut columns = group().to_vec();
    columns.extend([
        column("strategy", "strategy", Format::Name),
        column("elsewhere", "found on other cities", Format::Name),
        column("there", "found on the reported ones", Format::Name),
    ]);
    columns.extend(interval("loss", "V over V", Format::Number));
    columns.push(column("remark", "", Format::Words));
    TableRecord {
        name: "loss".to_owned(),
        title: "what parameters lose in cities that they were not found in".to_owned(),
        columns,
        notes: vec![
            "V on the reported cities at the parameters that were found on the others, over V there at those that were found \
             on the reported ones, in counted work. Runs that choose are none of those that score. Nothing else in this study \
             rests on parameters that were found on reported cities."
                .to_owned(),
        ],
        plots: Vec::new(),
    }
}

fn tuned() -> TableRecord {
    let mut columns = group().to_vec();
    columns.extend([column("strategy", "strategy", Format::Name), column("best", "at its best", Format::Name)]);
    columns.extend(interval("gain", "default\nover best", Format::Number));
    columns.push(column("second", "the next", Format::Name));
    columns.extend(interval("second_over_best", "over best", Format::Number));
    TableRecord {
        name: "tuned".to_owned(),
        title: "tuning: the best parameters for each condition and size".to_owned(),
        columns,
        notes: vec![
            "V in counted work at the committed rates, geometric mean over five tuning cities with an interval over them; of \
             runs that neither was chosen by."
                .to_owned(),
        ],
        plots: Vec::new(),
    }
}

fn grid() -> TableRecord {
    let mut columns = group().to_vec();
    columns.extend([
        column("strategy", "strategy", Format::Name),
        column("point", "point of the grid", Format::Name),
        column("passes", "passes", Format::Number),
        column("work_s", "counted s", Format::Number),
        column("rel_mse", "relMSE", Format::Number),
        column("v", "V", Format::Number),
        column("remark", "", Format::Words),
    ]);
    TableRecord {
        name: "grid".to_owned(),
        title: "every point of every grid".to_owned(),
        columns,
        notes: vec![
            "geometric means over the tuning cities; V of the best, the next and the default by runs that chose none of them, of the \
             others by those that chose. A point that is much worse than the best after few runs is left, and says so."
                .to_owned(),
        ],
        plots: Vec::new(),
    }
}

fn measured(cases: &Cases<'_>) -> TableRecord {
    let mut columns = group().to_vec();
    columns.extend([
        column("city", "city", Format::Whole),
        column("seed", "seed", Format::Whole),
        column("view", "view", Format::Name),
        column("strategy", "strategy", Format::Name),
        column("at", "at its", Format::Name),
        column("parameters", "parameters", Format::Name),
        column("passes", "passes", Format::Whole),
        column("pixels", "pixels", Format::Whole),
        column("truth_rel_mse", "truth's own\nrelMSE", Format::Number),
        column("counted_s", "counted ms", Format::Milliseconds),
    ]);
    columns.extend(interval("rel_mse", "relMSE", Format::Number));
    columns.extend(interval("cpu_s", "CPU ms", Format::Milliseconds));
    columns.extend(interval("v", "V", Format::Number));
    columns.push(column("remark", "", Format::Words));
    TableRecord {
        name: "cases".to_owned(),
        title: "every case".to_owned(),
        columns,
        notes: vec![format!(
            "{} runs of the number of passes (powers of two and their halves more, at most {STAYING}, and {MOVING} where receivers move) \
             whose counted work, set-up in, comes next to a time T: {} s among the fewest lights, and half as long again for ten times as many. \
             V is relMSE times CPU seconds, brought to T: times the passes over those that fit into T beside set-up and arrivals. A \
             strategy of which a quarter of a pass does not fit is not run. Where the counted time is more than 1.5 times more or less, \
             the remark says so. CPU ms: set-up and every arrival in. relMSE at so many pixels.",
            cases.runs, cases.time_s
        )],
        plots: Vec::new(),
    }
}
