//! Wrong strategies of the harder kind: misuse of even numbers, of a frame, of reservoirs, of trees, of mixtures, of
//! units; each is rejected by the check that is meant for it, and by the gate before a comparison.

use crate::promises::common::{cuboid, ground, panel, point, sixteen, stage};
use citylights::base::colour::luminance;
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::base::random::hash;
use citylights::scene::light::{LightId, Shape};
use citylights::scene::light_sampling::LightSampling;
use citylights::scene::receiver::Receiver;
use citylights::scene::{Parts, Scene};
use citylights::strategy::{
    Arguments, BuildContext, Claim, Configured, Frame, FrameSampler, Info, LightSampler, PerPass, Picks, Registry,
    Strategy, Tally,
};
use citylights::verify::metamorphic::{Copies, Metamorphic};
use citylights::verify::{Check, Verifier, VerifyOptions};
use citylights::visibility::offset::{Offset, RayEnds};
use citylights::visibility::stage::Stage;
use glam::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

const RIGHT: u8 = 0;
/// Two choices span a plane: the points on lights.
const PLANE: u8 = 1;
/// A reservoir of four that drops what comes when it is full.
const OVERFLOW: u8 = 2;
/// A descent of a binary tree that forgets to stretch the number on the left.
const DESCENT: u8 = 3;
/// Half uniform, half by weight, with the probability of the second alone.
const MIX: u8 = 4;
/// A choice by distance, softened by a metre whatever the scene's size.
const METRE: u8 = 5;
/// Sixteen lights, as if no table had more.
const SIXTEEN: u8 = 6;

const NAMES: [&str; 7] = ["right", "plane", "overflow", "descent", "mix", "metre", "sixteen"];

const fn info(name: &'static str) -> Info {
    Info { name, summary: "one thing is wrong", source: "this test", claim: Claim::Unbiased }
}

/// A choice by weight with one thing wrong.
struct Mutant<const KIND: u8>;

struct Sampler<const KIND: u8> {
    scene: Arc<Scene>,
}

impl<const KIND: u8> Strategy for Mutant<KIND> {
    const INFO: Info = info(NAMES[KIND as usize]);
    type Sampler = Sampler<KIND>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(Sampler { scene: Arc::clone(context.stage.scene()) })
    }
}

impl<const KIND: u8> Sampler<KIND> {
    /// The probability of each light; only lights in this list are chosen.
    fn pmf(&self, at: &Receiver) -> Vec<f64> {
        let lights = self.scene.lights();
        let n = if KIND == SIXTEEN { lights.len().min(16) } else { lights.len() };
        let weights: Vec<f64> = lights[..n]
            .iter()
            .map(|light| match (KIND, light.shape()) {
                (METRE, Shape::Point { position, .. }) => {
                    1.0 / (1.0 + f64::from(position.distance_squared(at.position)))
                }
                (METRE, _) => 0.05,
                (RIGHT | SIXTEEN | PLANE, _) => 1.0,
                // Flux over a constant, so that no light is rare.
                _ => f64::from(luminance(light.flux(self.scene.radius()))) + 200.0,
            })
            .collect();
        let total: f64 = weights.iter().sum();
        weights.iter().map(|w| w / total).collect()
    }

    /// The light that a descent of a balanced tree over the table ends at.
    fn descend(pmf: &[f64], mut u: f64) -> usize {
        let mut range = 0..pmf.len();
        while range.len() > 1 {
            let middle = range.start + range.len() / 2;
            let sum = |range: std::ops::Range<usize>| pmf[range].iter().sum::<f64>();
            let left = sum(range.start..middle) / sum(range.clone());
            if u < left {
                // It should be u / left from here on.
                range = range.start..middle;
            } else {
                u = ((u - left) / (1.0 - left)).min(1.0 - f64::EPSILON);
                range = middle..range.end;
            }
        }
        range.start
    }
}

/// The entry that `u` chooses.
fn pick(pmf: &[f64], u: f64) -> usize {
    let mut sum = 0.0;
    pmf.iter().position(|p| (sum += p, u < sum).1).unwrap_or(pmf.len() - 1)
}

