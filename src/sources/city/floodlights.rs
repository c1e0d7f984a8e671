//! Where are the few lights that make much of the flux?
//!
//! Floodlights stand on the edge of a roof and light the street below; without buildings they hang over the
//! crossings. Their flux follows a Pareto law: a tenth of a percent of the lights with a tenth and more of the flux
//! (an assumption of ours: no published fit is known).

use super::buildings::{Building, Town};
use super::fields::{Fields, Plan};
use super::round;
use super::tag::Tag;
use crate::base::colour::black_body;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::{Shape, cone_flux};
use glam::{DVec3, Vec3};

/// Floodlights.
#[derive(Clone, Debug)]
pub struct Floodlights {
    /// How many on a square kilometre.
    pub per_km2: f64,
    /// Least and greatest flux in lm.
    pub flux: [f64; 2],
    /// Exponent of the Pareto law; the smaller, the heavier the tail.
    pub exponent: f64,
    /// Colour temperature in K.
    pub kelvin: f64,
}

impl Default for Floodlights {
    fn default() -> Self {
        Self { per_km2: 10.0, flux: [20_000.0, 1e6], exponent: 1.2, kelvin: 5_000.0 }
    }
}

impl Plan for Floodlights {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("per_km2", &mut self.per_km2, 0.0..=1_000.0, "lights on a square kilometre")?;
        f.span("flux", &mut self.flux, 1.0..=1e8, "lumens")?;
        f.number("exponent", &mut self.exponent, 0.1..=10.0, "exponent of the Pareto law")?;
        f.number("kelvin", &mut self.kelvin, 1_700.0..=15_000.0, "kelvin")
    }
}

pub(super) fn place(plan: &Floodlights, town: &Town, seed: u64) -> Vec<Shape> {
    let layout = &town.layout;
    let count = (layout.x.length() * layout.y.length() / 1e6 * plan.per_km2).round() as u64;
    let buildings: Vec<&Building> = town.blocks.iter().flat_map(|block| &block.buildings).collect();
    let (cos_inner, cos_outer) = (round::cosine(25.0), round::cosine(60.0));
    let colour = black_body(plan.kelvin as f32);
    (0..count)
        .map(|i| {
            let mut stream = Stream::keyed(&[seed, Tag::Floodlights as u64, i]);
            let flux = (plan.flux[0] * (1.0 - stream.uniform64()).powf(-1.0 / plan.exponent)).min(plan.flux[1]);
            let intensity = round::light(colour, flux / f64::from(cone_flux(cos_inner, cos_outer)));
            let (position, axis) = match buildings.get(stream.below(buildings.len())) {
                Some(building) => over_the_edge(building, &mut stream),
                None => {
                    let middle = |streets: &[[f64; 2]], u: usize| 0.5 * (streets[u][0] + streets[u][1]);
                    let x = middle(&layout.x.streets, stream.below(layout.x.streets.len()));
                    let y = middle(&layout.y.streets, stream.below(layout.y.streets.len()));
                    // Mast heights differ, so that no two lights coincide.
                    (DVec3::new(x, y, 15.0 + 15.0 * stream.uniform64()), Vec3::NEG_Z)
                }
            };
            Shape::Spot { position: round::position(position), axis, intensity, cos_inner, cos_outer }
        })
        .collect()
}

/// Half a metre before and a metre over the edge of a wall at the street, looking down at the carriageway.
fn over_the_edge(building: &Building, stream: &mut Stream) -> (DVec3, Vec3) {
    let walls: Vec<_> = building.base().walls().collect();
    let wall = walls[stream.below(walls.len())];
    let position = wall.point(wall.width * (0.1 + 0.8 * stream.uniform64()), wall.height + 1.0, 0.5);
    (position, round::unit(wall.out * 10.0 - DVec3::Z * position.z))
}
