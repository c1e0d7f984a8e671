//! How does a program come to what a light adds?

use crate::scene::light::LightId;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use glam::DVec3;

/// How the program comes to what a light adds at a receiver. Tests put a wrong one in its place.
pub(crate) trait Path: Sync {
    /// What the camera sees.
    fn receivers(&self) -> &[Receiver];
    /// What a pass visits of a pixel that sees `centre` through its centre.
    fn visited(&self, centre: &Receiver, pass: u32) -> Option<Receiver>;
    /// What the point `uv` of a light, drawn `by` a way, adds at a receiver with nothing in between, in cd/m^2.
    fn unshadowed(&self, by: LightSampling, light: LightId, uv: [f32; 2], at: &Receiver) -> DVec3;
    /// Whether light from the point `uv`, by area, arrives; asked only where something could.
    fn visible(&self, light: LightId, uv: [f32; 2], at: &Receiver) -> bool;
    /// What lights are left out of sums by, where it is 0.
    fn importance(&self, light: LightId, at: &Receiver) -> f32;
    /// Two independent estimates of the radiance of a receiver, with `points` more points on triangles than one each.
    fn exact(&self, at: &Receiver, points: u32, seed: u64) -> [DVec3; 2];
}