impl<const KIND: u8> LightSampler for Sampler<KIND> {
    type Scratch = ();

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        let pmf = self.pmf(at);
        if pmf.is_empty() {
            return;
        }
        match KIND {
            PLANE => {
                let (u, v) = (draws.choice(0, 2), draws.choice(1, 2));
                let light = draws.stream().below(pmf.len());
                out.push_at(
                    light as LightId,
                    1.0 / pmf[light] as f32,
                    [u as f32, v as f32].map(|x| x.min(0.999_999_9)),
                );
            }
            OVERFLOW => {
                let found: Vec<usize> = (0..pmf.len()).filter(|_| draws.stream().uniform() < 0.5).collect();
                found.iter().take(4).for_each(|&light| out.push(light as LightId, 2.0));
            }
            _ => {
                let u = draws.choice(0, 1);
                let light = match KIND {
                    DESCENT => Self::descend(&pmf, u),
                    MIX if draws.stream().uniform() < 0.5 => (u * pmf.len() as f64) as usize,
                    _ => pick(&pmf, u),
                };
                out.push(light as LightId, (1.0 / pmf[light]) as f32);
            }
        }
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let pmf = self.pmf(at);
        let n = pmf.len() as f64;
        let count = |p: f64| match KIND {
            OVERFLOW => 0.5,
            MIX => 0.5 * (p + 1.0 / n),
            _ => p,
        };
        counts.iter_mut().zip(pmf).for_each(|(sum, p)| *sum += count(p) as f32);
        true
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

/// Each receiver draws a light that it sees; each then uses its own and its neighbour's, both by half.
struct Neighbours;

struct Reuse {
    /// Rays tell what a receiver sees.
    scene: Arc<Scene>,
    occluded: Arc<citylights::visibility::occluders::Occluders>,
    ends: RayEnds,
}

struct Pass<'a> {
    reuse: &'a Reuse,
    /// By pixel: its own light or none, and its neighbour's.
    drawn: HashMap<u32, [Option<LightId>; 2]>,
}

impl Strategy for Neighbours {
    const INFO: Info = info("neighbours");
    type Sampler = PerPass<Reuse>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        let stage = context.stage;
        let (scene, occluded) = (Arc::clone(stage.scene()), Arc::clone(stage.occluders()));
        Ok(PerPass(Reuse { scene, occluded, ends: stage.ray_ends() }))
    }
}

impl Reuse {
    fn sees(&self, at: &Receiver, light: LightId) -> bool {
        let light = &self.scene.lights()[light as usize];
        let Shape::Point { position: place, .. } = light.shape() else { return true };
        let to = place - at.position;
        self.occluded.visible(&self.ends.segment(at, light, to.normalize(), to.length()))
    }
}

impl FrameSampler for Reuse {
    type Pass<'a> = Pass<'a>;

