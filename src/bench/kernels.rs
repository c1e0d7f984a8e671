//! How fast are the parts that every strategy stands on?
//!
//! All on `downtown`, on one thread, in CPU time. What is wanted (the ratio is judged on stderr):
//!
//! | benchmark | of what | wanted |
//! |---|---|---|
//! | `shadow-ray/ours` | a shadow ray to a light resampled from 16 candidates, offsets included | 3 million/s or more |
//! | `shadow-ray/bare` | the same ray, made before, through the library alone | |
//! | `shadow-ray-ratio/bare-over-ours` | the two taken in turns | 0.95 or more |
//! | `influence/query` | the list of lights in range of a visible point | 400 ns + 25 ns a listed light or less |
//! | `alias-table/draw` | a light by its flux | |
//! | `light-tree/downtown/8`, `downtown/2` | a pick of the light tree by arity, 64 passes a receiver | 500 ns, 900 ns or less |
//! | `light-tree/megacity/8` | the same among a million lights | twice that among ten thousand or less |
//! | `triangle/solid-angle` | a triangle of a metre at 0.3 to 100 m, any facing, from its corners | 35 ns or less, better 20 |
//! | `triangle/irradiance` | the same, for a receiver whose horizon cuts one in ten | 100 ns or less, better 60 |
//! | `triangle/solid-angle-sample` | sampler and a point of it | 160 ns or less, better 80 |
//! | `triangle/projected-sample` | the same over the irradiance | |
//! | `power/without-ray` | a pick by flux and its shading, everything but the ray | 150 ns or less |

use super::quantity::{CPU_TIME, RATIO, Reported, criterion, flat};
use super::scenes::stage;
use super::timing::{Duel, per_element};
use crate::base::colour::luminance;
use crate::base::discrete::AliasTable;
use crate::base::draws::Points;
use crate::base::error::Result;
use crate::base::random::{RunKey, Stream};
use crate::base::triangle::{Projected, Seen, SolidAngle};
use crate::measure::target::spread;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::cutoff::{Cutoff, Transfer};
use crate::scene::light::Light;
use crate::scene::light_sampling::LightSampling;
use crate::scene::needs::Needs;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::{Arrival, contribution};
use crate::shading::importance::importance;
use crate::strategy::{BuildContext, Frame, PickBuffer, Registry};
use crate::visibility::influence_tree::InfluenceTree;
use crate::visibility::offset::Segment;
use crate::visibility::stage::Stage;
use criterion::{BenchmarkGroup, Criterion, SamplingMode, Throughput};
use glam::DVec3;
use obvhs::ray::Ray;
use obvhs::rt_triangle::RtTriangle;
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

/// Lights that each receiver chooses from.
const CANDIDATES: usize = 16;

/// All these groups on two scenes of a folder: `downtown.toml`, and `megacity.toml` for the tree of a million lights.
///
/// # Errors
/// A scene that cannot be read, or that has no lights.
pub fn kernels(scenes: &Path) -> Result<()> {
    let city = stage(&scenes.join("downtown.toml"))?;
    let mut criterion = criterion(CPU_TIME).measurement_time(Duration::from_secs(1));
    triangles(&mut criterion);
    let questions = questions(&city);
    shadow_rays(&mut criterion, &city, &questions);
    influence_query(&mut criterion, &city);
    alias_draw(&mut criterion, &city)?;
    light_tree_pick(&mut criterion, "downtown", &city, &["8", "2"])?;
    power_without_ray(&mut criterion, city)?;
    light_tree_pick(&mut criterion, "megacity", &stage(&scenes.join("megacity.toml"))?, &["8"])?;
    criterion.final_summary();
    Ok(())
}

/// A shadow ray to come: from a receiver, over a direction and a distance.
struct Question {
    from: Receiver,
    /// At hand, as where a pick is shaded.
    light: Light,
    to: Arrival,
}

