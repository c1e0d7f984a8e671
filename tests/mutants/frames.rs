//! A strategy that begins whole frames and tells no counts has few passes looked at, and nothing to hold them against but
//! the truth: wrong weights are found all the same.

use crate::promises::common::{ground, point, sixteen, stage};
use citylights::base::draws::Draws;
use citylights::base::error::Result;
use citylights::measure::gate;
use citylights::scene::Parts;
use citylights::scene::camera::Camera;
use citylights::scene::light::LightId;
use citylights::scene::receiver::Receiver;
use citylights::strategy::{
    Arguments, BuildContext, Claim, Frame, FrameSampler, Info, LightSampler, PerPass, Picks, Registry, Strategy, Tally,
};
use citylights::verify::{Verifier, VerifyOptions};
use citylights::visibility::stage::Stage;
use glam::Vec3;

/// A uniform choice for whole frames that tells no counts, with so many thousandths of its weights.
struct Scaled<const PER_MILLE: u32>;

struct Frames<const PER_MILLE: u32> {
    lights: u32,
}

impl<const PER_MILLE: u32> Strategy for Scaled<PER_MILLE> {
    const INFO: Info = Info {
        name: match PER_MILLE {
            1_000 => "whole",
            2_000 => "twice",
            1_200 => "brighter",
            800 => "darker",
            _ => "hardly",
        },
        summary: "one thing is wrong",
        source: "this test",
        claim: Claim::Unbiased,
    };
    type Sampler = PerPass<Frames<PER_MILLE>>;

    fn configure(_arguments: &mut Arguments) -> Result<Self> {
        Ok(Self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler> {
        Ok(PerPass(Frames { lights: context.stage.scene().lights().len() as u32 }))
    }
}

impl<const PER_MILLE: u32> FrameSampler for Frames<PER_MILLE> {
    type Pass<'a> = &'a Self;

    fn begin<'a>(&'a self, _frame: Frame<'a>, _pass: u32) -> &'a Self {
        self
    }

    fn expected_counts(&self, _at: &Receiver, _counts: &mut [f32]) -> bool {
        false
    }

    fn heap_bytes(&self) -> usize {
        0
    }
}

impl<const PER_MILLE: u32> LightSampler for &Frames<PER_MILLE> {
    type Scratch = ();

    fn sample<T: Tally>(&self, _at: &Receiver, draws: &mut Draws, _scratch: &mut (), out: &mut Picks<'_, T>) {
        let weight = self.lights as f32 * PER_MILLE as f32 * 1e-3;
        (0..4).for_each(|_| out.push(draws.stream().below(self.lights as usize) as LightId, weight / 4.0));
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
        .with::<Scaled<1_000>>()
        .with::<Scaled<2_000>>()
        .with::<Scaled<1_200>>()
        .with::<Scaled<800>>()
        .with::<Scaled<1>>()
}

/// The names of the checks that fail.
fn failed(name: &str, stage: &Stage, options: VerifyOptions) -> Vec<&'static str> {
    let strategy = mutants().parse(name).expect("a mutant");
    let checks = Verifier::new(stage, options).verify(&strategy).expect("a sampler");
    checks.iter().for_each(|check| println!("{name}: {check}"));
    checks.into_iter().filter(|check| !check.passed).map(|check| check.name).collect()
}

/// The usual view with so many pixels.
fn film(width: u32, height: u32) -> Camera {
    Camera::new(Vec3::new(0.3, -18.0, 14.0), Vec3::Y, 60.0, width, height).expect("a camera")
}

#[test]
fn wrong_weights_of_whole_frames_that_tell_nothing_are_found() {
    // As shortly as before a comparison, at a film so large that few of its passes are looked at.
    let large = Parts { camera: film(320, 180), ..sixteen() };
    let one = ground(12.0, vec![point(Vec3::new(1.0, 2.0, 5.0), 100.0)]);
    let one = Parts { camera: large.camera, ..one };
    for stage in [stage(large), stage(one)] {
        assert_eq!(failed("whole", &stage, gate::options(17, 1)), [""; 0]);
        for name in ["twice", "hardly"] {
            assert!(failed(name, &stage, gate::options(17, 1)).contains(&"image-mean"), "{name}");
        }
    }
    // As long as `verify` does.
    let (stage, long) = (stage(sixteen()), VerifyOptions { receivers: 16, ..VerifyOptions::default() });
    assert_eq!(failed("whole", &stage, long), [""; 0]);
    for name in ["brighter", "darker"] {
        assert!(failed(name, &stage, long).contains(&"image-mean"), "{name}");
    }
}
