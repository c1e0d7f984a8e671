//! How should points on a light be drawn, and where does drawing them by angle pay?

use super::measure::{Contender, PIXELS, measure};
use super::scene::{HEIGHT, SIZES, one_light};
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::measure::engine::Meter;
use crate::measure::reference::Reference;
use crate::measure::target::{Target, spread};
use crate::record::study::{Cell, Format, TableRecord};
use crate::record::study_store::StudyWriter;
use crate::scene::light::{Light, Shape};
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::strategy::BuildContext;
use crate::study::cells::cells;
use crate::study::columns::{column, interval, plot};
use crate::study::session::Session;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use std::hint::black_box;

/// Powers of two of area over squared distance.
const RATIOS: std::ops::RangeInclusive<i32> = -7..=4;
/// Triangles and receivers of a ratio, and points on each.
const PAIRS: usize = 600;
const SAMPLES: usize = 400;
/// CPU seconds of the rest of a sample: choosing the light and its shadow ray, as `power` and `light-tree` take in
/// cities.
const REST: f64 = 300e-9;

/// The ways that are settled.
const WAYS: [LightSampling; 3] = [LightSampling::Area, LightSampling::SolidAngle, LightSampling::Projected];

pub(super) fn table() -> TableRecord {
    let mut columns = vec![column("ratio", "area /\ndistance²", Format::Number)];
    for (name, head) in [("area", "area"), ("solid_angle", "solid\nangle"), ("projected", "projected")] {
        columns.push(column(&format!("{name}_variance"), &format!("variance,\n{head}"), Format::Number));
    }
    for (name, head) in [("area", "area"), ("solid_angle", "solid\nangle"), ("projected", "projected")] {
        columns.push(column(&format!("{name}_cpu_s"), &format!("CPU ns,\n{head}"), Format::Nanoseconds));
    }
    for (name, head) in [("solid_angle", "solid\nangle"), ("projected", "projected")] {
        columns.push(column(&format!("{name}_cost"), &format!("cost,\n{head}"), Format::Number));
    }
    columns.push(column("auto", "auto", Format::Words));
    TableRecord {
        name: "ways".into(),
        title: "points by area, by solid angle, projected: random triangles and receivers, nothing in between".into(),
        columns,
        notes: vec![
            format!(
                "variance: of one point, relative to the squared mean; the mean over {PAIRS} triangles of random shape, each with a receiver in \
                 front of it at random, its horizon too. CPU ns: drawing the point and shading it, no ray."
            ),
            format!(
                "cost: (1 + variance) x ({:.0} ns + CPU ns), over that by area: 1 stands for what choosing a light and visibility leave of \
                 variance in a city, where it is 1 or more, {:.0} ns for choosing and the shadow ray. Below 1 the way pays. auto: what it takes for most of them.",
                1e9 * REST,
                1e9 * REST
            ),
        ],
        plots: vec![{
            let mut costs = plot(
                "ways",
                "what drawing by angle costs against area",
                "auto",
                ("ratio", "area / distance²"),
                ("projected_cost", "cost, projected"),
            );
            costs.beside = vec![("solid_angle_cost".into(), ", solid angle".into())];
            costs
        }],
    }
}

pub(super) fn by_size() -> TableRecord {
    let mut columns = vec![column("light", "light", Format::Words), column("by", "points by", Format::Name)];
    columns.extend(interval("cpu_s_a_receiver", "CPU ns\na receiver", Format::Nanoseconds));
    columns.extend(interval("rel_mse", "relMSE", Format::Number));
    columns.extend(interval("cost_cpu_s", "relMSE x\nCPU ns", Format::Nanoseconds));
    TableRecord {
        name: "by-size".into(),
        title: format!(
            "points by area, by solid angle, projected: a post under one square light, {PASSES} rays a triangle"
        ),
        columns,
        notes: vec![format!(
            "`all`, points=r2; near: a light of {:.0} m at {:.1} m over the ground, the others at {HEIGHT:.0} m.",
            NEAR.0, NEAR.1
        )],
        plots: Vec::new(),
    }
}

/// Points on each of the light's two triangles.
const PASSES: u32 = 8;
/// Side and height of a light next to the ground, in m.
const NEAR: (f32, f32) = (2.0, 1.2);

