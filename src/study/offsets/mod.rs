//! Which shadow-ray offset keeps surfaces free of acne and of light leaks, and how far from the origin?
//!
//! Scenes are moved as a whole, coordinates rounded to f32 where they end up, and the same rays are cast under each
//! policy and in f64.

mod geometry;
mod tracer;

use super::table::{column, plot};
use super::{Entry, Session};
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::base::triangle::uniform_point;
use crate::record::study::{Cell, Cells, Format, Study, TableRecord};
use crate::scene::Scene;
use crate::scene::light::{Kind, Light};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::{Arrival, contribution};
use crate::visibility::occluders::Occluders;
use crate::visibility::offset::Offset;
use geometry::Geometry;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::ops::AddAssign;
use tracer::{Tracer, Truth, Way};

pub(super) const ENTRY: Entry = Entry {
    name: "offsets",
    question: "Which shadow-ray offset keeps surfaces free of acne and of light leaks, and how far from the origin?",
    run,
};

/// Where scenes are moved to, in m: all coordinates lie at this or a little above.
const DISTANCES: [u32; 6] = [0, 1_000, 2_048, 10_000, 100_000, 1_000_000];

/// The policies: the default, then the others.
const POLICIES: [(&str, Offset); 4] = Offset::NAMED;

/// The greatest power of two of the series that shows where a policy starts to fail: 1,049 km.
const MOST_DOUBLINGS: u32 = 20;

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

/// For each policy, and each geometry and kind of failure, the first power of two that shows it.
fn starts(measure: impl Fn(Geometry, u32) -> Result<[Counts; POLICIES.len()]>) -> Result<Vec<Cells>> {
    let mut starts = [[[None; 2]; Geometry::ALL.len()]; POLICIES.len()];
    for distance in (0..=MOST_DOUBLINGS).map(|power| 1 << power) {
        for (place, geometry) in Geometry::ALL.into_iter().enumerate() {
            for (starts, found) in starts.iter_mut().zip(measure(geometry, distance)?) {
                for (start, failures) in starts[place].iter_mut().zip([found.acne, found.leaks]) {
                    if failures > 0 {
                        start.get_or_insert(u64::from(distance));
                    }
                }
            }
        }
    }
    let row = |((policy, _), starts): (&(&str, Offset), [[Option<u64>; 2]; Geometry::ALL.len()])| {
        std::iter::once((*policy).into()).chain(starts.into_iter().flatten().map(Cell::from)).collect()
    };
    Ok(POLICIES.iter().zip(starts).map(row).collect())
}

fn columns_of_counts() -> Vec<crate::record::study::ColumnRecord> {
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

fn starts_table() -> TableRecord {
    let mut columns = vec![column("policy", "policy", Format::Name)];
    for geometry in Geometry::ALL {
        let name = geometry.name();
        for (failure, head) in [("acne", "acne"), ("leaks", "leaks")] {
            columns.push(column(&format!("{name}_{failure}_m"), &format!("{name}:\n{head}, m"), Format::Whole));
        }
    }
    TableRecord {
        name: "starts".into(),
        title: "the distance at which failures start".into(),
        columns,
        notes: vec![format!(
            "the first of 1, 2, 4, ... 2^{MOST_DOUBLINGS} m at which one ray fails; nothing where none does at any of them."
        )],
        plots: Vec::new(),
    }
}

/// What became of rays.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    rays: u64,
    undecided: u64,
    differ: u64,
    lit: u64,
    acne: u64,
    dark: u64,
    leaks: u64,
    /// In m; the same for all.
    tolerance: f64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.undecided += other.undecided;
        self.differ += other.differ;
        self.lit += other.lit;
        self.acne += other.acne;
        self.dark += other.dark;
        self.leaks += other.leaks;
        self.tolerance = self.tolerance.max(other.tolerance);
    }
}

impl Counts {
    /// Counts a ray that is what `truth` says, lit without a tolerance if `exact`, and `seen` under the policy.
    fn note(&mut self, truth: Truth, exact: bool, seen: bool) {
        self.rays += 1;
        match truth {
            Truth::Undecided => {
                self.undecided += 1;
                self.differ += u64::from(seen != exact);
            }
            Truth::Lit => {
                self.lit += 1;
                self.acne += u64::from(!seen);
            }
            Truth::Dark => {
                self.dark += 1;
                self.leaks += u64::from(seen);
            }
        }
    }

