//! What does each light add at a receiver, shadows and all?

use crate::base::random::Stream;
use crate::render::exact::{shadowed, stratified};
use crate::scene::light::Kind;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::visibility::stage::Stage;
use glam::DVec3;

/// Side of the grid of points on each triangle.
const SIDE: u32 = 2;

/// Radiance in cd/m^2 that each light of the scene adds: exact, but of a triangle a mean over four points.
pub(super) fn each(stage: &Stage, at: &Receiver, seed: u64) -> Vec<DVec3> {
    let mut rng = Stream::keyed(&[seed, u64::from(at.pixel), u64::from_le_bytes(*b"each one")]);
    let mut rays = 0;
    let add = |light| match crate::scene::light::Light::kind(light) {
        Kind::Triangle => stratified(stage, at, light, SIDE, &mut rng, &mut rays),
        _ => shadowed(stage, LightSampling::Area, at, light, [0.0; 2], &mut rays),
    };
    stage.scene().lights().iter().map(add).collect()
}