pub(super) fn run(session: &Session<'_>, writer: &mut StudyWriter) -> Result<()> {
    for power in RATIOS {
        session.watch.check()?;
        let ratio = 2f32.powi(power);
        let key = [("ratio", f64::from(ratio).into())];
        if !writer.has("ways", &key, 1) {
            let row = session.engine().alone(|meter| at_ratio(ratio, session.options.seed, meter))?;
            writer.put("ways", &key, vec![row])?;
        }
    }
    let sizes = SIZES.map(|(name, side)| (name, side, HEIGHT));
    for (name, side, height) in sizes.into_iter().chain([("near", NEAR.0, NEAR.1)]) {
        let key = [("light", name.into())];
        if writer.has("by-size", &key, LightSampling::NAMED.len()) {
            continue;
        }
        let stages = LightSampling::NAMED
            .iter()
            .map(|&(_, by)| {
                let stage = Stage::new(one_light(session, side, height)?, LeaveOut::Yes, Offset::SCALED);
                Ok(stage.with_light_sampling(by))
            })
            .collect::<Result<Vec<_>>>()?;
        let target = Target::of(&stages[0], spread(stages[0].receivers(), session.pixels(PIXELS)));
        let reference = Reference::compute(&target, 1e-6, &session.options.cache, session.watch)?;
        let strategy = session.options.registry.parse("all")?;
        let samplers = stages
            .iter()
            .map(|stage| strategy.build(BuildContext { stage, seed: session.options.seed }))
            .collect::<Result<Vec<_>>>()?;
        let contenders: Vec<Contender<'_>> = stages
            .iter()
            .zip(&samplers)
            .map(|(stage, sampler)| Contender { stage, sampler: &**sampler, passes: PASSES })
            .collect();
        let measured =
            measure(session, &format!("{name} light, by way"), &contenders, &target.frame, &reference.truth)?;
        let mut rows = Vec::new();
        for ((by, _), found) in LightSampling::NAMED.iter().zip(&measured) {
            let mut row: Vec<Cell> = vec![name.into(), (*by).into()];
            row.extend(cells(found.cpu_s));
            row.extend(cells(found.rel_mse));
            row.extend(cells(found.cost_s()));
            rows.push(row);
        }
        writer.put("by-size", &key, rows)?;
    }
    Ok(())
}

/// Variance and time of each way where a triangle's area over its squared distance is `ratio`.
fn at_ratio(ratio: f32, seed: u64, meter: Meter<'_>) -> Vec<Cell> {
    let mut rng = Stream::keyed(&[seed, u64::from(ratio.to_bits()), u64::from_le_bytes(*b"by ratio")]);
    let pairs: Vec<(Light, Receiver)> =
        std::iter::repeat_with(|| pair(ratio, &mut rng)).flatten().take(PAIRS).collect();
    let numbers: Vec<[f32; 2]> = std::iter::repeat_with(|| rng.uniform2()).take(SAMPLES).collect();
    let found = WAYS.map(|by| {
        let variances = pairs.iter().map(|(light, at)| variance(by, light, at, &numbers));
        let variance = variances.sum::<f64>() / PAIRS as f64;
        let ((), spent) = meter.time(|| {
            for (light, at) in &pairs {
                for &uv in &numbers {
                    _ = black_box(contribution::<0b1111>(by, light, uv, at));
                }
            }
        });
        (variance, spent.cpu / (PAIRS * SAMPLES) as f64)
    });
    let cost = |(variance, cpu_s): (f64, f64)| (1.0 + variance) * (REST + cpu_s);
    let mut cells: Vec<Cell> = vec![f64::from(ratio).into()];
    cells.extend(found.map(|(variance, _)| variance.into()));
    cells.extend(found.map(|(_, cpu_s)| cpu_s.into()));
    cells.extend([1, 2].map(|way| (cost(found[way]) / cost(found[0])).into()));
    // What it takes for most: it goes by more than the ratio.
    let by_area = |(light, at): &&(Light, Receiver)| LightSampling::Auto.settled(light, at) == LightSampling::Area;
    let most = if 2 * pairs.iter().filter(by_area).count() > PAIRS { WAYS[0] } else { WAYS[1] };
    cells.push(most.name().into());
    cells
}

/// A triangle of area 1 and any shape, and a receiver in front of it that it lights; `None` where it does not.
fn pair(ratio: f32, rng: &mut Stream) -> Option<(Light, Receiver)> {
    let mut any = || Vec3::from([rng.uniform(), rng.uniform(), rng.uniform()]) * 2.0 - 1.0;
    let mut inside = || loop {
        let at = any();
        if (0.01..1.0).contains(&at.length_squared()) {
            return at;
        }
    };
    let corners = [inside(), inside(), inside()];
    let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
    let corners = corners.map(|corner| corner / area.sqrt());
    let light = Light::from(Shape::Triangle { corners, radiance: Vec3::ONE });
    let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    let away = inside().normalize() / ratio.sqrt();
    let normal = inside().normalize();
    let at = Receiver { position: centre + away, normal, view: normal, albedo: Vec3::ONE, pixel: 0, surface: 0 };
    let lit = (0..64).filter(|_| contribution::<0b1111>(LightSampling::Area, &light, rng.uniform2(), &at).is_ok());
    (lit.count() >= 8).then_some((light, at))
}

/// Variance of one point relative to the squared mean.
fn variance(by: LightSampling, light: &Light, at: &Receiver, numbers: &[[f32; 2]]) -> f64 {
    let (mut sum, mut squares) = (0.0, 0.0);
    for &uv in numbers {
        let x = contribution::<0b1111>(by, light, uv, at).map_or(0.0, |arrival| f64::from(arrival.radiance.x));
        sum += x;
        squares += x * x;
    }
    let n = numbers.len() as f64;
    if sum > 0.0 { (n * squares / (sum * sum) - 1.0).max(0.0) } else { 0.0 }
}
