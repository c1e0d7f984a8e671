//! What does it buy to know what each place sees, and each step before that?
//!
//! Step by step from the literature's light tree, in a city of canyons among ever more lights and on an open square; and each
//! parameter of `visible` away from its default.
//!
//! Whole frames are sampled, set-up on the clock: tables are shared by all that a place holds. Errors are taken at some of
//! the frame's receivers, since their truth takes a ray for every light.

use super::cells::{cells, measured, remark};
use super::columns::{column, interval, plot};
use super::entry::Entry;
use super::scenes::told_apart;
use super::session::Session;
use super::sizes::sizes;
use super::trial::{Budgets, Tried};
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::measure::figure::{Figure, error, mean};
use crate::measure::plan::budgets;
use crate::measure::reference::Reference;
use crate::measure::target::Target;
use crate::record::study::{Cell, ColumnRecord, Format, Study, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::record::{Interval, Row};
use crate::scene::Scene;
use crate::sources::{self, Overrides};
use crate::strategy::Configured;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use std::path::Path;

pub(super) const ENTRY: Entry = Entry {
    name: "visible",
    question: "What does it buy to know what each place sees, and each step before that?",
    run,
};

/// A city of canyons, which is grown, and an open square, where nothing is in between.
const CANYON: &str = "scenes/downtown.toml";
const PLAZA: &str = "scenes/plaza.toml";
/// Fewest lights.
const FEWEST: u64 = 1_000;

/// Receivers that errors are taken at.
const PIXELS: usize = 512;

/// From the literature's tree to what each place sees.
const STEPS: [(&str, &str); 6] = [
    ("classic tree", "light-tree:arity=2,importance=classic,points=random,open=0"),
    ("+ box horizons, 8 wide", "light-tree:points=random,open=0"),
    ("+ low discrepancy", "light-tree:open=0"),
    ("+ opened at the receiver", "light-tree"),
    ("+ visibility", "visible:picks=1"),
    ("+ 16 picks, whole numbers", "visible"),
];
/// What the others are measured by: all that choice can do, without what is in between and with it.
const FLOORS: [(&str, &str); 2] = [("floor: intensity", "intensity"), ("floor: oracle", "oracle")];
/// Most lights that the oracle is tried among.
const MOST_OF_ORACLE: usize = 110_000;

/// The scenes that parameters are tried on.
const SWEPT: [&str; 2] = ["scenes/first-night.toml", "scenes/downtown.toml"];
/// Each parameter away from its default.
const SWEEP: [&str; 24] = [
    "visible",
    "visible:cell=16",
    "visible:cell=32",
    "visible:cell=64",
    "visible:cell=256",
    "visible:least=1",
    "visible:least=16",
    "visible:least=64",
    "visible:cut=128",
    "visible:cut=256",
    "visible:cut=512",
    "visible:cut=2048",
    "visible:probes=1",
    "visible:probes=2",
    "visible:probes=8",
    "visible:probes=16",
    "visible:floor=0.05",
    "visible:floor=0.1",
    "visible:floor=0.4",
    "visible:floor=0.7",
    "visible:picks=1",
    "visible:picks=4",
    "visible:picks=64",
    "light-tree",
];

fn run(session: &Session<'_>) -> Result<Study> {
    let options = session.options;
    let sizes = sizes(FEWEST, options.max_lights);
    let smallest = sizes[0];
    let steps = STEPS.iter().chain(&FLOORS).map(|&(step, name)| Ok((step, options.registry.parse(name)?)));
    let steps: Vec<(&str, Configured)> = steps.collect::<Result<_>>()?;
    let sweep = options.registry.parse_list(options.strategies.as_deref().unwrap_or(&SWEEP.join(",")))?;
    let mut scenes: Vec<(String, &str, Option<u64>)> =
        sizes.into_iter().map(|lights| (format!("canyon-{lights}"), CANYON, Some(lights))).collect();
    scenes.push(("plaza".into(), PLAZA, None));
    let mut tables: Vec<TableRecord> = scenes.iter().map(|(name, ..)| ablation(session, name)).collect();
    tables.push(sweep_table(session));
    let swept = session.scenes(&SWEPT);
    // Read before anything is measured: a misspelt name must not cost an hour.
    let asked: Vec<Scene> = swept.iter().map(|path| sources::open(path, &options.overrides)).collect::<Result<_>>()?;
    told_apart(&asked)?;
    let smallest = Overrides { lights: Some(smallest), ..options.overrides.clone() };
    let own = [sources::open(Path::new(CANYON), &smallest)?, sources::open(Path::new(PLAZA), &options.overrides)?];
    let mut writer = session.open(asked.iter().chain(&own), tables)?;
    for (table, path, lights) in &scenes {
        step_by_step(session, &mut writer, table, &open(session, Path::new(path), *lights)?, &steps)?;
    }
    for path in &swept {
        sweep_over(session, &mut writer, &open(session, path, None)?, &sweep)?;
    }
    session.finish(writer)
}

fn open(session: &Session<'_>, path: &Path, lights: Option<u64>) -> Result<Stage> {
    let scene = sources::open(path, &Overrides { lights, ..session.options.overrides.clone() })?;
    Ok(Stage::new(scene, LeaveOut::Yes, Offset::SCALED))
}

/// The rows of one table: every step at every budget.
fn step_by_step(
    session: &Session<'_>,
    writer: &mut StudyWriter,
    table: &str,
    stage: &Stage,
    steps: &[(&str, Configured)],
) -> Result<()> {
    let few = stage.scene().lights().len() <= MOST_OF_ORACLE;
    let steps: Vec<_> = steps.iter().filter(|(_, of)| few || of.info().claim != Claim::Oracle).collect();
    let budgets: Vec<u32> = budgets(session.options.passes).collect();
    if writer.has(table, &[], steps.len() * budgets.len()) {
        return Ok(());
    }
    let (target, reference) = session.reference(&Target::whole(stage).thinned(session.pixels(PIXELS)))?;
    note(writer, &target, &reference)?;
    let strategies: Vec<&Configured> = steps.iter().map(|(_, strategy)| strategy).collect();
    let tried = session.trial(&target, &reference.truth, &strategies, Budgets::All)?;
    let of = |name: &str| strategies.iter().zip(&tried).find(|(of, _)| of.name() == name).map(|(_, tried)| tried);
    let (classic, tree) = (of(strategies[0].name()), of("light-tree"));
    let mut rows = Vec::new();
    for passes in budgets {
        for ((step, strategy), tried) in steps.iter().zip(&tried) {
            let mut row: Vec<Cell> = vec![(*step).into(), strategy.name().into(), u64::from(passes).into()];
            row.extend(figures_at(tried, passes));
            row.extend(cells(tried.product_to(classic, passes)));
            row.extend(cells(tried.product_to(tree, passes)));
            row.push(tried.why_not(passes));
            rows.push(row);
        }
    }
    writer.put(table, &[], rows)
}

/// The rows of one scene in the table of parameters.
fn sweep_over(session: &Session<'_>, writer: &mut StudyWriter, stage: &Stage, sweep: &[Configured]) -> Result<()> {
    let key = [("scene", stage.scene().name().into())];
    if writer.has("sweep", &key, sweep.len()) {
        return Ok(());
    }
    let (target, reference) = session.reference(&Target::whole(stage).thinned(session.pixels(PIXELS)))?;
    let tried = session.trial(&target, &reference.truth, &sweep.iter().collect::<Vec<_>>(), Budgets::Largest)?;
    let row = |(strategy, one): (&Configured, &Tried)| {
        let passes = one.summary.passes;
        let mut row: Vec<Cell> = vec![stage.scene().name().into(), strategy.name().into()];
        row.push((passes > 0).then_some(u64::from(passes)).into());
        row.extend(figures_at(one, passes));
        row.extend(cells(one.product_to(tried.first(), passes)));
        row.push(remark(&one.summary));
        row
    };
    writer.put("sweep", &key, sweep.iter().zip(&tried).map(row).collect())
}

fn ablation(session: &Session<'_>, name: &str) -> TableRecord {
    let mut columns = vec![
        column("step", "step", Format::Words),
        column("strategy", "strategy", Format::Name),
        column("passes", "passes", Format::Whole),
    ];
    columns.extend(figures());
    columns.extend(interval("to_classic", "to\nclassic", Format::Number));
    columns.extend(interval("to_tree", "to\nlight-tree", Format::Number));
    columns.push(column("remark", "", Format::Words));
    TableRecord {
        title: format!("{name}: from the literature's tree to what each place sees"),
        columns,
        notes: vec![
            notes(session),
            "to classic, to light-tree: relMSE x CPU s over that of the row at as many passes.".into(),
        ],
        plots: vec![plot(
            name,
            &format!("{name}: relMSE against CPU seconds"),
            "step",
            ("cpu_s", "CPU s"),
            ("rel_mse", "relMSE"),
        )],
        name: name.to_owned(),
    }
}

fn sweep_table(session: &Session<'_>) -> TableRecord {
    let mut columns = vec![
        column("scene", "scene", Format::Words),
        column("strategy", "strategy", Format::Name),
        column("passes", "passes", Format::Whole),
    ];
    columns.extend(figures());
    columns.extend(interval("to_first", "to\nfirst", Format::Number));
    columns.push(column("remark", "", Format::Words));
    TableRecord {
        name: "sweep".into(),
        title: "each parameter away from its default, or the strategies asked for".into(),
        columns,
        notes: vec![
            notes(session),
            "to first: relMSE x CPU s over that of the scene's first row, where that has as many passes.".into(),
        ],
        plots: Vec::new(),
    }
}

fn figures() -> Vec<ColumnRecord> {
    let mut columns = interval("rel_mse", "relMSE", Format::Number).to_vec();
    columns.extend(interval("outliers", "over that\nwithout the\nworst 0.1 %", Format::Number));
    columns.extend(interval("cpu_s", "CPU s", Format::Number));
    columns.extend(interval("error_cpu_s", "relMSE\nx CPU s", Format::Number));
    columns.push(column("heap_bytes", "memory", Format::Bytes));
    columns
}

/// The cells of [`figures`]; missing where a strategy was not run so far.
fn figures_at(tried: &Tried, passes: u32) -> Vec<Cell> {
    let rows = tried.at(passes);
    if rows.is_empty() {
        return vec![Cell::Missing; figures().len()];
    }
    let timed = |figure: Figure| tried.is_timed().then(|| figure.interval());
    let outliers = error(&rows).over(mean(&rows, |row| row.rel_mse_trimmed));
    let mut row = cells(error(&rows).interval()).to_vec();
    row.extend(cells(outliers.map(|ratio| ratio.interval())));
    row.extend(cells(timed(mean(&rows, Row::total_cpu_s))));
    row.extend(cells(timed(tried.product(passes))));
    row.push(rows.iter().map(|row| row.heap_bytes).max().into());
    row
}

impl Tried {
    /// relMSE x CPU seconds, set-up included.
    fn product(&self, passes: u32) -> Figure {
        self.error_times(passes, Row::total_cpu_s)
    }

    /// Why it has no figures at a number of passes; missing where it has.
    fn why_not(&self, passes: u32) -> Cell {
        match measured(&self.summary) {
            true if self.at(passes).is_empty() => "too much counted work".into(),
            _ => remark(&self.summary),
        }
    }

    /// That over another's, where both have a time at as many passes.
    fn product_to(&self, other: Option<&Self>, passes: u32) -> Option<Interval> {
        let other =
            other.filter(|other| [self, other].iter().all(|one| one.is_timed() && !one.at(passes).is_empty()))?;
        if std::ptr::eq(self, other) {
            return Some(Interval::certain(1.0));
        }
        self.product(passes).over(other.product(passes)).map(|ratio| ratio.interval())
    }
}

fn notes(session: &Session<'_>) -> String {
    format!(
        "{} runs, each from nothing in one block of passes on one thread (none of more than {} s of counted work); CPU s: of the whole \
         frame, set-up and learning too; relMSE at {} of its receivers (fewer among very many lights). `oracle` has no time.",
        session.options.repeats,
        session.options.seconds,
        session.pixels(PIXELS)
    )
}

fn note(writer: &mut StudyWriter, target: &Target<'_>, reference: &Reference) -> Result<()> {
    let scene = target.stage.scene();
    writer.note(format!(
        "{}, {} lights, {} of which can reach what the camera sees, at {} receivers of {}; the reference's own relMSE is {:.1e}.",
        scene.name(),
        scene.lights().len(),
        target.stage.lights().len(),
        target.places.len(),
        target.frame.len(),
        reference.truth.own_rel_mse()
    ))
}
