//! Strategies that are right in one run and wrong over several: each is rejected by the check that is meant for it.

use crate::promises::common::{sixteen, stage};
use citylights::base::discrete::Cumulative;
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::base::random::RunKey;
use citylights::scene::Scene;
use citylights::scene::receiver::Receiver;
use citylights::shading::importance::importance;
use citylights::strategy::{
    AnySampler, Arguments, Block, BuildContext, Claim, Frame, Info, LightSampler, Picks, Registry, Strategy, Tally,
};
use citylights::verify::{Verifier, VerifyOptions};
use citylights::visibility::stage::Stage;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

const fn info(name: &'static str) -> Info {
    Info { name, summary: "one thing is wrong", source: "this test", claim: Claim::Unbiased }
}

/// Runs 0 and 1 the same, 2 and 3 the same.
const PAIRS: u8 = 0;
/// Every seed the same.
const SEEDLESS: u8 = 1;
/// Four runs, then the same four.
const FOURS: u8 = 2;

/// `power` by other numbers than it is given.
struct Rekeyed<const KIND: u8>;

struct Other<const KIND: u8>(Box<dyn AnySampler>);

impl<const KIND: u8> Strategy for Rekeyed<KIND> {
    const INFO: Info = info(["pairs", "seedless", "fours"][KIND as usize]);
    type Sampler = Other<KIND>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn gives_candidates(&self) -> bool {
        false
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(Other(Registry::standard().parse("power")?.build(context)?))
    }
}

impl<const KIND: u8> AnySampler for Other<KIND> {
    fn begin<'a>(&'a self, frame: Frame<'a>, passes: Range<u32>) -> Box<dyn Block + 'a> {
        let RunKey { seed, run } = frame.key;
        let key = match KIND {
            PAIRS => RunKey { seed, run: run / 2 },
            SEEDLESS => RunKey { seed: 1, run },
            _ => RunKey { seed, run: run % 4 },
        };
        self.0.begin(Frame { key, ..frame }, passes)
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        self.0.expected_counts(at, counts)
    }

    fn heap_bytes(&self) -> usize {
        self.0.heap_bytes()
    }
}

const FIRST: u8 = 0;
const NAN: u8 = 1;
const NEGATIVE: u8 = 2;
/// One weight of ten thousand is no number.
const SELDOM: u8 = 3;
/// One id of ten thousand is none.
const BEYOND: u8 = 4;
/// Weights to choose by that are no numbers.
const BLIND: u8 = 5;

/// A choice by a table with one thing wrong.
struct Tables<const KIND: u8>;

struct Table<const KIND: u8> {
    scene: Arc<Scene>,
    /// Of whoever arrived first.
    sums: OnceLock<Cumulative>,
}

impl<const KIND: u8> Strategy for Tables<KIND> {
    const INFO: Info = info(["first", "nan", "negative", "seldom", "beyond", "blind"][KIND as usize]);
    type Sampler = Table<KIND>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(Table { scene: Arc::clone(context.stage.scene()), sums: OnceLock::new() })
    }
}

impl<const KIND: u8> Table<KIND> {
    fn sums(&self, at: &Receiver) -> &Cumulative {
        self.sums.get_or_init(|| {
            let mut sums = Cumulative::default();
            let weight = |light| if KIND == FIRST { 0.05 + importance(light, at).min(10.0) } else { 1.0 };
            self.scene
                .lights()
                .iter()
                .for_each(|light| sums.push(if KIND == BLIND { f32::NAN } else { weight(light) }));
            sums
        })
    }
}

impl<const KIND: u8> LightSampler for Table<KIND> {
    type Scratch = ();

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        let Some((light, pmf)) = self.sums(at).pick(draws.choice(0, 1)) else { return };
        let chance = draws.stream().uniform();
        let weight = match KIND {
            NAN if chance < 0.02 => f32::NAN,
            NEGATIVE if chance < 0.02 => -1.0,
            SELDOM if chance < 1e-4 => f32::NAN,
            _ => (1.0 / pmf) as f32,
        };
        let light = if KIND == BEYOND && chance < 1e-4 { self.scene.lights().len() } else { light };
        out.push(light as u32, weight);
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let sums = self.sums(at);
        counts.iter_mut().enumerate().for_each(|(light, count)| *count += sums.pmf(light) as f32);
        true
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

fn mutants() -> Registry {
    Registry::empty()
        .with::<Rekeyed<PAIRS>>()
        .with::<Rekeyed<SEEDLESS>>()
        .with::<Rekeyed<FOURS>>()
        .with::<Tables<FIRST>>()
        .with::<Tables<NAN>>()
        .with::<Tables<NEGATIVE>>()
        .with::<Tables<SELDOM>>()
        .with::<Tables<BEYOND>>()
        .with::<Tables<BLIND>>()
}

/// The names of the checks that fail.
fn failed(registry: &Registry, name: &str, stage: &Stage) -> Vec<&'static str> {
    let strategy = registry.parse(name).expect(name);
    let options = VerifyOptions { receivers: 16, draws: 5_000, ..VerifyOptions::default() };
    let checks = Verifier::new(stage, options).verify(&strategy).expect("a sampler");
    checks.iter().for_each(|check| println!("{name}: {check}"));
    checks.iter().filter(|check| !check.passed).map(|check| check.name).collect()
}

#[test]
fn runs_that_repeat_one_another_are_found() {
    let stage = stage(sixteen());
    assert_eq!(failed(&mutants(), "pairs", &stage), ["another-seed"]);
    // So few batches that differ fail the statistics as well.
    assert!(failed(&mutants(), "fours", &stage).contains(&"another-seed"));
}

#[test]
fn a_strategy_that_ignores_its_seed_is_found() {
    assert_eq!(failed(&mutants(), "seedless", &stage(sixteen())), ["another-seed"]);
}

#[test]
fn tables_made_from_whoever_arrives_first_are_found() {
    assert_eq!(failed(&mutants(), "first", &stage(sixteen())), ["arrival-order"]);
}

#[test]
fn weights_that_are_no_numbers_or_negative_are_a_failed_check_and_no_panic() {
    let stage = stage(sixteen());
    for name in ["nan", "negative", "seldom", "blind"] {
        assert_eq!(failed(&mutants(), name, &stage), ["weights-finite"], "{name}");
    }
    assert_eq!(failed(&mutants(), "beyond", &stage), ["ids"]);
}
