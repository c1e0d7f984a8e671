//! Promise: `allocate` shares out whole points without noise of its own, meets its budget, and ends where there is nothing to share.
use crate::promises::common::{expected, ground, image, panel, point, sampler, stage};
use citylights::base::random::RunKey;
use citylights::scene::Parts;
use citylights::strategy::{Frame, PickBuffer};
use citylights::visibility::stage::Stage;
use glam::Vec3;

/// Panels of several sizes, near and far, and a lamp.
fn panels() -> Parts {
    let mut lights = vec![point(Vec3::new(1.0, 2.0, 3.0), 50.0)];
    for (i, side) in [0.1, 0.5, 2.0, 4.0].into_iter().enumerate() {
        let corner = Vec3::new(3.0 * i as f32 - 5.0, -1.0, 3.0 + i as f32);
        lights.extend(panel(corner, Vec3::Y * side, Vec3::X * side, 100.0));
    }
    ground(12.0, lights)
}

/// The picks of some passes at every receiver: number, and sum of weights, of each light in each call.
fn calls(strategy: &str, stage: &Stage, passes: u32) -> Vec<Vec<(u32, f64)>> {
    let sampler = sampler(strategy, stage);
    let block = sampler.begin(Frame::new(stage.receivers(), RunKey { seed: 5, run: 0 }), 0..passes);
    let mut buffer = PickBuffer::default();
    block.worker(false).fill(stage.receivers(), 0..passes, true, &mut buffer);
    let lights = stage.scene().lights().len();
    let of = |picks: &[citylights::strategy::Pick]| {
        let mut found = vec![(0, 0.0); lights];
        for pick in picks {
            let (count, weight) = &mut found[pick.light as usize];
            *count += 1;
            *weight += f64::from(pick.weight);
        }
        found
    };
    buffer.calls().map(of).collect()
}

#[test]
fn a_light_of_a_point_or_more_counts_once_in_every_pass() {
    let stage = stage(panels());
    let passes = 8;
    let (mut certain, mut chance) = (0u32, 0u32);
    let calls = calls("allocate:rays=12", &stage, passes);
    for (at, calls) in stage.receivers().iter().zip(calls.chunks_exact(passes as usize)) {
        let counts = expected("allocate:rays=12", &stage, at);
        for (light, &n) in counts.iter().enumerate() {
            for call in calls {
                let (count, weight) = call[light];
                if n >= 1.0 {
                    certain += 1;
                    assert_eq!(count as f32, n);
                    assert!((weight - 1.0).abs() < 1e-5, "light {light}: {count} points weigh {weight}");
                } else if n > 0.0 {
                    chance += 1;
                    assert!(
                        count == 0 || (count == 1 && (weight * f64::from(n) - 1.0).abs() < 1e-4),
                        "{weight} for {n}"
                    );
                }
            }
        }
    }
    assert!(certain > 1_000 && chance > 1_000, "{certain} certain, {chance} by chance");
}

#[test]
fn the_budget_is_met_on_average() {
    let stage = stage(panels());
    for rays in [0.5, 4.0, 64.0] {
        let calls = calls(&format!("allocate:rays={rays}"), &stage, 4);
        // All but the lamp.
        let points: u32 = calls.iter().flat_map(|call| &call[1..]).map(|(count, _)| count).sum();
        let mean = f64::from(points) / calls.len() as f64;
        assert!((mean / rays - 1.0).abs() < 0.05, "{mean} points for {rays}");
    }
}

#[test]
fn black_surfaces_get_no_points_and_no_light() {
    let mut parts = panels();
    parts.materials.iter_mut().for_each(|material| material.albedo = Vec3::ZERO);
    let stage = stage(parts);
    for rays in ["0.5", "4096"] {
        let strategy = format!("allocate:rays={rays}");
        assert!(image(&strategy, &stage, 2).iter().all(|rgb| *rgb == Vec3::ZERO));
        assert!(calls(&strategy, &stage, 2).iter().flat_map(|call| &call[1..]).all(|(count, _)| *count == 0));
    }
}
