//! The running sum of each receiver.

use glam::{DVec3, Vec3};

/// Sums of radiance over passes, one a receiver; in f64, so that a million passes lose nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    pub(super) sums: Vec<DVec3>,
    /// The next pass.
    pub(super) next: u32,
    first: u32,
}

impl Film {
    /// A black film for so many receivers.
    pub fn new(receivers: usize) -> Self {
        Self::starting_at(receivers, 0)
    }

    /// A black film whose first pass has another number than 0, to replay it.
    pub fn starting_at(receivers: usize, pass: u32) -> Self {
        Self { sums: vec![DVec3::ZERO; receivers], next: pass, first: pass }
    }

    /// How many passes have been summed.
    pub fn passes(&self) -> u32 {
        self.next - self.first
    }

    /// Mean radiance of each receiver in cd/m^2, rounded to f32 as a stored image is.
    pub fn image(&self) -> Vec<Vec3> {
        let scale = 1.0 / f64::from(self.passes().max(1));
        self.sums.iter().map(|sum| (sum * scale).as_vec3()).collect()
    }
}