    fn begin<'a>(&'a self, frame: Frame<'a>, pass: u32) -> Pass<'a> {
        let n = self.scene.lights().len() as u64;
        let own = |at: &Receiver| {
            let words = [frame.key.seed, u64::from(frame.key.run), u64::from(pass), u64::from(at.pixel)];
            let light = (hash(&words) % n.max(1)) as LightId;
            (n > 0 && self.sees(at, light)).then_some(light)
        };
        // Ten places further in the list: near enough to see much the same, far enough to see other things.
        let drawn = frame.receivers.iter().enumerate().map(|(i, at)| {
            let next = &frame.receivers[(i + 10) % frame.receivers.len()];
            (at.pixel, [own(at), own(next)])
        });
        Pass { reuse: self, drawn: drawn.collect() }
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

impl LightSampler for Pass<'_> {
    type Scratch = ();

    fn sample<T: Tally>(&self, at: &Receiver, _draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        let n = self.reuse.scene.lights().len() as f32;
        for light in self.drawn[&at.pixel].into_iter().flatten() {
            out.push(light, 0.5 * n);
        }
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

fn mutants() -> Registry {
    Registry::empty()
        .with::<Mutant<RIGHT>>()
        .with::<Mutant<PLANE>>()
        .with::<Mutant<OVERFLOW>>()
        .with::<Mutant<DESCENT>>()
        .with::<Mutant<MIX>>()
        .with::<Mutant<METRE>>()
        .with::<Mutant<SIXTEEN>>()
        .with::<Neighbours>()
}

fn mutant(name: &str) -> Configured {
    mutants().parse(name).expect("a mutant")
}

/// The mutant fails the checks that are `meant` for it, and passes those that it should pass.
fn rejected(name: &str, checks: &[Check], meant: &[&str], innocent: &[&str]) {
    let text: String = checks.iter().map(|check| format!("\n{check}")).collect();
    println!("{name}{text}");
    let passed = |wanted: &str| checks.iter().find(|c| c.name == wanted).expect(wanted).passed;
    meant.iter().for_each(|check| assert!(!passed(check), "{name} passed `{check}`{text}"));
    innocent.iter().for_each(|check| assert!(passed(check), "{name} failed `{check}`{text}"));
}

fn looked_at(name: &str, stage: &Stage) -> Vec<Check> {
    Verifier::new(stage, VerifyOptions { receivers: 16, draws: 5_000, ..VerifyOptions::default() })
        .verify(&mutant(name))
        .expect("a sampler")
}

fn changed(name: &str, parts: Parts) -> Vec<Check> {
    let copies = Copies::new(&Scene::new(parts).expect("a scene"), Offset::SCALED, LightSampling::default())
        .expect("changed scenes");
    let metamorphic = Metamorphic::new(
        &copies,
        VerifyOptions { receivers: 8, draws: 5_000, batches: 50, ..VerifyOptions::default() },
    );
    assert!(metamorphic.image().iter().all(|check| check.passed), "{:?}", metamorphic.image());
    metamorphic.verify(&mutant(name)).expect("samplers")
}

/// Great panels near the ground, one behind a box: what arrives differs from point to point of them.
fn panels() -> Parts {
    let mut lights = panel(Vec3::new(-4.0, -4.0, 1.5), Vec3::Y * 4.0, Vec3::X * 4.0, 100.0).to_vec();
    lights.extend(panel(Vec3::new(1.0, 0.0, 1.0), Vec3::Y * 5.0, Vec3::X * 3.0, 150.0));
    let mut parts = ground(12.0, lights);
    parts.surfaces.extend(cuboid(Vec3::new(-1.0, -1.0, 0.0), Vec3::new(0.5, 0.5, 1.2)));
    parts
}

#[test]
fn points_from_two_choices_of_one_sequence_fail_the_estimate() {
    let stage = stage(panels());
    rejected("plane", &looked_at("plane", &stage), &["estimate"], &["picks", "coverage", "reciprocal", "weights"]);
    let random = looked_at("plane:points=random", &stage);
    rejected("plane:points=random", &random, &[], &["estimate", "image-mean", "weights"]);
}

#[test]
fn a_reservoir_that_overflows_fails_picks_and_weights() {
    rejected(
        "overflow",
        &looked_at("overflow", &stage(sixteen())),
        &["picks", "weights"],
        &["same-seed", "reciprocal"],
    );
}

#[test]
fn a_descent_that_does_not_stretch_its_number_fails_weights() {
    rejected("descent", &looked_at("descent", &stage(sixteen())), &["weights"], &["picks", "coverage", "reciprocal"]);
}

#[test]
fn a_mixture_weighted_by_one_part_fails_reciprocal_and_weights() {
    rejected(
        "mix",
        &looked_at("mix", &stage(sixteen())),
        &["reciprocal", "weights", "estimate"],
        &["picks", "coverage"],
    );
}

#[test]
fn a_neighbours_visibility_fails_the_weights() {
    // A wall casts hard shadows of point lights.
    let mut parts = ground(12.0, (0..8).map(|i| point(Vec3::new(i as f32 * 2.0 - 7.0, 6.0, 4.0), 100.0)).collect());
    parts.surfaces.extend(cuboid(Vec3::new(-5.0, 1.0, 0.0), Vec3::new(5.0, 1.5, 3.0)));
    let checks = looked_at("neighbours", &stage(parts));
    rejected("neighbours", &checks, &["weights", "estimate"], &["same-seed", "threads", "replay", "coverage"]);
}

#[test]
fn a_length_of_its_own_shows_when_the_scene_is_scaled() {
    let parts = ground(12.0, (0..12).map(|i| point(Vec3::new(i as f32 - 6.0, (i % 3) as f32, 4.0), 100.0)).collect());
    assert!(looked_at("metre", &stage(parts.clone())).iter().all(|check| check.passed));
    rejected("metre", &changed("metre", parts), &["scaled-counts"], &["scaled-down", "permuted", "changed-valid"]);
}

#[test]
fn a_table_of_fixed_length_shows_when_lights_are_added() {
    assert!(looked_at("sixteen", &stage(sixteen())).iter().all(|check| check.passed));
    let checks = changed("sixteen", sixteen());
    rejected("sixteen", &checks, &["split", "black"], &["scaled-counts", "turned", "moved", "permuted"]);
}

#[test]
fn a_right_strategy_passes_every_change_of_the_scene() {
    let checks = changed("right", sixteen());
    assert!(checks.len() >= 10);
    rejected("right", &checks, &[], &["scaled-counts", "turned", "moved", "permuted", "split", "black", "hidden"]);
}

#[test]
fn a_comparison_gives_a_wrong_strategy_an_error_row_and_no_time() {
    use citylights::measure::compare::{Compared, ComparisonOptions, compare};
    use citylights::measure::engine::Engine;
    use citylights::measure::image_store::ImageStore;
    use citylights::measure::observer::Unobserved;
    use citylights::measure::plan::Budget;
    use citylights::record::store::RowWriter;
    let folder = tempfile::tempdir().expect("a folder");
    let stage = stage(sixteen());
    let strategies = ["right", "descent"].map(mutant);
    let budget = Budget::up_to(4, 1.0);
    let (cache, folder) = (folder.path().join("cache"), folder.path());
    let films = &ImageStore::of(folder, "mutants");
    let engine = &Engine { clock: &crate::promises::alone::Alone::new(), workers: 1, seed: 1 };
    let options = ComparisonOptions {
        scenes: 1,
        typed: "citylights verify sixteen.toml",
        strategies: &strategies,
        budget,
        repeats: 3,
        seed: 1,
        engine,
        reference_work_s: 10.0,
        cache: &cache,
        films,
    };
    let mut rows = RowWriter::create(folder).expect("a file");
    let Compared { scene, rows, .. } =
        compare(&stage, "sixteen", &options, &[], &mut rows, &Unobserved).expect("a comparison");
    let error = |i: usize| scene.summaries[i].error.as_deref();
    assert_eq!(error(0), None);
    let shows = "citylights verify sixteen.toml --gate --seed 1 --strategies descent --only weights";
    let line = |text: &str| text.contains("failed check `weights` at pixel ") && text.ends_with(shows);
    assert!(error(1).is_some_and(|text| line(text) && !text.contains('\n')), "{:?}", error(1));
    assert!(rows.iter().all(|row| row.strategy != "descent"), "a wrong strategy was timed");
}

#[test]
fn the_command_of_the_gate_shows_what_the_gate_saw() {
    use citylights::measure::gate::{Gate, options};
    let stage = stage(sixteen());
    let error = Gate::new(&stage, "citylights verify sixteen.toml", 17, 3)
        .pass(&mutant("descent"))
        .expect_err("a wrong strategy");
    // What `verify --gate --seed 3 --strategies descent` does: of one strategy, not of seventeen.
    let checks = Verifier::new(&stage, options(1, 3)).verify(&mutant("descent")).expect("a sampler");
    let shown = checks.iter().find(|check| !check.passed).expect("a failure");
    let line = format!("failed check `{}`{}: statistic {:.3e}", shown.name, shown.place(), shown.statistic);
    assert!(error.to_string().starts_with(&line), "{error}\n{shown}");
}
