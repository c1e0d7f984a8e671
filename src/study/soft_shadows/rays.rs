//! How does the error of a soft shadow fall with its rays, and how large is its penumbra?

use super::measure::{Contender, Measured, PIXELS, measure};
use super::picture::{Shadow, outlined, shadow, sheet};
use super::scene::{HEIGHT, SIZES, one_light};
use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::image;
use crate::measure::reference::Reference;
use crate::measure::target::{Target, spread};
use crate::record::study::{Cell, Cells, Format, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::render::picture::picture;
use crate::strategy::{AnySampler, BuildContext};
use crate::study::cells::cells;
use crate::study::columns::{column, interval, plot};
use crate::study::fit::PowerLaw;
use crate::study::session::Session;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use rayon::prelude::*;

/// Shadow rays for each triangle of the light.
const RAYS: [u32; 4] = [1, 10, 100, 1000];
/// How points are spread over a light.
const POINTS: [&str; 2] = ["random", "r2"];

pub(super) fn table(session: &Session<'_>) -> TableRecord {
    let mut columns = vec![
        column("light", "light, points", Format::Name),
        column("side_m", "side,\nm", Format::Number),
        column("umbra_share", "umbra,\n%", Format::Percent),
        column("penumbra_share", "penumbra,\n%", Format::Percent),
        column("passes", "rays a\ntriangle", Format::Whole),
        column("rays", "rays a\nreceiver", Format::Number),
    ];
    columns.extend(interval("cpu_s_a_receiver", "CPU ns\na receiver", Format::Nanoseconds));
    columns.extend(interval("rel_mse", "relMSE", Format::Number));
    let title = "error against rays: a post under one square light";
    TableRecord {
        name: "rays".into(),
        title: title.into(),
        columns,
        notes: vec![
            format!(
                "{} receivers; `all`, as many passes as rays a triangle (the square is two), `points=` as named.",
                session.pixels(PIXELS)
            ),
            "the light has the same intensity whatever its size; umbra and penumbra as shares of what the camera sees."
                .into(),
        ],
        plots: vec![
            plot("rays", "error against rays", "light", ("rays", "rays a receiver"), ("rel_mse", "relMSE")),
            plot(
                "time",
                "error against time",
                "light",
                ("cpu_s_a_receiver", "CPU s a receiver"),
                ("rel_mse", "relMSE"),
            ),
        ],
    }
}

pub(super) fn laws() -> TableRecord {
    let mut columns = vec![column("light", "light, points", Format::Name)];
    columns.extend(interval("exponent", "exponent", Format::Number));
    columns.push(column("residual", "residual", Format::Number));
    TableRecord {
        name: "laws".into(),
        title: "error against rays as a power law".into(),
        columns,
        notes: vec![
            "relMSE = factor x rays^exponent; -1 is the law of independent points; residual: rms of ln(y / fit)."
                .into(),
        ],
        plots: Vec::new(),
    }
}

/// Its own error lies far enough below that of 1,000 rays.
const OWN: f64 = 1e-8;

pub(super) fn run(session: &Session<'_>, writer: &mut StudyWriter) -> Result<()> {
    let sizes = SIZES.map(|(_, side)| format!("{side} m")).join(", ");
    let rays = RAYS.map(|rays| rays.to_string()).join(", ");
    let title = format!(
        "Square lights of {sizes} (down) by {rays} rays a triangle and exact (across), there with the outlines of umbra (blue) and \
         penumbra (orange)"
    );
    let picture = writer.picture("shadows.png", title)?;
    let (mut pictures, mut size, mut exposure) = (Vec::new(), (0, 0), 1.0);
    for (name, side) in SIZES {
        session.watch.check()?;
        let key = [("side_m", f64::from(side).into())];
        let is_there = writer.has("rays", &key, POINTS.len() * RAYS.len());
        if is_there && picture.is_none() {
            continue;
        }
        let stage = Stage::new(one_light(session, side, HEIGHT)?, LeaveOut::Yes, Offset::SCALED);
        let whole = Target::whole(&stage);
        let seen = Reference::compute(&whole, 1e-4, &session.options.cache, session.watch)?;
        let shadows: Vec<Shadow> = stage.receivers().par_iter().map(|at| shadow(&stage, at)).collect();
        let mut samplers = Vec::new();
        for points in POINTS {
            for rays in RAYS {
                let strategy = session.options.registry.parse(&format!("all:points={points}"))?;
                let sampler = strategy.build(BuildContext { stage: &stage, seed: session.options.seed })?;
                samplers.push((points, rays, sampler));
            }
        }
        if !is_there {
            writer.put("rays", &key, measured(session, name, side, &stage, &samplers, &shadows)?)?;
        }
        let shown = samplers.iter().filter(|(points, ..)| *points == "random");
        let mut row: Vec<_> = shown.map(|(_, rays, sampler)| rendered(session, &stage, &**sampler, *rays)).collect();
        row.push(outlined(&stage, seen.truth.mean(), &shadows));
        pictures.push(row);
        (size, exposure) = (stage.view().resolution(), stage.scene().exposure());
    }
    if let Some(path) = picture {
        image::write(&path, &sheet(&pictures, size), exposure)?;
    }
    writer.put("laws", &[], fitted(writer))
}

/// Points, rays a triangle, and who draws them.
type Drawn = (&'static str, u32, Box<dyn AnySampler>);

/// The rows of a light.
fn measured(
    session: &Session<'_>,
    name: &str,
    side: f32,
    stage: &Stage,
    samplers: &[Drawn],
    shadows: &[Shadow],
) -> Result<Vec<Cells>> {
    let few = Target::of(stage, spread(stage.receivers(), session.pixels(PIXELS)));
    let reference = Reference::compute(&few, OWN, &session.options.cache, session.watch)?;
    let contenders: Vec<Contender<'_>> =
        samplers.iter().map(|(_, rays, sampler)| Contender { stage, sampler: &**sampler, passes: *rays }).collect();
    let found = measure(session, &format!("{name} light"), &contenders, &few.frame, &reference.truth)?;
    let share = |kind| shadows.iter().filter(|s| **s == kind).count() as f64 / shadows.len().max(1) as f64;
    let row = |((points, rays, _), found): (&Drawn, &Measured)| {
        let mut row: Vec<Cell> = vec![
            format!("{name} {points}").as_str().into(),
            f64::from(side).into(),
            share(Shadow::Umbra).into(),
            share(Shadow::Penumbra).into(),
            u64::from(*rays).into(),
            found.rays.into(),
        ];
        row.extend(cells(found.cpu_s));
        row.extend(cells(found.rel_mse));
        row
    };
    Ok(samplers.iter().zip(&found).map(row).collect())
}

/// The law of each light and kind of points, from the rows of all.
fn fitted(writer: &StudyWriter) -> Vec<Cells> {
    let (table, rows) = writer.table("rays");
    let place = |name| table.column(name).expect("a study names its own columns");
    let (rays, error) = (place("rays"), place("rel_mse"));
    let of_light = rows.chunk_by(|a, b| a[0] == b[0]);
    let law = |rows: &[Cells]| {
        let law = PowerLaw::fit(rows.iter().filter_map(|row| row[rays].number().zip(row[error].number())));
        let mut row = vec![rows[0][0].clone()];
        row.extend(cells(law.map(|law| law.exponent)));
        row.push(law.map(|law| law.residual).into());
        row
    };
    of_light.map(law).collect()
}

/// All of the picture, by so many passes of a sampler.
fn rendered(session: &Session<'_>, stage: &Stage, sampler: &dyn AnySampler, passes: u32) -> Vec<[f32; 3]> {
    let key = RunKey { seed: session.options.seed, run: 0 };
    let mut film = Film::new(stage.receivers().len());
    Plan { stage, receivers: stage.receivers(), sampler, key }.run_parallel(passes, &mut film);
    picture(stage, &film.image())
}
