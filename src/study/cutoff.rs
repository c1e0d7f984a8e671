//! What does a hard cut-off cost, in light and in time, and what do its unbiased relatives?
//!
//! Against the number of lights, and against how open the scene is: a plane of equal lamps seen by a facade, where the
//! loss has a closed form; a city without its buildings; the same city, the same lamps and the same receivers with
//! them.

use super::area::by_area;
use super::cells::{cells, claim, measured, remark, unbiased};
use super::columns::{column, interval, plot};
use super::entry::Entry;
use super::plane::{closed_form, plane};
use super::quality::unshadowed;
use super::session::Session;
use super::sizes::sizes;
use super::trial::{Budgets, Tried};
use crate::base::error::{Error, Result};
use crate::measure::errors::Truth;
use crate::measure::target::{Target, spread};
use crate::record::study::{Cell, Format, PlotRecord, Study, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::render::exact::exact;
use crate::scene::camera::Camera;
use crate::scene::cutoff::{Cutoff, Transfer};
use crate::scene::receiver::Receiver;
use crate::scene::{Parts, Scene};
use crate::sources::city::{self, Buildings, City, Grown, LampKind, Lamps};
use crate::strategy::{BuildContext, Configured};
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

pub(super) const ENTRY: Entry = Entry {
    name: "cutoff",
    question: "What does a hard cut-off cost, in light and in time, and what do its unbiased relatives?",
    run,
};

/// Cut-offs of the closed form: displayed steps and the display's curve.
const CUTOFFS: [(f32, Transfer); 4] =
    [(2.0, Transfer::Linear), (0.5, Transfer::Linear), (0.125, Transfer::Linear), (0.5, Transfer::Srgb)];

/// The cut-off and its relatives.
const STRATEGIES: &str = "influence:cutoff=2,influence,influence:cutoff=0.125,influence:transfer=srgb,influence-pick,\
                          influence-tail,stochastic-cull:draw=pass,stochastic-cull:draw=receiver";

/// Least lights of a series: fewer have no far ones.
const FEWEST: u64 = 1_000;
/// Most lamps of a city: buildings of more take minutes to build.
const MOST_IN_CITIES: u64 = 100_000;

/// The kinds of scene, the most open first: the table's name and its title.
const OPENNESS: [(&str, &str); 3] = [
    ("plane", "a plane of equal lamps, seen by a facade"),
    ("open-city", "a city without its buildings"),
    ("city", "the same city with its buildings"),
];

fn run(session: &Session<'_>) -> Result<Study> {
    let strategies =
        session.options.registry.parse_list(session.options.strategies.as_deref().unwrap_or(STRATEGIES))?;
    let biased: Vec<String> = strategies
        .iter()
        .filter(|s| !unbiased(&crate::measure::summary::blank(s)))
        .map(|s| s.name().to_owned())
        .collect();
    let mut tables = vec![law_table()];
    tables.extend(OPENNESS.map(|(name, title)| bias_table(session, name, title, &biased)));
    let mut writer = session.open([], tables)?;
    for lights in sizes(FEWEST, session.options.max_lights) {
        in_the_plane(session, &mut writer, &strategies, lights)?;
        if lights <= MOST_IN_CITIES {
            in_the_city(session, &mut writer, &strategies, lights)?;
        }
    }
    writer.note("All lights are points: the truth is an exact sum over all of them, a shadow ray each.".into())?;
    writer.note(format!(
        "Cities: street lamps alone, bare points 30 m apart, 5,000 to 9,000 lm, EV100 {EV100}; receivers by area, half on streets, half on \
         facades, which stay where they are where the buildings are taken away."
    ))?;
    session.finish(writer)
}

fn law_table() -> TableRecord {
    let mut loss = plot(
        "law",
        "light lost in a plane of lamps",
        "strategy",
        ("lights", "lamps"),
        ("lost", "displayed value (1 is full white)"),
    );
    loss.y.logarithmic = false;
    loss.beside = vec![("closed_form".into(), ", closed form".into())];
    TableRecord {
        name: "law".into(),
        title: "light lost in a plane of equal lamps, by a facade in its midst".into(),
        columns: vec![
            column("lights", "lamps", Format::Whole),
            column("strategy", "strategy", Format::Name),
            column("radius_m", "city radius,\nm", Format::Number),
            column("range_m", "range,\nm", Format::Number),
            column("listed", "lamps\nin range", Format::Number),
            column("lost_share", "light lost,\n%", Format::Percent),
            column("lost", "lost, displayed\n(1: full white)", Format::Number),
            column("closed_form", "closed\nform", Format::Number),
            column("ratio", "ratio", Format::Number),
        ],
        notes: vec![
            "closed form: 2 n_c eps ln(R / r_c) / pi, with n_c lamps within the range r_c, eps the displayed value at which it ends, R \
             the city's radius; 1/pi is what a facade sees of it on average over its directions."
                .into(),
            "by the lists alone: every lamp in range is taken with weight 1, so that the loss has no noise.".into(),
        ],
        plots: vec![loss],
    }
}

fn bias_table(session: &Session<'_>, name: &str, title: &str, biased: &[String]) -> TableRecord {
    let options = session.options;
    let mut columns = vec![
        column("lights", "lights", Format::Whole),
        column("strategy", "strategy", Format::Name),
        column("claim", "claim", Format::Words),
        column("passes", "passes", Format::Whole),
        column("picks_a_sample", "picks\na sample", Format::Number),
    ];
    columns.extend(interval("cpu_s_a_sample", "CPU ns\na sample", Format::Nanoseconds));
    columns.extend(interval("lost_share", "light lost,\n%", Format::Percent));
    columns.extend(interval("rel_mse", "relMSE", Format::Number));
    columns.extend(interval("rel_bias2", "b²", Format::Number));
    columns.extend(interval("variance_cpu_s", "V", Format::Number));
    columns.extend(interval("balance_cpu_s", "t*, s", Format::Number));
    columns.push(column("remark", "", Format::Words));
    let curves = |what: &str, title: String, y: (&str, &str)| -> PlotRecord {
        let mut plot = plot(&format!("{name}-{what}"), &title, "strategy", ("lights", "lights"), y);
        plot.biased = biased.to_vec();
        plot
    };
    let mut lost = curves("lost", format!("light lost: {title}"), ("lost_share", "share of all light"));
    lost.y.logarithmic = false;
    let time = curves("time", format!("time: {title}"), ("cpu_s_a_sample", "CPU s a sample"));
    TableRecord {
        name: name.into(),
        title: format!("bias and time: {title}"),
        columns,
        notes: vec![
            format!(
                "{} runs of up to {} passes (1, 4, 16 and so on, within {} s of counted work) of a frame of {FRAME} receivers; errors at {} of \
                 them. CPU ns a sample: coming to a receiver included, set-up not.",
                options.repeats,
                options.passes,
                options.seconds,
                session.pixels(PIXELS)
            ),
            "b² is squared bias in units of relMSE, V variance x CPU seconds of the frame; from t* = V / b² on, bias outweighs noise (0: from the start)."
                .into(),
        ],
        plots: vec![lost, time],
    }
}

/// The law and the strategies in the plane.
fn in_the_plane(session: &Session<'_>, writer: &mut StudyWriter, strategies: &[Configured], lights: u64) -> Result<()> {
    let plane = plane(lights, FRAME, session.options.seed)?;
    let stage = Stage::new(plane.scene, LeaveOut::No, Offset::SCALED);
    let some = spread(&plane.receivers, session.pixels(PIXELS));
    for (steps, transfer) in CUTOFFS {
        session.watch.check()?;
        let slope = if transfer == Transfer::Srgb { 12.92 } else { 1.0 };
        let curve = if transfer == Transfer::Srgb { "srgb" } else { "linear" };
        let strategy = session.options.registry.parse(&format!("influence:cutoff={steps},transfer={curve}"))?;
        let lights = stage.scene().lights().len() as u64;
        let key = [("lights", lights.into()), ("strategy", strategy.name().into())];
        if writer.has("law", &key, 1) {
            continue;
        }
        let sampler = strategy.build(BuildContext { stage: &stage, seed: session.options.seed })?;
        let range = Cutoff::new(stage.scene(), steps, transfer).volume(&stage.scene().lights()[0]);
        let range = range.map_or(f64::INFINITY, |volume| f64::from(volume.radius2).sqrt());
        let lost: Vec<[f64; 3]> = some
            .par_iter()
            .map_init(Vec::new, |counts, at| {
                counts.clear();
                counts.resize(stage.scene().lights().len(), 0.0f32);
                sampler.expected_counts(at, counts);
                let each = stage.scene().lights().iter().zip(&*counts);
                each.fold([0.0; 3], |[listed, lost, all], (light, &count)| {
                    let f = unshadowed(light, at);
                    [listed + f64::from(count), lost + if count == 0.0 { f } else { 0.0 }, all + f]
                })
            })
            .collect();
        let mean = |of: usize| lost.iter().map(|lost| lost[of]).sum::<f64>() / lost.len() as f64;
        // Exposure is 1 and all is grey: luminance is displayed value.
        let closed = closed_form(range, f64::from(steps) / 255.0 / slope, plane.radius);
        writer.put(
            "law",
            &key,
            vec![vec![
                lights.into(),
                strategy.name().into(),
                plane.radius.into(),
                range.into(),
                mean(0).into(),
                (mean(1) / mean(2)).into(),
                mean(1).into(),
                closed.into(),
                (mean(1) / closed).into(),
            ]],
        )?;
    }
    try_all(session, writer, OPENNESS[0].0, &stage, plane.receivers, strategies)
}

/// The strategies in a city with and without its buildings.
fn in_the_city(session: &Session<'_>, writer: &mut StudyWriter, strategies: &[Configured], lights: u64) -> Result<()> {
    let options = session.options;
    let plan = |buildings| City {
        lights,
        density: DENSITY,
        lamps: Some(Lamps { kind: LampKind::Point, ..Lamps::default() }),
        buildings,
        ..City::default()
    };
    let stage = |buildings| -> Result<Stage> {
        let scene = scene(city::generate(&plan(buildings), options.seed)?, lights, options.seed)?;
        Ok(Stage::new(scene, LeaveOut::No, Offset::SCALED))
    };
    let (open, built) = (stage(None)?, stage(Some(Buildings::default()))?);
    if open.scene().lights() != built.scene().lights() {
        return Err(Error::Invalid("the city's lamps depend on its buildings: the two cannot be compared".into()));
    }
    let receivers = by_area(built.scene(), built.occluders(), FRAME, options.seed)?.receivers;
    try_all(session, writer, OPENNESS[1].0, &open, receivers.clone(), strategies)?;
    try_all(session, writer, OPENNESS[2].0, &built, receivers, strategies)
}

/// Receivers of a frame, which share the state of a pass: as many as an image of 240 x 135 pixels has.
const FRAME: usize = 240 * 135;
/// Receivers that errors are taken at.
const PIXELS: usize = 512;

/// Lights per km^2 of a city that has lamps alone, about.
const DENSITY: f64 = 1_000.0;
/// Exposure of the cities, as of `scenes/downtown.toml`.
const EV100: f32 = 3.5;

fn scene(grown: Grown, lights: u64, seed: u64) -> Result<Scene> {
    Scene::new(Parts {
        name: format!("lamps-{lights}"),
        seed,
        origin: DVec3::ZERO,
        lights: grown.lights,
        groups: grown.groups,
        surfaces: grown.surfaces,
        materials: grown.materials,
        // Nothing is seen through it: receivers are drawn by area.
        camera: Camera::new(Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.0, 1.0, 2.0), 60.0, 1, 1)?,
        ev100: Some(EV100),
        notes: grown.notes,
    })
}

