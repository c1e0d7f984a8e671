//! Does a feature that a scene does not use cost anything?
//!
//! `leave-out/SCENE` is the harness's CPU time over that of a kernel written here for this scene alone, with the same
//! picks: `lamps-only` by one that knows point lights only, `plaza` by one without shadow rays, `downtown` by one
//! without directional lights. It should lie within 0.97 and 1.03. Beside it, `leave-out-gain/SCENE` says what the
//! harness with every feature takes over what it takes with those that the scene needs: what leaving out is worth.
//!
//! Both are taken in turns within one run, so that the machine's mood cancels. The strategy is `power`, which spends
//! least on choosing, unless another is named.

use super::quantity::{RATIO, Reported, criterion, flat};
use super::scenes::{name, stage};
use super::timing::Duel;
use crate::base::error::{Error, Result};
use crate::base::random::RunKey;
use crate::measure::target::spread;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::light::Kind;
use crate::scene::needs::Needs;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::strategy::{AnySampler, BuildContext, Configured, Frame, PickBuffer};
use crate::visibility::stage::Stage;
use criterion::Criterion;
use glam::DVec3;
use std::path::Path;
use std::time::Duration;

const POINTS: u8 = Kind::Point.bit();
const CONES: u8 = POINTS | Kind::Spot.bit();
const LOCAL: u8 = CONES | Kind::Triangle.bit();

const RECEIVERS: usize = 4096;
const PASSES: u32 = 8;
const KEY: RunKey = RunKey { seed: 1, run: 0 };

/// The groups `leave-out` and `leave-out-gain` with a strategy on three scenes of a folder: `lamps-only.toml`, `plaza.toml`
/// and `downtown.toml`, the three that a kernel is written for here.
///
/// # Errors
/// A scene that cannot be read; a strategy that cannot serve one; a kernel that gives another image than the harness.
pub fn leave_out(strategy: &Configured, scenes: &Path) -> Result<()> {
    let mut criterion = criterion(RATIO).sample_size(30).measurement_time(Duration::from_secs(4));
    let mut bench = |name: &str, by_hand: ByHand| bench(&mut criterion, strategy, &scenes.join(name), by_hand);
    bench("lamps-only.toml", by_hand::<POINTS, true>)?;
    bench("plaza.toml", by_hand::<CONES, false>)?;
    bench("downtown.toml", by_hand::<LOCAL, true>)?;
    criterion.final_summary();
    Ok(())
}

type ByHand = fn(&Stage, &[Receiver], &dyn AnySampler) -> Vec<DVec3>;

fn bench(criterion: &mut Criterion<Reported>, strategy: &Configured, file: &Path, by_hand: ByHand) -> Result<()> {
    let (scene, stage, everything) = (name(file), stage(file)?, stage(file)?.with_needs(Needs::ALL));
    let sampler = strategy.build(BuildContext { stage: &stage, seed: 1 })?;
    let sampler = sampler.as_ref();
    let receivers = spread(stage.receivers(), RECEIVERS);
    let harness = |stage: &Stage| {
        let mut film = Film::new(receivers.len());
        Plan { stage, receivers: &receivers, sampler, key: KEY }.run(PASSES, &mut film);
        film
    };
    let same = by_hand(&stage, &receivers, sampler)
        .iter()
        .map(|sum| (*sum / f64::from(PASSES)).as_vec3())
        .eq(harness(&stage).image());
    if !same {
        return Err(Error::Invalid(format!("{scene}: the kernel of this bench gives another image than the harness")));
    }

    let mut group = flat(criterion, "leave-out");
    let mut duel = Duel::new(|| harness(&stage), || by_hand(&stage, &receivers, sampler));
    duel.bench(&mut group, &scene);
    group.finish();
    duel.judge(&format!("leave-out/{scene}"), &(0.97..=1.03));

    let mut group = flat(criterion, "leave-out-gain");
    Duel::new(|| harness(&everything), || harness(&stage)).bench(&mut group, &scene);
    group.finish();
    Ok(())
}

/// What one would write for a scene with these kinds of light, with or without anything that blocks them.
fn by_hand<const KINDS: u8, const BLOCKED: bool>(
    stage: &Stage,
    receivers: &[Receiver],
    sampler: &dyn AnySampler,
) -> Vec<DVec3> {
    let lights = stage.scene().lights();
    let mut sums = vec![DVec3::ZERO; receivers.len()];
    let block = sampler.begin(Frame::new(receivers, KEY), 0..PASSES);
    let (mut worker, mut picks) = (block.worker(false), PickBuffer::default());
    // As many receivers at once as the harness takes.
    for (receivers, sums) in receivers.chunks(64).zip(sums.chunks_mut(64)) {
        worker.fill(receivers, 0..PASSES, KINDS & Kind::Triangle.bit() != 0, &mut picks);
        let mut calls = picks.calls();
        for (at, sum) in receivers.iter().zip(sums) {
            for call in calls.by_ref().take(PASSES as usize) {
                let mut radiance = DVec3::ZERO;
                for pick in call {
                    let light = &lights[pick.light as usize];
                    let Ok(arrival) = contribution::<KINDS>(stage.light_sampling(), light, pick.uv, at) else {
                        continue;
                    };
                    if BLOCKED {
                        let segment = stage.ray_ends().segment(at, light, arrival.direction, arrival.distance);
                        if !stage.occluders().visible(&segment) {
                            continue;
                        }
                    }
                    radiance += arrival.radiance.as_dvec3() * f64::from(pick.weight);
                }
                *sum += radiance;
            }
        }
    }
    sums
}
