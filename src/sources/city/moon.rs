//! How bright is the moon, and where does it stand?

use super::fields::{Fields, Plan};
use super::round;
use crate::base::colour::black_body;
use crate::base::error::Result;
use crate::scene::light::Shape;
use glam::DVec3;

/// The moon: one directional light.
#[derive(Clone, Debug)]
pub struct Moon {
    /// Irradiance on a surface that faces it, in lx; a full moon gives about 0.2.
    pub irradiance: f64,
    /// Height over the horizon in degrees.
    pub altitude: f64,
    /// Direction in degrees, from +y towards +x.
    pub azimuth: f64,
    /// Colour temperature in K.
    pub kelvin: f64,
}

impl Default for Moon {
    fn default() -> Self {
        Self { irradiance: 0.2, altitude: 40.0, azimuth: 140.0, kelvin: 4_100.0 }
    }
}

impl Plan for Moon {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("irradiance", &mut self.irradiance, 0.0..=1e5, "lux")?;
        f.number("altitude", &mut self.altitude, 1.0..=90.0, "degrees")?;
        f.number("azimuth", &mut self.azimuth, -360.0..=360.0, "degrees")?;
        f.number("kelvin", &mut self.kelvin, 1_700.0..=15_000.0, "kelvin")
    }
}

impl Moon {
    /// The light.
    pub(super) fn shape(&self) -> Shape {
        let ((up, flat), (east, north)) = (self.altitude.to_radians().sin_cos(), self.azimuth.to_radians().sin_cos());
        // To 10^-6, for the sake of equal bytes everywhere.
        let to_grid = |x: f64| (x * 1e6).round() / 1e6;
        let towards = round::unit(DVec3::new(to_grid(flat * east), to_grid(flat * north), to_grid(up)));
        Shape::Directional { towards, irradiance: round::light(black_body(self.kelvin as f32), self.irradiance) }
    }
}
