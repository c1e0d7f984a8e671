//! What does it buy to know what each place sees, and each step before that?
//!
//! Step by step from the literature's light tree, in a city of canyons among ever more lights and on an open square; and each
//! parameter of `visible` away from its default.
//!
//! Whole frames are sampled, set-up on the clock: tables are shared by all that a place holds. Errors are taken at some of
//! the frame's receivers, since their truth takes a ray for every light.

use super::cutoff::sizes;
use super::table::{both, column, interval, plot};
use super::{Entry, Session, told_apart};
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::base::statistics::Moments;
use crate::measure::clock::timed;
use crate::measure::reference::Reference;
use crate::measure::summary::CONFIDENCE;
use crate::measure::target::{Target, places};
use crate::measure::trials::side_by_side;
use crate::record::Interval;
use crate::record::study::{Cell, Format, Study, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::Scene;
use crate::scene::file::{self, Overrides};
use crate::strategy::registry::{self, Configured};
use crate::strategy::{BuildContext, Role};
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

/// From the literature's tree to what each place sees.
const STEPS: [(&str, &str); 7] = [
    ("classic tree", "light-tree:arity=2,importance=classic,points=random,open=0"),
    ("+ box horizons, 8 wide", "light-tree:points=random,open=0"),
    ("+ low discrepancy", "light-tree:open=0"),
    ("+ opened at the receiver", "light-tree"),
    ("+ far stop", "light-tree:far=0.02"),
    ("+ visibility", "visible:far=0.02"),
    ("visibility, no far stop", "visible"),
];
/// What the others are measured by: all that choice can do, without what is in between and with it.
const FLOORS: [(&str, &str); 2] = [("floor: intensity", "intensity"), ("floor: oracle", "oracle")];
/// Most lights that the oracle is tried among.
const MOST_OF_ORACLE: usize = 110_000;

/// The scenes that parameters are tried on.
const SWEPT: [&str; 2] = ["scenes/first-night.toml", "scenes/downtown.toml"];
/// Each parameter away from its default.
const SWEEP: [&str; 20] = [
    "visible",
    "visible:cell=2",
    "visible:cell=4",
    "visible:cell=16",
    "visible:cell=32",
    "visible:least=1",
    "visible:least=8",
    "visible:least=128",
    "visible:cut=64",
    "visible:cut=128",
    "visible:cut=512",
    "visible:probes=1",
    "visible:probes=2",
    "visible:probes=8",
    "visible:probes=16",
    "visible:floor=0.05",
    "visible:floor=0.1",
    "visible:floor=0.4",
    "visible:floor=0.7",
    "light-tree",
];

fn run(session: &Session<'_>) -> Result<Study> {
    let options = session.options;
    let sizes = sizes(FEWEST, options.max_lights);
    let smallest = sizes[0];
    let steps = STEPS.iter().chain(&FLOORS).map(|&(step, name)| Ok((step, registry::parse(name)?)));
    let steps: Vec<(&str, Configured)> = steps.collect::<Result<_>>()?;
    let sweep = registry::parse_list(options.strategies.as_deref().unwrap_or(&SWEEP.join(",")))?;
    let mut frames: Vec<(String, &str, Option<u64>)> =
        sizes.into_iter().map(|lights| (format!("canyon-{lights}"), CANYON, Some(lights))).collect();
    frames.push(("plaza".into(), PLAZA, None));
    let mut tables: Vec<TableRecord> = frames.iter().map(|(name, ..)| ablation(session, name)).collect();
    tables.push(sweep_table(session));
    let swept = session.scenes(&SWEPT);
    // Read once before anything is measured: a misspelt name must not cost an hour.
    let scenes: Vec<Scene> = swept.iter().map(|path| file::open(path, &options.overrides)).collect::<Result<_>>()?;
    told_apart(&scenes)?;
    let smallest = Overrides { lights: Some(smallest), ..options.overrides.clone() };
    let own = [file::open(Path::new(CANYON), &smallest)?, file::open(Path::new(PLAZA), &options.overrides)?];
    let mut writer = session.open(scenes.iter().chain(&own), tables)?;
    for (table, path, lights) in &frames {
        let scene = file::open(Path::new(path), &Overrides { lights: *lights, ..options.overrides.clone() })?;
        let few = scene.lights().len() <= MOST_OF_ORACLE;
        let steps: Vec<_> = steps.iter().filter(|(_, of)| few || of.info().role != Role::Oracle).collect();
        let strategies: Vec<&Configured> = steps.iter().map(|(_, strategy)| strategy).collect();
        let mut passes = vec![1, 8, options.passes];
        passes.retain(|&n| n <= options.passes);
        passes.dedup();
        passes.retain(|&passes| !writer.has(table, &of_passes(passes), steps.len()));
        if passes.is_empty() {
            continue;
        }
        let frame = Frame::new(session, scene)?;
        frame.note(&mut writer)?;
        for passes in passes {
            let found = frame.all(session, &strategies, passes)?;
            let product =
                |name: &str| steps.iter().zip(&found).find(|((_, of), _)| of.name() == name).map(|f| f.1.product());
            let (classic, tree) = (product(steps[0].1.name()), product("light-tree"));
            let mut rows = Vec::new();
            for ((step, strategy), found) in steps.iter().zip(&found) {
                let timed = strategy.info().role != Role::Oracle;
                let mut cells: Vec<Cell> = vec![(*step).into(), strategy.name().into(), u64::from(passes).into()];
                cells.extend(found.cells(timed));
                let ratio = |to: Option<f64>| to.filter(|_| timed).map(|to| found.product() / to);
                cells.extend([ratio(classic).into(), ratio(tree).into()]);
                rows.push(cells);
            }
            writer.put(table, &of_passes(passes), rows)?;
        }
    }
    for scene in scenes {
        let key = [("scene", scene.name().into())];
        if writer.has("sweep", &key, sweep.len()) {
            continue;
        }
        let frame = Frame::new(session, scene)?;
        let found = frame.all(session, &sweep.iter().collect::<Vec<_>>(), options.passes)?;
        let mut rows = Vec::new();
        for (strategy, one) in sweep.iter().zip(&found) {
            let mut cells: Vec<Cell> = vec![frame.stage.scene().name().into(), strategy.name().into()];
            cells.extend(one.cells(strategy.info().role != Role::Oracle));
            cells.push((one.product() / found[0].product()).into());
            rows.push(cells);
        }
        writer.put("sweep", &key, rows)?;
    }
    session.finish(writer)
}

/// What tells the rows of a table that were measured together.
fn of_passes(passes: u32) -> [(&'static str, Cell); 1] {
    [("passes", u64::from(passes).into())]
}

fn ablation(session: &Session<'_>, name: &str) -> TableRecord {
    let mut columns = vec![
        column("step", "step", Format::Words),
        column("strategy", "strategy", Format::Name),
        column("passes", "passes", Format::Whole),
    ];
    columns.extend(figures());
    columns.extend([
        column("to_classic", "to\nclassic", Format::Number),
        column("to_tree", "to\nlight-tree", Format::Number),
    ]);
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
    let mut columns = vec![column("scene", "scene", Format::Words), column("strategy", "strategy", Format::Name)];
    columns.extend(figures());
    columns.push(column("to_first", "to\nfirst", Format::Number));
    TableRecord {
        name: "sweep".into(),
        title: "each parameter away from its default, or the strategies asked for".into(),
        columns,
        notes: vec![notes(session), format!("{} passes.", session.options.passes)],
        plots: Vec::new(),
    }
}

fn figures() -> Vec<crate::record::study::ColumnRecord> {
    let mut columns = interval("rel_mse", "relMSE", Format::Number).to_vec();
    columns.extend([
        column("outliers", "over that\nwithout the\nworst 0.1 %", Format::Number),
        column("cpu_s", "CPU s", Format::Number),
        column("error_cpu_s", "relMSE\nx CPU s", Format::Number),
        column("heap_bytes", "memory", Format::Bytes),
    ]);
    columns
}

fn notes(session: &Session<'_>) -> String {
    format!(
        "{} runs, each from nothing in one block of passes on one thread; CPU s: of the whole frame, set-up and learning too; relMSE at {} of its \
         receivers (fewer among 100,000 lights and more). `intensity` is run at these alone and its time brought to the frame; `oracle` has none.",
        session.options.repeats, session.options.pixels
    )
}

/// A frame, and the truth at some of its receivers.
struct Frame {
    stage: Stage,
    places: Vec<usize>,
    reference: Reference,
}

/// What runs of a strategy gave.
struct Found {
    rel_mse: Interval,
    outliers: f64,
    cpu_s: f64,
    heap_bytes: u64,
}

impl Found {
    fn product(&self) -> f64 {
        self.rel_mse.mean * self.cpu_s
    }

    fn cells(&self, timed: bool) -> Vec<Cell> {
        let time = |value: f64| Cell::from(timed.then_some(value));
        let mut cells = both(self.rel_mse).to_vec();
        cells.extend([self.outliers.into(), time(self.cpu_s), time(self.product()), self.heap_bytes.into()]);
        cells
    }
}

/// What one run gave.
struct One {
    strategy: usize,
    rel_mse: f64,
    trimmed: f64,
    cpu_s: f64,
    heap_bytes: u64,
}

impl Frame {
    fn new(session: &Session<'_>, scene: Scene) -> Result<Self> {
        let options = session.options;
        let pixels = match scene.lights().len() {
            0..100_000 => options.pixels,
            100_000..1_000_000 => options.pixels.min(256),
            _ => options.pixels.min(128),
        };
        let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
        let places: Vec<usize> = places(stage.receivers().len(), pixels).collect();
        let few = places.iter().map(|&i| stage.receivers()[i]).collect();
        let reference = session.reference(&Target::of(&stage, few))?;
        Ok(Self { stage, places, reference })
    }

    /// Runs of all strategies.
    fn all(&self, session: &Session<'_>, strategies: &[&Configured], passes: u32) -> Result<Vec<Found>> {
        let options = session.options;
        let of = strategies.len();
        // Run by run, so that all strategies share the machine's good and bad times.
        let run = |unit: usize| {
            self.one(strategies[unit % of], unit % of, passes, RunKey { seed: options.seed, run: (unit / of) as u32 })
        };
        let all = side_by_side(of * options.repeats as usize, options.threads, session.watch, run)?;
        let found = (0..of).map(|strategy| {
            let of =
                |value: fn(&One) -> f64| Moments::of(all.iter().filter(move |one| one.strategy == strategy).map(value));
            let rel_mse = of(|one| one.rel_mse);
            Found {
                rel_mse: Interval { mean: rel_mse.mean, half_width: rel_mse.half_width(CONFIDENCE) },
                outliers: rel_mse.mean / of(|one| one.trimmed).mean,
                cpu_s: of(|one| one.cpu_s).mean,
                heap_bytes: all
                    .iter()
                    .filter(|one| one.strategy == strategy)
                    .map(|one| one.heap_bytes)
                    .max()
                    .unwrap_or(0),
            }
        });
        Ok(found.collect())
    }

    fn one(&self, strategy: &Configured, index: usize, passes: u32, key: RunKey) -> Result<One> {
        let stage = &self.stage;
        let context = BuildContext { stage, seed: key.stream(u32::MAX, 0).bits() };
        let (sampler, setup) = timed(|| strategy.build(context));
        let sampler = sampler?;
        let few: Vec<_> = self.places.iter().map(|&i| stage.receivers()[i]).collect();
        // Those that look at every light share nothing between receivers.
        let alone = FLOORS.iter().any(|(_, name)| *name == strategy.info().name);
        let receivers = if alone { &few[..] } else { stage.receivers() };
        let mut film = Film::new(receivers.len());
        let ((), spent) = timed(|| Plan { stage, receivers, sampler: &*sampler, key }.run(passes, &mut film));
        let scale = stage.receivers().len() as f64 / receivers.len().max(1) as f64;
        let image = film.image();
        let image = if alone { image } else { self.places.iter().map(|&i| image[i]).collect() };
        let errors = self.reference.truth.errors(&image);
        Ok(One {
            strategy: index,
            rel_mse: errors.rel_mse,
            trimmed: errors.rel_mse_trimmed,
            cpu_s: setup.cpu + scale * spent.cpu,
            heap_bytes: sampler.heap_bytes() as u64,
        })
    }

    fn note(&self, writer: &mut StudyWriter) -> Result<()> {
        let (scene, truth) = (self.stage.scene(), &self.reference.truth);
        writer.note(format!(
            "{}, {} lights, {} of which can reach what the camera sees, at {} receivers of {}; the reference's own relMSE is {:.1e}.",
            scene.name(),
            scene.lights().len(),
            self.stage.lights().len(),
            self.places.len(),
            self.stage.receivers().len(),
            truth.own_rel_mse()
        ))
    }
}
