//! Wrong only where receivers move: what was weighed for a pixel's last pass is kept for the next, which lies elsewhere.

use crate::promises::common::sixteen;
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::scene::Scene;
use citylights::scene::light::LightId;
use citylights::scene::receiver::Receiver;
use citylights::strategy::{Arguments, BuildContext, Claim, Info, LightSampler, Picks, Registry, Strategy, Tally};
use citylights::verify::{Verifier, VerifyOptions};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use citylights::visibility::visits::Receivers;
use glam::Vec3;

/// Lights by the inverse square of their distance; `KEEPS` those of the pixel that it came to last.
struct Near<const KEEPS: bool>;

struct Places<const KEEPS: bool>(Vec<Option<Vec3>>);

#[derive(Default)]
struct Weights {
    pixel: Option<u32>,
    sums: Vec<f64>,
}

impl<const KEEPS: bool> Strategy for Near<KEEPS> {
    const INFO: Info = Info {
        name: if KEEPS { "keeps" } else { "near" },
        summary: "one thing is wrong, or nothing",
        source: "this test",
        claim: Claim::Unbiased,
    };
    type Sampler = Places<KEEPS>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        use citylights::scene::light::Kind;
        let place =
            |light: &citylights::scene::light::Light| (light.kind() != Kind::Directional).then_some(light.position);
        Ok(Places(context.stage.scene().lights().iter().map(place).collect()))
    }
}

impl<const KEEPS: bool> Places<KEEPS> {
    fn weights(&self, at: &Receiver) -> Vec<f64> {
        let weight =
            |place: &Option<Vec3>| place.map_or(0.05, |p| 1.0 / (1.0 + f64::from(p.distance_squared(at.position))));
        self.0.iter().map(weight).collect()
    }
}

impl<const KEEPS: bool> LightSampler for Places<KEEPS> {
    type Scratch = Weights;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut Weights, _tally: &mut T) {
        if KEEPS && scratch.pixel == Some(at.pixel) {
            return;
        }
        scratch.pixel = Some(at.pixel);
        let mut sum = 0.0;
        scratch.sums.clear();
        scratch.sums.extend(self.weights(at).into_iter().map(|weight| {
            sum += weight;
            sum
        }));
    }

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, scratch: &mut Weights, out: &mut Picks<'_, T>) {
        let total = scratch.sums.last().copied().unwrap_or(0.0);
        let wanted = draws.choice(0, 1) * total;
        let light = scratch.sums.partition_point(|&sum| sum <= wanted).min(scratch.sums.len() - 1);
        let weight = scratch.sums[light] - if light > 0 { scratch.sums[light - 1] } else { 0.0 };
        out.push(light as LightId, (total / weight) as f32);
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        let weights = self.weights(at);
        let total: f64 = weights.iter().sum();
        counts.iter_mut().zip(weights).for_each(|(count, weight)| *count += (weight / total) as f32);
        true
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(&self.0[..])
    }
}

#[test]
fn weights_kept_from_another_place_of_the_pixel_are_found() {
    let registry = Registry::empty().with::<Near<true>>().with::<Near<false>>();
    for (_, receivers) in Receivers::NAMED {
        let stage = Stage::visiting(Scene::new(sixteen()).expect("a scene"), LeaveOut::Yes, Offset::SCALED, receivers);
        let verifier = Verifier::new(&stage, VerifyOptions { draws: 4_000, ..VerifyOptions::default() });
        let failed = |name: &str| -> Vec<&str> {
            let checks = verifier.verify(&registry.parse(name).expect(name)).expect(name);
            checks.iter().filter(|check| !check.passed).map(|check| check.name).collect()
        };
        assert_eq!(failed("near"), [""; 0], "{}", receivers.name());
        assert!(failed("keeps").contains(&"moved"), "{}: {:?}", receivers.name(), failed("keeps"));
    }
}
