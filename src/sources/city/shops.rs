//! Which shop windows are lit?
//!
//! Wide panes on the ground floor of the walls that face a street: about one for each street lamp in a dense city.

use super::buildings::Town;
use super::fields::{Fields, Plan};
use super::round;
use super::tag::Tag;
use crate::base::colour::black_body;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::Shape;
use rayon::prelude::*;

/// How far panes stand before their wall, in m.
const PROUD: f64 = 0.125;

/// Shop windows.
#[derive(Clone, Debug)]
pub struct Shops {
    /// How many on 100 m of facade.
    pub per_100m: f64,
    /// Greatest width in m; narrow walls get narrower panes.
    pub width: f64,
    /// Least and greatest radiance in cd/m^2; uniform in the logarithm.
    pub radiance: [f64; 2],
    /// Least and greatest colour temperature in K.
    pub kelvin: [f64; 2],
}

impl Default for Shops {
    fn default() -> Self {
        Self { per_100m: 3.0, width: 4.0, radiance: [20.0, 200.0], kelvin: [2_700.0, 5_000.0] }
    }
}

impl Plan for Shops {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("per_100m", &mut self.per_100m, 0.0..=40.0, "panes on 100 m of facade")?;
        f.number("width", &mut self.width, 0.5..=20.0, "metres")?;
        f.span("radiance", &mut self.radiance, 0.01..=1e5, "cd/m^2")?;
        f.span("kelvin", &mut self.kelvin, 1_700.0..=15_000.0, "kelvin")
    }
}

pub(super) fn place(plan: &Shops, town: &Town, seed: u64) -> Vec<Shape> {
    town.blocks
        .par_iter()
        .flat_map_iter(|block| {
            let mut stream = Stream::keyed(&[seed, Tag::Shops as u64, block.place[0], block.place[1]]);
            let mut out = Vec::new();
            for wall in block.buildings.iter().flat_map(|building| building.base().walls()) {
                // A fraction of a pane is a chance of one.
                let count = (wall.width * plan.per_100m / 100.0 + stream.uniform64()).floor();
                let room = wall.width / count;
                for k in 0..count as u64 {
                    let width = plan.width.min(0.8 * room);
                    let u = (k as f64 + 0.1) * room + (0.8 * room - width) * stream.uniform64();
                    let colour =
                        black_body((round::uniform(plan.kelvin, stream.uniform64()) / 100.0).round() as f32 * 100.0);
                    let radiance = round::light(colour, round::log_uniform(plan.radiance, stream.uniform64()));
                    out.extend(wall.panel([u, u + width], [0.6, 2.8], PROUD, radiance));
                }
            }
            out
        })
        .collect()
}
