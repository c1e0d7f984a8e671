//! Which buildings warn aircraft?

use super::buildings::{Building, Town};
use super::fields::{Fields, Plan};
use super::round;
use crate::base::error::Result;
use crate::scene::light::Shape;
use glam::Vec3;

/// Red beacons, one on every tall building.
#[derive(Clone, Debug)]
pub struct Beacons {
    /// Buildings from this height on carry one, in m.
    pub from: f64,
    /// Intensity in cd; 32 is the low-intensity type B of ICAO Annex 14.
    pub intensity: f64,
}

impl Default for Beacons {
    fn default() -> Self {
        Self { from: 45.0, intensity: 32.0 }
    }
}

impl Plan for Beacons {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("from", &mut self.from, 0.0..=1e3, "metres")?;
        f.number("intensity", &mut self.intensity, 0.01..=1e6, "candelas")
    }
}

pub(super) fn place(plan: &Beacons, town: &Town) -> Vec<Shape> {
    let intensity = round::light(Vec3::new(1.0, 0.03, 0.02), plan.intensity);
    let roofs = town.blocks.iter().flat_map(|block| &block.buildings).map(Building::top);
    let tall = roofs.filter(|roof| roof.high.z >= plan.from);
    tall.map(|roof| {
        let position = round::position((0.5 * (roof.low + roof.high)).with_z(roof.high.z + 2.0));
        Shape::Point { position, intensity }
    })
    .collect()
}
