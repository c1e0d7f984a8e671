//! A check that cannot fail proves nothing: wrong strategies, each rejected by the check that is meant for it.

use crate::promises::common::{sixteen, stage};
use citylights::base::colour::luminance;
use citylights::base::discrete::Cumulative;
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::base::random::Stream;
use citylights::scene::light::LightId;
use citylights::scene::receiver::Receiver;
use citylights::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Registry, Strategy, Tally};
use citylights::verify::{Check, Verifier, VerifyOptions, picks_in_range, picks_valid};
use std::sync::atomic::{AtomicU64, Ordering};

const RIGHT: u8 = 0;
const HEAVY: u8 = 1;
const DROPPED: u8 = 2;
const CLAIMED: u8 = 3;
const SCALED: u8 = 4;
const COUNTS: u8 = 5;
const ALLOCATES: u8 = 6;
const GLOBAL: u8 = 7;
const SHIFTED: u8 = 8;
const HIDDEN: u8 = 9;
const BEYOND: u8 = 10;

const NAMES: [&str; 11] =
    ["right", "heavy", "dropped", "claimed", "scaled", "counts", "allocates", "global", "shifted", "hidden", "beyond"];

/// A choice by flux with one thing wrong.
struct Mutant<const KIND: u8>;

struct Sampler<const KIND: u8> {
    pmf: Vec<f64>,
    sums: Cumulative,
    /// The light that adds most to the image.
    brightest: usize,
}

impl<const KIND: u8> Strategy for Mutant<KIND> {
    const INFO: Info = Info {
        name: NAMES[KIND as usize],
        summary: "a choice by flux with one thing wrong",
        source: "this test",
        claim: Claim::Unbiased,
    };
    type Sampler = Sampler<KIND>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        let scene = context.stage.scene();
        // Flux over a constant, so that no light is rare.
        let mut weights: Vec<f32> = scene.lights().iter().map(|l| luminance(l.flux(scene.radius())) + 200.0).collect();
        let brightest = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).expect("a light");
        if KIND == DROPPED {
            weights[brightest] = 0.0;
        }
        let mut sums = Cumulative::default();
        weights.iter().for_each(|&w| sums.push(w));
        let pmf = weights.iter().map(|&w| f64::from(w) / sums.total()).collect();
        Ok(Sampler { pmf, sums, brightest })
    }
}

static CALLS: AtomicU64 = AtomicU64::new(0);

