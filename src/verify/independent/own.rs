//! How does this program come to what a light adds?

use super::path::Path;
use crate::render::exact;
use crate::scene::light::LightId;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::contribution;
use crate::shading::importance::importance;
use crate::visibility::stage::Stage;
use glam::DVec3;

/// The program's own path.
pub(crate) struct Own<'a>(pub &'a Stage);

impl Path for Own<'_> {
    fn receivers(&self) -> &[Receiver] {
        self.0.receivers()
    }

    fn visited(&self, centre: &Receiver, pass: u32) -> Option<Receiver> {
        self.0.visited(centre, pass)
    }

    fn unshadowed(&self, by: LightSampling, light: LightId, uv: [f32; 2], at: &Receiver) -> DVec3 {
        let light = &self.0.scene().lights()[light as usize];
        contribution::<0b1111>(by, light, uv, at).map_or(DVec3::ZERO, |arrival| arrival.radiance.as_dvec3())
    }

    fn visible(&self, light: LightId, uv: [f32; 2], at: &Receiver) -> bool {
        let light = &self.0.scene().lights()[light as usize];
        exact::shadowed(self.0, LightSampling::Area, at, light, uv, &mut 0) != DVec3::ZERO
    }

    fn importance(&self, light: LightId, at: &Receiver) -> f32 {
        importance(&self.0.scene().lights()[light as usize], at)
    }

    fn exact(&self, at: &Receiver, points: u32, seed: u64) -> [DVec3; 2] {
        let found = exact::exact(self.0, at, points, seed);
        found.halves.map(|half| found.sum + half)
    }
}
