//! Where do strings of bulbs hang?
//!
//! Over squares, in parallel strings that sag: many small lights that no wall hides from anything below, which is
//! where leaving out far lights costs most.

use super::buildings::Town;
use super::fields::{Fields, Plan};
use super::materials::KERB;
use super::round;
use crate::base::colour::black_body;
use crate::base::error::Result;
use crate::scene::light::Shape;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Strings of bulbs.
#[derive(Clone, Debug)]
pub struct Bulbs {
    /// Distance between the strings in m.
    pub row: f64,
    /// Distance between the bulbs of a string in m.
    pub spacing: f64,
    /// Height of a string's ends over the ground in m.
    pub height: f64,
    /// How far the middle hangs below the ends, in m.
    pub sag: f64,
    /// Flux of a bulb in lm.
    pub flux: f64,
    /// Colour temperature in K.
    pub kelvin: f64,
}

impl Default for Bulbs {
    fn default() -> Self {
        Self { row: 20.0, spacing: 2.0, height: 6.0, sag: 1.5, flux: 25.0, kelvin: 2_400.0 }
    }
}

impl Plan for Bulbs {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("row", &mut self.row, 0.5..=100.0, "metres")?;
        f.number("spacing", &mut self.spacing, 0.1..=100.0, "metres")?;
        f.number("height", &mut self.height, 1.0..=100.0, "metres")?;
        f.number("sag", &mut self.sag, 0.0..=self.height - 0.5, "metres, and at least 0.5 below `height`")?;
        f.number("flux", &mut self.flux, 0.01..=1e6, "lumens")?;
        f.number("kelvin", &mut self.kelvin, 1_700.0..=15_000.0, "kelvin")
    }
}

impl Bulbs {
    /// No more bulbs than this hang over a ground of `width` by `depth` m.
    pub(crate) fn most(&self, width: f64, depth: f64) -> f64 {
        (width / self.row + 1.0) * (depth / self.spacing + 1.0)
    }

    /// The bulbs over a rectangle of ground at height `z`; strings run along y.
    pub(crate) fn over(&self, low: DVec2, high: DVec2, z: f64) -> Vec<Shape> {
        let intensity = round::light(black_body(self.kelvin as f32), self.flux / (4.0 * PI));
        let (width, length) = (high.x - low.x, high.y - low.y);
        let (strings, bulbs) = ((width / self.row).floor() as u64, (length / self.spacing).floor() as u64);
        (0..strings)
            .flat_map(|s| {
                (0..bulbs).map(move |b| {
                    let (across, along) = ((s as f64 + 0.5) / strings as f64, (b as f64 + 0.5) / bulbs as f64);
                    // A parabola: the shape of a cable that hangs a little.
                    let drop = self.sag * 4.0 * along * (1.0 - along);
                    let place = low + DVec2::new(width * across, length * along);
                    Shape::Point { position: round::position(place.extend(z + self.height - drop)), intensity }
                })
            })
            .collect()
    }
}

pub(super) fn place(plan: &Bulbs, town: &Town) -> Vec<Shape> {
    let squares = town.blocks.par_iter().filter(|block| block.square);
    squares.flat_map_iter(|block| plan.over(block.low, block.high, KERB)).collect()
}
