//! How do set-up, memory, time and error grow with the number of lights?
//!
//! One recipe at its own density, its extent grown about the same middle: the camera sees the same street, and ever
//! more lights lie beyond it. Growth is given as the exponent of the power law that fits best.

use super::cutoff::sizes;
use super::fit::PowerLaw;
use super::table::{both, claim, column, interval, measured, plot, remark, unbiased};
use super::timing::{self, Timing};
use super::{Entry, Session};
use crate::base::error::{Error, Result};
use crate::measure::plan::Budget;
use crate::measure::summary::blank;
use crate::measure::target::{Target, spread};
use crate::measure::trials::Trials;
use crate::record::study::{Cell, Cells, Format, PlotRecord, Study, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::record::{Claim, Summary};
use crate::scene::file::{self, Overrides};
use crate::strategy::Role;
use crate::strategy::registry::Configured;
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
const MOST_OF_ORACLE: u64 = 100_000;

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
    let smallest = file::open(path, &Overrides { lights: Some(sizes[0]), ..options.overrides.clone() })?;
    let mut writer = session.open([&smallest], vec![growth(session, &strategies), exponents()])?;
    for lights in sizes {
        at_size(session, &mut writer, path, &strategies, lights)?;
    }
    let mut laws = Vec::new();
    for strategy in &strategies {
        for (column, what, _) in QUANTITIES {
            if let Some(law) = law(&writer, strategy, column) {
                laws.push(vec![
                    strategy.name().into(),
                    what.into(),
                    law.exponent.into(),
                    law.factor.into(),
                    law.residual.into(),
                    (law.points as u64).into(),
                ]);
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
        column("setup_cpu_s", "set-up\nms", Format::Milliseconds),
        column("heap_bytes", "memory", Format::Bytes),
        column("bytes_a_light", "bytes\na light", Format::Number),
        column("cpu_s_a_sample", "CPU ns\na sample", Format::Nanoseconds),
        column("passes", "passes", Format::Whole),
        column("receivers", "receivers", Format::Whole),
    ];
    columns.extend(interval("rel_mse", "relMSE", Format::Number));
    columns.extend([column("error_passes", "relMSE\nx passes", Format::Number), column("remark", "", Format::Words)]);
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
                "{} runs of {} passes each (fewer where they take more than {} CPU s), each on one thread, set-up too.",
                options.repeats, options.passes, options.seconds
            ),
            "a biased strategy has no relMSE x passes: its error does not fall as 1 / passes.".into(),
            timing::note("all that the camera sees"),
        ],
        plots: QUANTITIES.map(plot).to_vec(),
    }
}

fn exponents() -> TableRecord {
    TableRecord {
        name: "exponents".into(),
        title: "exponents of growth: y = factor x lights^exponent".into(),
        columns: vec![
            column("strategy", "strategy", Format::Name),
            column("quantity", "of", Format::Words),
            column("exponent", "exponent", Format::Number),
            column("factor", "factor", Format::Number),
            column("residual", "residual", Format::Number),
            column("points", "points", Format::Whole),
        ],
        notes: vec![
            "least squares on logarithmic axes, in s, bytes and relMSE; residual: root mean square of ln(y / fit), 0.1 is about 10 %."
                .into(),
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
    let options = session.options;
    let scene = file::open(path, &Overrides { lights: Some(lights), ..options.overrides.clone() })?;
    let key = [("lights", (scene.lights().len() as u64).into())];
    if writer.has("growth", &key, strategies.len()) {
        return Ok(());
    }
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    // The truth takes a ray for every light: of many lights, at fewer receivers.
    let pixels = match lights {
        0..100_000 => options.pixels,
        100_000..1_000_000 => options.pixels.min(128),
        _ => options.pixels.min(64),
    };
    let target = Target::of(&stage, spread(stage.receivers(), pixels));
    let reference = session.reference(&target)?;
    writer.note(format!(
        "{} lights, {} of which can reach what the camera sees; the reference's own relMSE is {:.1e}.",
        stage.scene().lights().len(),
        stage.lights().len(),
        reference.truth.own_rel_mse()
    ))?;
    let trials = Trials {
        target: &target,
        truth: &reference.truth,
        budget: Budget { usual_passes: options.passes, most_passes: options.passes, seconds: options.seconds },
        runs: options.repeats,
        seed: options.seed,
        threads: options.threads,
    };
    // The oracle's every arrival takes as many rays as the truth, and its pilot arrives a dozen times.
    let (tried, told): (Vec<&Configured>, Vec<&Configured>) =
        strategies.iter().partition(|strategy| lights <= MOST_OF_ORACLE || strategy.info().role != Role::Oracle);
    let skipped = told.into_iter().map(|strategy| {
        let skipped = format!("skipped: above {MOST_OF_ORACLE} lights");
        (strategy, Summary { skipped: Some(skipped), ..blank(strategy) })
    });
    let summaries = trials.run(&tried, session.watch)?;
    let mut rows = Vec::new();
    for (strategy, summary) in tried.iter().copied().zip(summaries).chain(skipped) {
        let timing = Timing::of(&trials, strategy, &summary, stage.receivers().len())?;
        let mut cells = vec![(stage.scene().lights().len() as u64).into()];
        cells.extend(growth_cells(&summary, timing, &target));
        rows.push(cells);
    }
    writer.put("growth", &key, rows)
}

fn growth_cells(summary: &Summary, timing: Option<Timing>, target: &Target<'_>) -> Vec<Cell> {
    let receivers = target.receivers.len();
    let mut cells = vec![summary.strategy.as_str().into(), claim(summary)];
    if measured(summary) {
        cells.extend([
            summary.setup_cpu_s.into(),
            summary.heap_bytes.into(),
            (summary.heap_bytes as f64 / target.stage.scene().lights().len() as f64).into(),
            timing.map(|timing| timing.sample_s()).into(),
            u64::from(summary.passes).into(),
            (receivers as u64).into(),
        ]);
        cells.extend(both(summary.rel_mse));
        cells.push(unbiased(summary).then(|| summary.rel_mse.mean * f64::from(summary.passes)).into());
    } else {
        cells.resize(11, Cell::Missing);
    }
    cells.push(remark(summary));
    cells
}

/// How a column of a strategy's rows grows with the first, the number of lights.
fn law(writer: &StudyWriter, strategy: &Configured, column: &str) -> Option<PowerLaw> {
    let (table, rows) = writer.table("growth");
    let at = table.column(column)?;
    let mine = rows.iter().filter(|cells: &&Cells| cells[1] == Cell::from(strategy.name()));
    PowerLaw::fit(mine.filter_map(|cells| cells[0].number().zip(cells[at].number())))
}