    fn cells(self) -> impl Iterator<Item = Cell> {
        let decided = self.lit + self.dark;
        let wrong = (decided > 0).then(|| (self.acne + self.leaks) as f64 / decided as f64);
        let whole =
            [self.rays, self.undecided, self.differ, self.lit, self.acne, self.dark, self.leaks].map(Cell::from);
        whole.into_iter().chain([wrong.into(), self.tolerance.into()])
    }
}

/// The same rays of `count` receivers under each policy.
fn counts(scene: &Scene, count: usize, seed: u64) -> Result<[Counts; POLICIES.len()]> {
    let (low, high) = scene.bounds();
    let tolerance = 1e-4 + f64::from(4.0 * f32::EPSILON * low.abs().max(high.abs()).max_element());
    let occluders = Occluders::new(scene);
    let emitters = || scene.lights().iter().filter(|light| light.kind() == Kind::Triangle);
    let corners = scene.surfaces().iter().map(|surface| surface.corners).chain(emitters().map(Light::corners));
    let tracer = Tracer::new(corners);
    let found = (0..count).into_par_iter().map(|number| {
        let mut stream = Stream::keyed(&[seed, u64::from_le_bytes(*b"offsets\0"), number as u64]);
        let at = geometry::receiver(scene, &mut stream, number);
        let mut counts = [Counts { tolerance, ..Counts::default() }; POLICIES.len()];
        let mut emitter = scene.surfaces().len();
        for light in scene.lights() {
            let own = (light.kind() == Kind::Triangle).then_some(emitter);
            emitter += usize::from(own.is_some());
            let uv = stream.uniform2();
            let Ok(arrival) = contribution::<0b1111>(LightSampling::Area, light, uv, &at) else { continue };
            let (truth, exact) = truth(&tracer, tolerance, &at, (light, own), uv);
            for ((_, offset), counts) in POLICIES.iter().zip(&mut counts) {
                counts.note(truth, exact, seen(&occluders, offset, &at, light, &arrival));
            }
        }
        counts
    });
    let add = |mut all: [Counts; POLICIES.len()], more: [Counts; POLICIES.len()]| {
        all.iter_mut().zip(more).for_each(|(all, more)| *all += more);
        all
    };
    Ok(found.reduce(|| [Counts::default(); POLICIES.len()], add))
}

/// What the renderer sees.
fn seen(occluders: &Occluders, offset: &Offset, at: &Receiver, light: &Light, arrival: &Arrival) -> bool {
    occluders.visible(&offset.segment(at, light, arrival.direction, arrival.distance))
}

/// What f64 sees, with the tolerance and whether it sees the light without; `own` is the light's triangle.
fn truth(
    tracer: &Tracer,
    tolerance: f64,
    at: &Receiver,
    (light, own): (&Light, Option<usize>),
    uv: [f32; 2],
) -> (Truth, bool) {
    let surface = at.surface as usize;
    let origin = tracer.on_plane(surface, at.position);
    let side = at.normal.as_dvec3().dot(tracer.unit_normal(surface)).signum();
    let way = if light.kind() == Kind::Directional {
        Way { origin, direction: light.position.as_dvec3().normalize(), length: f64::INFINITY }
    } else {
        let [b1, b2] = if own.is_some() { uniform_point(uv).map(f64::from) } else { [0.0; 2] };
        let [p, a, b] = [light.position, light.a, light.b].map(Vec3::as_dvec3);
        let to_light: DVec3 = p + a * b1 + b * b2 - origin;
        Way { origin, direction: to_light.normalize(), length: to_light.length() }
    };
    // What is all but at an end's horizon may come to lie on either side of it.
    let above = side * tracer.unit_normal(surface).dot(way.direction * way.length.min(1e6));
    let before = own.map_or(f64::INFINITY, |own| tracer.height(own, origin));
    let own = [Some(surface), own];
    match tracer.truth(&way, own, tolerance) {
        Truth::Lit if above.min(before) >= tolerance => (Truth::Lit, true),
        Truth::Dark if above.min(before) >= tolerance => (Truth::Dark, false),
        _ => (Truth::Undecided, above.min(before) > 0.0 && tracer.truth(&way, own, 0.0) == Truth::Lit),
    }
}
