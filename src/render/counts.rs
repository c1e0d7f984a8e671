//! What became of the samples?

use crate::strategy::tally::{Tally, Work};

/// Counted work of a render. Compiled away in timed runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Calls of a sampler: one a receiver and pass.
    pub samples: u64,
    /// Lights picked.
    pub picks: u64,
    /// Shadow rays cast.
    pub shadow_rays: u64,
    /// Shadow rays that met something.
    pub blocked: u64,
    /// Picks that ended because the light sends nothing this way.
    pub zero_intensity: u64,
    /// Picks that ended because the light is below the receiver's horizon.
    pub behind_surface: u64,
    /// Picks that ended because the receiver is behind the light.
    pub behind_light: u64,
    /// What choosing took.
    pub work: Work,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.samples += other.samples;
        self.picks += other.picks;
        self.shadow_rays += other.shadow_rays;
        self.blocked += other.blocked;
        self.zero_intensity += other.zero_intensity;
        self.behind_surface += other.behind_surface;
        self.behind_light += other.behind_light;
        self.work.add(other.work);
    }
}