/// One ray a receiver, to a light that resampling would choose: candidates by chance, one of them by importance.
///
/// Source: Talbot, Cline, Egbert, EGSR 2005.
fn questions(stage: &Stage) -> Vec<Question> {
    let table = stage.scene().lights();
    let choose = |at: &Receiver| {
        let mut rng = Stream::keyed(&[1, u64::from(at.pixel)]);
        let (mut total, mut chosen) = (0.0, None);
        for _ in 0..CANDIDATES {
            let light = stage.lights()[rng.below(stage.lights().len())];
            let weight = f64::from(importance(&table[light as usize], at));
            total += weight;
            if rng.uniform64() * total < weight {
                chosen = Some(light);
            }
        }
        let light = chosen?;
        let to = contribution::<0b1111>(LightSampling::Area, &table[light as usize], rng.uniform2(), at).ok()?;
        Some(Question { from: *at, light: table[light as usize], to })
    };
    stage.receivers().iter().filter_map(choose).collect()
}

fn shadow_rays(criterion: &mut Criterion<Reported>, stage: &Stage, questions: &[Question]) {
    let (bvh, corners) = stage.occluders().bare();
    let triangles: Vec<RtTriangle> = corners.into_iter().map(|[a, b, c]| RtTriangle::new(a, b, c)).collect();
    let segment = |question: &Question| {
        let Question { from, light, to } = question;
        stage.ray_ends().segment(from, light, to.direction, to.distance)
    };
    let through_ours = || questions.iter().filter(|question| stage.occluders().visible(&segment(question))).count();
    let rays: Vec<Ray> = questions
        .iter()
        .map(|question| {
            let Segment { origin, along, t_min, t_max, .. } = segment(question);
            Ray::new(origin.into(), along.into(), t_min, t_max)
        })
        .collect();
    let bare = || {
        let visible = |ray: &&Ray| bvh.ray_traverse_miss(**ray, |ray, i| triangles[i].intersect(ray));
        rays.iter().filter(visible).count()
    };
    let (seen, seen_bare) = (through_ours(), bare());
    eprintln!("{} shadow rays, {} unblocked ({} by the bare library)\n", questions.len(), seen, seen_bare);

    let mut group = criterion.benchmark_group("shadow-ray");
    group.sampling_mode(SamplingMode::Flat).throughput(Throughput::Elements(1));
    group.bench_function("ours", |b| per_element(b, questions.len(), through_ours));
    group.bench_function("bare", |b| per_element(b, questions.len(), bare));
    group.finish();

    let mut criterion = super::quantity::criterion(RATIO).measurement_time(Duration::from_secs(2));
    let mut group = flat(&mut criterion, "shadow-ray-ratio");
    // The bare library's time over ours: a share of its speed.
    let mut duel = Duel::new(bare, through_ours);
    duel.bench(&mut group, "bare-over-ours");
    group.finish();
    duel.judge("shadow-ray-ratio/bare-over-ours", &(0.95..=f64::INFINITY));
}

fn influence_query(criterion: &mut Criterion<Reported>, stage: &Stage) {
    let cutoff = Cutoff::new(stage.scene(), 0.5, Transfer::Linear);
    let tree = InfluenceTree::new(stage.scene(), stage.lights(), cutoff);
    let receivers = spread(stage.receivers(), 4096);
    let mut list = Vec::new();
    let mut query = |at: &Receiver| {
        list.clear();
        tree.list(at.position, &mut list);
        black_box(&list).len()
    };
    let listed = receivers.iter().map(&mut query).sum::<usize>() as f64 / receivers.len() as f64;
    eprintln!("{listed:.1} lights listed on average: a query should take {:.0} ns or less\n", 400.0 + 25.0 * listed);
    let mut group = flat(criterion, "influence");
    group.bench_function("query", |b| {
        per_element(b, receivers.len(), || receivers.iter().map(&mut query).sum::<usize>());
    });
    group.finish();
}

fn alias_draw(criterion: &mut Criterion<Reported>, stage: &Stage) -> Result<()> {
    let scene = stage.scene();
    let radius = scene.radius();
    let weights: Vec<f64> = scene.lights().iter().map(|light| f64::from(luminance(light.flux(radius)))).collect();
    let table = AliasTable::new(&weights)?;
    let mut rng = Stream::keyed(&[1]);
    const DRAWS: usize = 4096;
    let mut group = flat(criterion, "alias-table");
    group.bench_function("draw", |b| {
        per_element(b, DRAWS, || (0..DRAWS).map(|_| table.pick(rng.bits())).fold(0, usize::wrapping_add));
    });
    group.finish();
    Ok(())
}

