//! What became of the samples?

/// Counted work of a render, in a separate pass of the same code: compiled away in timed runs; counts carry over between machines, times do not.
///
/// Each pick ends in exactly one of the three early outs or in a shadow ray, if its contribution is not zero for
/// another reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "measure", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Counts {
    /// Estimates of a receiver: receivers times passes.
    pub samples: u64,
    /// Lights that the strategy gave.
    pub picks: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Shadow rays that met an occluder.
    pub blocked: u64,
    /// Picks dropped because the light sends nothing in that direction (outside a spot's cone).
    pub zero_intensity: u64,
    /// Picks dropped because the light is below the receiver's horizon.
    pub behind_surface: u64,
    /// Picks dropped because the receiver is behind a one-sided emitter.
    pub behind_light: u64,
    /// Nodes of a hierarchy visited to choose.
    #[cfg_attr(feature = "measure", serde(default))]
    pub nodes: u64,
    /// Lights or nodes weighed at a receiver to choose.
    #[cfg_attr(feature = "measure", serde(default))]
    pub weighed: u64,
    /// Candidates drawn to choose from.
    #[cfg_attr(feature = "measure", serde(default))]
    pub candidates: u64,
    /// Shadow rays cast to choose, beside [`shadow_rays`](Self::shadow_rays).
    #[cfg_attr(feature = "measure", serde(default))]
    pub choosing_rays: u64,
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
        self.nodes += other.nodes;
        self.weighed += other.weighed;
        self.candidates += other.candidates;
        self.choosing_rays += other.choosing_rays;
    }
}
