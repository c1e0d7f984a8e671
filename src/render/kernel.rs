//! Shading a buffer of picks, compiled for what the scene needs.

use crate::base::counts::Counts;
use crate::scene::light::Kind;
use crate::scene::needs::Needs;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::{EarlyOut, contribution};
use crate::strategy::{Pick, PickBuffer};
use crate::visibility::stage::Stage;
use glam::DVec3;

/// A kernel: adds the radiance of `picks` (of `receivers`, `passes` calls each) to `sums`.
pub(crate) type Kernel = fn(&Stage, &[Receiver], usize, &PickBuffer, &mut [DVec3], &mut Counts);

const POINTS: u8 = Kind::Point.bit();
const CONES: u8 = POINTS | Kind::Spot.bit();
const LOCAL: u8 = CONES | Kind::Triangle.bit();
const EVERY: u8 = LOCAL | Kind::Directional.bit();

/// The smallest compiled set of light kinds that holds all that a scene has.
pub(crate) fn compiled_kinds(kinds: u8) -> u8 {
    [POINTS, CONES, LOCAL].into_iter().find(|set| kinds & !set == 0).unwrap_or(EVERY)
}

/// The kernel for a scene's needs; `counting` ones are slower and are never timed.
pub(crate) fn kernel(needs: Needs, counting: bool) -> Kernel {
    fn occluded<const KINDS: u8>(occlusion: bool, counting: bool) -> Kernel {
        match (occlusion, counting) {
            (true, true) => shade::<KINDS, true, true>,
            (true, false) => shade::<KINDS, true, false>,
            (false, true) => shade::<KINDS, false, true>,
            (false, false) => shade::<KINDS, false, false>,
        }
    }
    match compiled_kinds(needs.kinds) {
        POINTS => occluded::<POINTS>(needs.occlusion, counting),
        CONES => occluded::<CONES>(needs.occlusion, counting),
        LOCAL => occluded::<LOCAL>(needs.occlusion, counting),
        _ => occluded::<EVERY>(needs.occlusion, counting),
    }
}

fn shade<const KINDS: u8, const OCCLUSION: bool, const COUNTING: bool>(
    stage: &Stage,
    receivers: &[Receiver],
    passes: usize,
    picks: &PickBuffer,
    sums: &mut [DVec3],
    counts: &mut Counts,
) {
    let mut calls = picks.calls();
    for (at, sum) in receivers.iter().zip(sums) {
        for call in calls.by_ref().take(passes) {
            let mut radiance = DVec3::ZERO;
            for pick in call {
                radiance += shade_pick::<KINDS, OCCLUSION, COUNTING>(stage, at, pick, counts);
            }
            *sum += radiance;
            if COUNTING {
                counts.samples += 1;
                counts.picks += call.len() as u64;
            }
        }
    }
}

#[inline(always)]
fn shade_pick<const KINDS: u8, const OCCLUSION: bool, const COUNTING: bool>(
    stage: &Stage,
    at: &Receiver,
    pick: &Pick,
    counts: &mut Counts,
) -> DVec3 {
    let light = &stage.scene().lights()[pick.light as usize];
    let arrival = match contribution::<KINDS>(stage.light_sampling(), light, pick.uv, at) {
        Ok(arrival) => arrival,
        Err(why) => {
            if COUNTING {
                match why {
                    EarlyOut::ZeroIntensity => counts.zero_intensity += 1,
                    EarlyOut::BehindSurface => counts.behind_surface += 1,
                    EarlyOut::BehindLight => counts.behind_light += 1,
                }
            }
            return DVec3::ZERO;
        }
    };
    if OCCLUSION {
        let segment = stage.ray_ends().segment(at, light, arrival.direction, arrival.distance);
        let visible = stage.occluders().visible(&segment);
        if COUNTING {
            counts.shadow_rays += 1;
            counts.blocked += u64::from(!visible);
        }
        if !visible {
            return DVec3::ZERO;
        }
    }
    arrival.radiance.as_dvec3() * f64::from(pick.weight)
}