fn try_all(
    session: &Session<'_>,
    writer: &mut StudyWriter,
    table: &str,
    stage: &Stage,
    receivers: Vec<Receiver>,
    strategies: &[Configured],
) -> Result<()> {
    let lights = Cell::from(stage.scene().lights().len() as u64);
    let key = [("lights", lights.clone())];
    if writer.has(table, &key, strategies.len()) {
        return Ok(());
    }
    session.watch.begin(&format!("{table}: the truth"), 1);
    let target = Target::of(stage, receivers).thinned(session.pixels(PIXELS));
    let sum = |at: &Receiver| exact(stage, at, 0, 0).sum.as_vec3();
    let sums: Vec<Vec3> = target.measured().par_iter().map(sum).collect();
    session.watch.end();
    let truth = Truth::new([sums.clone(), sums]);
    let tried = session.trial(&target, &truth, &strategies.iter().collect::<Vec<_>>(), Budgets::Largest)?;
    let row = |tried| std::iter::once(lights.clone()).chain(bias_cells(tried, &target)).collect();
    writer.put(table, &key, tried.iter().map(row).collect())
}

fn bias_cells(tried: &Tried, target: &Target<'_>) -> Vec<Cell> {
    let summary = &tried.summary;
    let mut row = vec![summary.strategy.as_str().into(), claim(summary)];
    if measured(summary) {
        let picks = summary.counts.picks as f64 / summary.counts.samples as f64;
        row.extend([u64::from(summary.passes).into(), picks.into()]);
        row.extend(cells(tried.sample_s(target.frame.len())));
        row.extend(cells(summary.mean_bias.times(-1.0)));
        row.extend(cells(summary.rel_mse));
        row.extend(cells((!unbiased(summary)).then_some(summary.rel_bias2)));
        row.extend(cells(summary.variance_seconds));
        row.extend(cells(summary.balance_s.filter(|balance| balance.mean.is_finite())));
    } else {
        row.resize(22, Cell::Missing);
    }
    row.push(remark(summary));
    row
}