fn triangles(criterion: &mut Criterion<Reported>) {
    // A quarter megabyte with the numbers: within reach of any L2, so that it is arithmetic that is timed.
    const COUNT: usize = 2048;
    let mut rng = Stream::keyed(&[1]);
    let mut point = |size: f64| (DVec3::from_array([0, 1, 2].map(|_| rng.uniform64() - 0.5))) * size;
    let posed: Vec<([DVec3; 3], DVec3)> = (0..COUNT)
        .map(|i| {
            let centre = point(1.0).normalize() * 10f64.powf(-0.5 + 2.5 * i as f64 / COUNT as f64);
            ([(); 3].map(|()| centre + point(1.0)), point(1.0).normalize())
        })
        .collect();
    let numbers: Vec<[f64; 2]> = (0..COUNT).map(|_| [rng.uniform64(), rng.uniform64()]).collect();
    let mut group = flat(criterion, "triangle");
    let mut bench = Bench { group: &mut group, posed: &posed, numbers: &numbers };
    bench.of("solid-angle", |seen, _, _| seen.solid_angle());
    bench.of("irradiance", |seen, normal, _| seen.irradiance(normal));
    let sum = |[b1, b2]: [f64; 2]| b1 + b2;
    bench.of("solid-angle-sample", |seen, _, u| SolidAngle::new(&seen).map_or(0.0, |s| sum(s.sample(u))));
    bench.of("projected-sample", |seen, normal, u| Projected::new(&seen, normal).map_or(0.0, |s| sum(s.sample(u))));
    group.finish();
}

/// Triangles from their corners on.
struct Bench<'a, 'b> {
    group: &'a mut BenchmarkGroup<'b, Reported>,
    posed: &'a [([DVec3; 3], DVec3)],
    numbers: &'a [[f64; 2]],
}

impl Bench<'_, '_> {
    fn of(&mut self, name: &str, one: impl Fn(Seen, DVec3, [f64; 2]) -> f64 + Sync) {
        let (posed, numbers) = (self.posed, self.numbers);
        let all = || posed.iter().zip(numbers).map(|(&(corners, normal), &u)| one(Seen::new(corners), normal, u));
        self.group.bench_function(name, |b| per_element(b, posed.len(), || all().sum::<f64>()));
    }
}

fn light_tree_pick(criterion: &mut Criterion<Reported>, scene: &str, stage: &Stage, arities: &[&str]) -> Result<()> {
    const PASSES: u32 = 64;
    let receivers = spread(stage.receivers(), 1024);
    let frame = Frame { receivers: &receivers, key: RunKey { seed: 1, run: 0 }, points: Points::R2 };
    let mut group = flat(criterion, "light-tree");
    for arity in arities {
        let tree = Registry::standard().parse(&format!("light-tree:arity={arity}"))?;
        let sampler = tree.build(BuildContext { stage, seed: 1 })?;
        let block = sampler.begin(frame, 0..PASSES);
        group.bench_function(format!("{scene}/{arity}"), |b| {
            per_element(b, receivers.len() * PASSES as usize, || {
                let (mut worker, mut buffer) = (block.worker(false), PickBuffer::default());
                worker.fill(&receivers, 0..PASSES, false, &mut buffer);
                buffer.len()
            });
        });
    }
    group.finish();
    Ok(())
}

fn power_without_ray(criterion: &mut Criterion<Reported>, stage: Stage) -> Result<()> {
    let needs = Needs { occlusion: false, ..Needs::of(stage.scene()) };
    let stage = stage.with_needs(needs);
    const PASSES: u32 = 16;
    let sampler = Registry::standard().parse("power")?.build(BuildContext { stage: &stage, seed: 1 })?;
    let receivers = spread(stage.receivers(), 4096);
    let mut group = flat(criterion, "power");
    group.bench_function("without-ray", |b| {
        per_element(b, receivers.len() * PASSES as usize, || {
            let mut film = Film::new(receivers.len());
            let key = RunKey { seed: 1, run: 0 };
            Plan { stage: &stage, receivers: &receivers, sampler: sampler.as_ref(), key }.run(PASSES, &mut film);
            film
        });
    });
    group.finish();
    Ok(())
}