impl<const KIND: u8> LightSampler for Sampler<KIND> {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        let mut u = draws.choice(0, 1);
        match KIND {
            SCALED => u *= 0.95,
            GLOBAL => u = Stream::keyed(&[CALLS.fetch_add(1, Ordering::Relaxed)]).uniform64(),
            ALLOCATES => drop(std::hint::black_box(vec![u])),
            _ => {}
        }
        let Some((index, pmf)) = self.sums.pick(u) else { return };
        if KIND == CLAIMED && index == self.brightest {
            return;
        }
        let n = self.pmf.len();
        let light = if KIND == BEYOND { index + 1 } else { index };
        let pmf = if KIND == SHIFTED { self.pmf[(index + 1) % n] } else { pmf };
        let factor = match KIND {
            HEAVY => 1.01,
            HIDDEN => 1.04,
            _ => 1.0,
        };
        out.push(light as LightId, (factor / pmf) as f32);
    }

    fn expected_counts(&self, _at: &Receiver, counts: &mut [f32]) -> bool {
        let factor = if KIND == COUNTS { 1.01 } else { 1.0 };
        counts.iter_mut().zip(&self.pmf).for_each(|(count, pmf)| *count += (factor * pmf) as f32);
        KIND != HIDDEN
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

fn mutants() -> Registry {
    Registry::empty()
        .with::<Mutant<RIGHT>>()
        .with::<Mutant<HEAVY>>()
        .with::<Mutant<DROPPED>>()
        .with::<Mutant<CLAIMED>>()
        .with::<Mutant<SCALED>>()
        .with::<Mutant<COUNTS>>()
        .with::<Mutant<ALLOCATES>>()
        .with::<Mutant<GLOBAL>>()
        .with::<Mutant<SHIFTED>>()
        .with::<Mutant<HIDDEN>>()
        .with::<Mutant<BEYOND>>()
}

fn checks(kind: u8) -> Vec<Check> {
    let options =
        VerifyOptions { allocations: Some(crate::promises::counting::allocations), ..VerifyOptions::default() };
    checks_with(kind, &options)
}

fn checks_with(kind: u8, options: &VerifyOptions) -> Vec<Check> {
    let strategy = mutants().parse(NAMES[kind as usize]).expect("a mutant");
    Verifier::new(&stage(sixteen()), *options).verify(&strategy).expect("a sampler")
}

fn print(checks: &[Check]) -> String {
    checks.iter().map(|check| format!("\n{check}")).collect()
}

/// The mutant fails the checks that are `meant` for it, and passes those that it should pass.
fn rejected(kind: u8, meant: &[&str], innocent: &[&str]) {
    let checks = checks(kind);
    println!("{}{}", NAMES[kind as usize], print(&checks));
    let of = |name: &str| {
        checks.iter().find(|check| check.name == name).unwrap_or_else(|| panic!("no check {name}{}", print(&checks)))
    };
    for name in meant {
        assert!(!of(name).passed, "{} passed `{name}`{}", NAMES[kind as usize], print(&checks));
    }
    for name in innocent {
        assert!(of(name).passed, "{} failed `{name}`{}", NAMES[kind as usize], print(&checks));
    }
}

#[test]
fn the_right_strategy_passes_everything() {
    let checks = checks(RIGHT);
    println!("{}", print(&checks));
    assert!(checks.len() >= 12 && checks.iter().all(|check| check.passed), "{}", print(&checks));
}

#[test]
fn a_right_strategy_fails_no_check_oftener_than_its_level() {
    // 60 seeds at the 1 % level: more than 4 failures of one check have a chance of 3 in 10,000. Few draws at a
    // receiver, so that rare lights are rare.
    let stage = stage(sixteen());
    for points in ["random", "sobol", "r2"] {
        let strategy = mutants().parse(&format!("right:points={points}")).expect("a strategy");
        let sampler = strategy.build(BuildContext { stage: &stage, seed: 1 }).expect("a sampler");
        let mut failures = std::collections::BTreeMap::new();
        for seed in 100..160 {
            let options = VerifyOptions { receivers: 6, draws: 3_000, batches: 100, seed, ..VerifyOptions::default() };
            for check in Verifier::new(&stage, options).look(&*sampler, &Claim::Unbiased) {
                *failures.entry(check.name).or_insert(0) += u32::from(!check.passed);
            }
        }
        println!("points={points}: failures in 60 seeds: {failures:?}");
        assert!(failures.values().all(|&n| n <= 4), "points={points}: {failures:?}, seeds 100 to 159");
    }
}

#[test]
fn weights_one_percent_too_great_are_found() {
    rejected(HEAVY, &["weights-total", "reciprocal"], &["picks", "coverage", "same-seed"]);
}

#[test]
fn a_dropped_light_that_is_honest_fails_coverage() {
    rejected(DROPPED, &["coverage"], &["weights", "weights-total", "picks", "reciprocal"]);
}

#[test]
fn a_dropped_light_that_is_claimed_fails_weights_and_estimate() {
    rejected(CLAIMED, &["weights", "estimate", "picks"], &["coverage", "reciprocal"]);
}

#[test]
fn wrong_weights_and_dropped_lights_are_found_in_a_city_too() {
    use citylights::sources::Overrides;
    use citylights::sources::recipe::load;
    use citylights::visibility::offset::Offset;
    use citylights::visibility::stage::{LeaveOut, Stage};
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-night.toml");
    let scene = load(&file, &Overrides::default()).expect("a shipped scene");
    let city = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    let verifier = Verifier::new(&city, VerifyOptions { receivers: 16, draws: 10_000, ..VerifyOptions::default() });
    for (kind, meant) in [(RIGHT, None), (HEAVY, Some("weights-total")), (DROPPED, Some("coverage"))] {
        let strategy = mutants().parse(NAMES[kind as usize]).expect("a mutant");
        let checks = verifier.verify(&strategy).expect("a sampler");
        println!("{}{}", NAMES[kind as usize], print(&checks));
        match meant {
            None => assert!(checks.iter().all(|check| check.passed), "{}", print(&checks)),
            Some(meant) => {
                assert!(checks.iter().any(|check| check.name == meant && !check.passed), "{meant}{}", print(&checks));
            }
        }
    }
}

#[test]
fn a_random_number_scaled_wrongly_fails_weights() {
    rejected(SCALED, &["weights"], &["coverage", "picks", "reciprocal", "same-seed"]);
}

#[test]
fn expected_counts_off_by_a_factor_fail_picks() {
    rejected(COUNTS, &["picks", "reciprocal"], &["coverage", "estimate", "image-mean"]);
}

#[test]
fn a_stage_that_leaves_out_too_much_is_found() {
    let whole = stage(sixteen());
    let mut needs = whole.needs();
    needs.occlusion = false;
    let strategy = mutants().parse("right").expect("a strategy");
    let blind = whole.with_needs(needs);
    let checks = Verifier::new(&blind, VerifyOptions::default()).verify(&strategy).expect("a sampler");
    let replay = checks.iter().find(|check| check.name == "replay").expect("the check");
    assert!(!replay.passed, "{replay}");
}

#[test]
fn an_allocation_per_query_is_counted() {
    rejected(ALLOCATES, &["allocation"], &["weights", "estimate"]);
}

#[test]
fn global_randomness_fails_the_same_seed_check() {
    rejected(GLOBAL, &["same-seed"], &["coverage", "reciprocal"]);
}

#[test]
fn the_weight_of_the_next_light_fails_weights_and_estimate() {
    rejected(SHIFTED, &["reciprocal", "weights", "estimate"], &["coverage", "picks"]);
}

#[test]
fn a_bias_behind_intractable_counts_shows_in_the_mean() {
    rejected(HIDDEN, &["image-mean"], &["coverage", "picks"]);
}

#[test]
fn an_id_beyond_the_table_is_reported_and_not_looked_up() {
    rejected(BEYOND, &["ids"], &["weights-finite"]);
}

#[test]
fn impossible_picks_are_counted() {
    use citylights::strategy::Pick;
    let pick = |light, weight| Pick { light, weight, uv: [0.0; 2] };
    let picks = [pick(0, 1.0), pick(1, f32::NAN), pick(2, -1.0), pick(3, f32::INFINITY), pick(4, 0.0)];
    assert_eq!(picks_valid(&picks), 3);
    assert_eq!(picks_in_range(&picks, 4), 1);
}
