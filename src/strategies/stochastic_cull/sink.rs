//! What becomes of a light in range?

use crate::base::random::Stream;
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::receiver::Receiver;
use crate::shading::importance::importance;
use crate::strategies::parts::reservoir::Reservoir;
use crate::strategy::{Picks, Tally};

/// What becomes of a light in range: shaded, or offered to the reservoir.
pub(super) struct Sink<'a, 'b, T> {
    scene: &'a Scene,
    at: &'a Receiver,
    /// `None` where all are shaded.
    reservoir: Option<&'a mut Reservoir>,
    pub(super) out: &'a mut Picks<'b, T>,
}

impl<'a, 'b, T: Tally> Sink<'a, 'b, T> {
    /// `picks` lights are to be shaded; 0 for all.
    pub(super) fn new(
        scene: &'a Scene,
        at: &'a Receiver,
        picks: u32,
        reservoir: &'a mut Reservoir,
        out: &'a mut Picks<'b, T>,
    ) -> Self {
        reservoir.clear(picks);
        Self { scene, at, reservoir: (picks > 0).then_some(reservoir), out }
    }

    /// Takes a light that was in range with probability `chance`.
    #[inline]
    pub(super) fn take(&mut self, light: LightId, chance: f32, rng: &mut Stream) {
        self.out.tally.candidates(1);
        match &mut self.reservoir {
            None => self.out.push(light, 1.0 / chance),
            Some(reservoir) => {
                self.out.tally.weighed(1);
                reservoir.offer(light, importance(&self.scene.lights()[light as usize], self.at), chance, rng);
            }
        }
    }

    /// Shades what the reservoir holds.
    pub(super) fn finish(self) {
        if let Some(reservoir) = self.reservoir {
            reservoir.picks().for_each(|(light, weight)| self.out.push(light, weight));
        }
    }
}
