//! Which tables and notes does the study of offsets have?

use super::counts::{Counts, POLICIES, counts};
use super::geometry::Geometry;
use super::starts::{starts, starts_table};
use crate::base::error::Result;
use crate::record::study::{Cell, ColumnRecord, Format, Study, TableRecord};
use crate::study::columns::{column, plot};
use crate::study::entry::Entry;
use crate::study::session::Session;
use crate::visibility::offset::Offset;

pub(in crate::study) const ENTRY: Entry = Entry {
    name: "offsets",
    question: "Which shadow-ray offset keeps surfaces free of acne and of light leaks, and how far from the origin?",
    run,
};

/// Where scenes are moved to, in m: all coordinates lie at this or a little above.
const DISTANCES: [u32; 6] = [0, 1_000, 2_048, 10_000, 100_000, 1_000_000];

fn run(session: &Session<'_>) -> Result<Study> {
    let mut writer = session.open([], vec![counts_table(), totals_table(), starts_table()])?;
    let (count, seed) = (session.options.receivers, session.options.seed);
    let measure = |geometry: Geometry, distance: u32| -> Result<[Counts; POLICIES.len()]> {
        session.watch.check()?;
        counts(&geometry.baked(f64::from(distance))?, count, seed)
    };
    for distance in DISTANCES {
        let key = [("distance_m", u64::from(distance).into())];
        if writer.has("counts", &key, Geometry::ALL.len() * POLICIES.len())
            && writer.has("totals", &key, POLICIES.len())
        {
            continue;
        }
        let mut rows = Vec::new();
        let mut totals = [Counts::default(); POLICIES.len()];
        for geometry in Geometry::ALL {
            let found = measure(geometry, distance)?;
            for (policy, (found, total)) in found.into_iter().zip(&mut totals).enumerate() {
                *total += found;
                let start = [Cell::from(u64::from(distance)), geometry.name().into(), POLICIES[policy].0.into()];
                rows.push(start.into_iter().chain(found.cells()).collect());
            }
        }
        writer.put("counts", &key, rows)?;
        let total = |((policy, _), total): (&(&str, Offset), Counts)| {
            let start = [Cell::from(u64::from(distance)), (*policy).into()];
            start.into_iter().chain(total.cells()).collect()
        };
        writer.put("totals", &key, POLICIES.iter().zip(totals).map(total).collect())?;
    }
    if !writer.has("starts", &[], POLICIES.len()) {
        writer.put("starts", &[], starts(measure)?)?;
    }
    writer.note(format!(
        "Geometry: flat is a slope of 32 triangles with a box over it, under lamps, panels and the moon; grazing is that slope with \
         kerbs, and lamps and panels 3 to 80 cm above it; concave is a corner of thin walls with stairs and a lean-to of 15 degrees, lamps \
         and panels inside and, from 2 cm on, behind the walls. {count} receivers on all surfaces, half of them near edges, \
         one ray to each light that is not behind."
    ))?;
    writer.note(
        "Distance: what is added to every coordinate, in f64, before it is rounded to f32. The f64 tracer takes the rounded numbers, the \
         receiver's too, and starts at the place on the receiver's own triangle that its rounded position stands for."
            .into(),
    )?;
    writer.note(
        "Acne: f64 sees the light, with the receiver's and the light's own triangles left out, and the policy does not. Leak: f64 sees \
         an occluder, and the policy sees the light."
            .into(),
    )?;
    writer.note(
        "Undecided, and counted apart: rays whose answer in f64 hangs on less than 0.1 mm and four units in the last place of the \
         greatest coordinate (2^-21 of it: 5 mm at 10 km), as they pass an edge, begin or end beside a triangle, or run along the horizon. It \
         is the farthest from its place that a ray of the default policy may start."
            .into(),
    )?;
    session.finish(writer)
}

fn columns_of_counts() -> Vec<ColumnRecord> {
    vec![
        column("rays", "rays", Format::Whole),
        column("undecided", "un-\ndecided", Format::Whole),
        column("undecided_differ", "of which\ndiffer", Format::Whole),
        column("lit", "lit", Format::Whole),
        column("acne", "acne", Format::Whole),
        column("dark", "dark", Format::Whole),
        column("leaks", "leaks", Format::Whole),
        column("wrong_share", "wrong,\n%", Format::Percent),
        column("tolerance_m", "tolerance,\nm", Format::Number),
    ]
}

fn counts_table() -> TableRecord {
    let mut columns = vec![
        column("distance_m", "distance,\nm", Format::Whole),
        column("geometry", "geometry", Format::Name),
        column("policy", "policy", Format::Name),
    ];
    columns.extend(columns_of_counts());
    TableRecord {
        name: "counts".into(),
        title: "acne and leaks, by distance, geometry and policy".into(),
        columns,
        notes: vec!["wrong: share of the decided rays that are acne or leaks.".into()],
        plots: Vec::new(),
    }
}

fn totals_table() -> TableRecord {
    let mut wrong = plot(
        "wrong",
        "shadow rays that are wrong, far from the origin",
        "policy",
        ("distance_m", "distance from the origin, m"),
        ("wrong_share", "share of decided rays"),
    );
    wrong.y.logarithmic = false;
    let mut columns =
        vec![column("distance_m", "distance,\nm", Format::Whole), column("policy", "policy", Format::Name)];
    columns.extend(columns_of_counts());
    TableRecord {
        name: "totals".into(),
        title: "acne and leaks of all geometries together".into(),
        columns,
        notes: Vec::new(),
        plots: vec![wrong],
    }
}
