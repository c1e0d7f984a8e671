//! How do set-up, memory, time and error grow with the number of lights?
//!
//! One recipe at its own density, its extent grown about the same middle: the camera sees the same street, and ever
//! more lights lie beyond it. Growth is given as the exponent of the power law that fits best.

use super::cells::{cells, claim, measured, remark, unbiased};
use super::columns::{column, interval, plot};
use super::entry::Entry;
use super::fit::PowerLaw;
use super::session::Session;
use super::sizes::sizes;
use super::trial::{Budgets, Tried};
use crate::base::claim::Claim;
use crate::base::error::{Error, Result};
use crate::measure::summary::blank;
use crate::measure::target::Target;
use crate::record::study::{Cell, Cells, Format, PlotRecord, Study, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::sources::{self, Overrides};
use crate::strategy::Configured;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use std::path::Path;

pub(super) const ENTRY: Entry =
    Entry { name: "scaling", question: "How do set-up, memory, time and error grow with the number of lights?", run };

/// The recipe that is grown.
const SCENE: &str = "scenes/downtown.toml";
/// Fewest lights.
const FEWEST: u64 = 100;

/// Most lights that the oracle is tried among.
const MOST_OF_ORACLE: u64 = 10_000;

/// What grows: a column of the table, what it is called, and what is written along its axis.
const QUANTITIES: [(&str, &str, &str); 4] = [
    ("setup_cpu_s", "set-up", "CPU s of set-up"),
    ("heap_bytes", "memory", "bytes"),
    ("cpu_s_a_sample", "time of a sample", "CPU s a sample"),
    ("error_passes", "error of a sample", "relMSE x passes"),
];

fn run(session: &Session<'_>) -> Result<Study> {
    let options = session.options;
    let strategies = session.strategies(&[])?;
    let files = session.scenes(&[SCENE]);
    let [path] = &files[..] else {
        return Err(Error::Invalid("study scaling grows one recipe: a single --scene is right".into()));
    };
    let sizes = sizes(FEWEST, options.max_lights);
    // Read once before anything is measured: a recipe without a city cannot be grown.
    let smallest = sources::open(path, &Overrides { lights: Some(sizes[0]), ..options.overrides.clone() })?;
    let mut writer = session.open([&smallest], vec![growth(session, &strategies), exponents()])?;
    for lights in sizes {
        at_size(session, &mut writer, path, &strategies, lights)?;
    }
    let mut laws = Vec::new();
    for strategy in &strategies {
        for (column, what, _) in QUANTITIES {
            if let Some(law) = law(&writer, strategy, column) {
                let mut row: Vec<Cell> = vec![strategy.name().into(), what.into()];
                row.extend(cells(law.exponent));
                row.extend([law.factor.into(), law.residual.into(), (law.points as u64).into()]);
                laws.push(row);
            }
        }
    }
    writer.put("exponents", &[], laws)?;
    session.finish(writer)
}

fn growth(session: &Session<'_>, strategies: &[Configured]) -> TableRecord {
    let options = session.options;
    let mut columns = vec![
        column("lights", "lights", Format::Whole),
        column("strategy", "strategy", Format::Name),
        column("claim", "claim", Format::Words),
    ];
    columns.extend(interval("setup_cpu_s", "set-up\nms", Format::Milliseconds));
    columns.extend([
        column("heap_bytes", "memory", Format::Bytes),
        column("bytes_a_light", "bytes\na light", Format::Number),
    ]);
    columns.extend(interval("cpu_s_a_sample", "CPU ns\na sample", Format::Nanoseconds));
    columns.extend([column("passes", "passes", Format::Whole), column("receivers", "receivers", Format::Whole)]);
    columns.extend(interval("rel_mse", "relMSE", Format::Number));
    columns.extend(interval("error_passes", "relMSE\nx passes", Format::Number));
    columns.push(column("remark", "", Format::Words));
    let biased = strategies.iter().filter(|s| matches!(blank(s).claim, Claim::Biased { .. }));
    let biased: Vec<String> = biased.map(|s| s.name().to_owned()).collect();
    let plot = |(column, what, label): (&str, &str, &str)| PlotRecord {
        biased: biased.clone(),
        ..plot(
            &column.replace('_', "-"),
            &format!("{what} against lights"),
            "strategy",
            ("lights", "lights"),
            (column, label),
        )
    };
    TableRecord {
        name: "growth".into(),
        title: "growth with the number of lights".into(),
        columns,
        notes: vec![
            format!(
                "{} runs of up to {} passes (1, 4, 16 and so on, within {} s of counted work) of all that the camera sees, each in one block on \
                 one thread; relMSE at so many of its receivers.",
                options.repeats, options.passes, options.seconds
            ),
            format!(
                "the oracle is run among {MOST_OF_ORACLE} lights or fewer, at some of the receivers, and has no time."
            ),
            "a biased strategy has no relMSE x passes: its error does not fall as 1 / passes.".into(),
            "CPU ns a sample: coming to a receiver included, set-up not.".into(),
        ],
        plots: QUANTITIES.map(plot).to_vec(),
    }
}

fn exponents() -> TableRecord {
    let mut columns = vec![column("strategy", "strategy", Format::Name), column("quantity", "of", Format::Words)];
    columns.extend(interval("exponent", "exponent", Format::Number));
    columns.extend([
        column("factor", "factor", Format::Number),
        column("residual", "residual", Format::Number),
        column("points", "points", Format::Whole),
    ]);
    TableRecord {
        name: "exponents".into(),
        title: "exponents of growth: y = factor x lights^exponent".into(),
        columns,
        notes: vec![
            "least squares on logarithmic axes, in s, bytes and relMSE; residual: root mean square of ln(y / fit), 0.1 is about 10 %."
                .into(),
            "an exponent's interval is that of points which scatter about a line: it grows with the residual.".into(),
            "what was measured at fewer than three sizes has none.".into(),
        ],
        plots: Vec::new(),
    }
}

fn at_size(
    session: &Session<'_>,
    writer: &mut StudyWriter,
    path: &Path,
    strategies: &[Configured],
    lights: u64,
) -> Result<()> {
    let scene = sources::open(path, &Overrides { lights: Some(lights), ..session.options.overrides.clone() })?;
    // Every arrival of the oracle takes as many rays as the truth.
    let within = |strategy: &&Configured| lights <= MOST_OF_ORACLE || strategy.info().claim != Claim::Oracle;
    let strategies: Vec<&Configured> = strategies.iter().filter(within).collect();
    let key = [("lights", (scene.lights().len() as u64).into())];
    if writer.has("growth", &key, strategies.len()) {
        return Ok(());
    }
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    // Heavy tails want all the receivers that there are.
    let whole = Target::whole(&stage);
    let (target, reference) = session.reference(&whole.thinned(session.pixels(whole.places.len())))?;
    writer.note(format!(
        "{} lights, {} of which can reach what the camera sees; the reference's own relMSE is {:.1e}.",
        stage.scene().lights().len(),
        stage.lights().len(),
        reference.truth.own_rel_mse()
    ))?;
    let tried = session.trial(&target, &reference.truth, &strategies, Budgets::Largest)?;
    let lights = Cell::from(stage.scene().lights().len() as u64);
    let row = |tried| std::iter::once(lights.clone()).chain(growth_cells(tried, &target)).collect();
    writer.put("growth", &key, tried.iter().map(row).collect())
}

fn growth_cells(tried: &Tried, target: &Target<'_>) -> Vec<Cell> {
    let summary = &tried.summary;
    let mut row = vec![summary.strategy.as_str().into(), claim(summary)];
    if measured(summary) {
        row.extend(cells(summary.setup_cpu_s));
        row.push(summary.heap_bytes.into());
        row.push((summary.heap_bytes as f64 / target.stage.scene().lights().len() as f64).into());
        row.extend(cells(tried.sample_s(target.frame.len())));
        row.push(u64::from(summary.passes).into());
        row.push(summary.receivers.unwrap_or(target.places.len() as u64).into());
        row.extend(cells(summary.rel_mse));
        row.extend(cells(unbiased(summary).then(|| summary.rel_mse.times(f64::from(summary.passes)))));
    } else {
        row.resize(18, Cell::Missing);
    }
    row.push(remark(summary));
    row
}

/// How a column of a strategy's rows grows with the first, the number of lights.
fn law(writer: &StudyWriter, strategy: &Configured, column: &str) -> Option<PowerLaw> {
    let (table, rows) = writer.table("growth");
    let at = table.column(column)?;
    let mine = rows.iter().filter(|cells: &&Cells| cells[1] == Cell::from(strategy.name()));
    PowerLaw::fit(mine.filter_map(|cells| cells[0].number().zip(cells[at].number())))
}
