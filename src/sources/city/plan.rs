//! What can be said about a city: its parts, their numbers, and the range that each number may have.

use super::beacons::Beacons;
use super::buildings::Buildings;
use super::bulbs::Bulbs;
use super::fields::{Check, Fields, Plan, part};
use super::floodlights::Floodlights;
use super::lamps::Lamps;
use super::layout::Grid;
use super::moon::Moon;
use super::shops::Shops;
use super::signs::Signs;
use super::traffic::Traffic;
use super::windows::Windows;
use crate::base::error::{Error, Result};

/// A city. A part that is `None` is left out; without any, bare streets and pavements remain.
#[derive(Clone, Debug)]
pub struct City {
    /// How many lights there are: with `density`, the extent. Lit windows make the number exact.
    pub lights: u64,
    /// Lights per km^2 of ground.
    pub density: f64,
    /// Least and greatest length of a block's side, in m.
    pub block: [f64; 2],
    /// Least and greatest width of a street between its kerbs, in m.
    pub street: [f64; 2],
    /// Width of the pavement between kerb and buildings, in m.
    pub pavement: f64,
    /// Share of the blocks that stay open as squares.
    pub squares: f64,
    /// The buildings.
    pub buildings: Option<Buildings>,
    /// Street lamps.
    pub lamps: Option<Lamps>,
    /// Lit windows.
    pub windows: Option<Windows>,
    /// Shop windows at street level.
    pub shops: Option<Shops>,
    /// Signs on the facades.
    pub signs: Option<Signs>,
    /// Head lights and tail lights.
    pub traffic: Option<Traffic>,
    /// Red beacons on tall buildings.
    pub beacons: Option<Beacons>,
    /// Floodlights: the heavy tail.
    pub floodlights: Option<Floodlights>,
    /// Strings of bulbs over the squares.
    pub bulbs: Option<Bulbs>,
    /// The moon.
    pub moon: Option<Moon>,
}

impl Default for City {
    fn default() -> Self {
        Self {
            lights: 10_000,
            density: 10_600.0,
            block: [80.0, 120.0],
            street: [14.0, 24.0],
            pavement: 3.5,
            squares: 0.04,
            buildings: None,
            lamps: None,
            windows: None,
            shops: None,
            signs: None,
            traffic: None,
            beacons: None,
            floodlights: None,
            bulbs: None,
            moon: None,
        }
    }
}

impl Plan for City {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.count("lights", &mut self.lights, 1..=MOST_LIGHTS)?;
        f.number("density", &mut self.density, 100.0..=1e6, "lights per km^2")?;
        f.span("block", &mut self.block, 40.0..=400.0, "metres")?;
        f.span("street", &mut self.street, 6.0..=80.0, "metres")?;
        f.number("pavement", &mut self.pavement, 1.0..=10.0, "metres")?;
        f.number("squares", &mut self.squares, 0.0..=1.0, "share of all blocks")?;
        part(f, "buildings", &mut self.buildings)?;
        part(f, "lamps", &mut self.lamps)?;
        part(f, "windows", &mut self.windows)?;
        part(f, "shops", &mut self.shops)?;
        part(f, "signs", &mut self.signs)?;
        part(f, "traffic", &mut self.traffic)?;
        part(f, "beacons", &mut self.beacons)?;
        part(f, "floodlights", &mut self.floodlights)?;
        part(f, "bulbs", &mut self.bulbs)?;
        part(f, "moon", &mut self.moon)
    }
}

/// Most lights that a city may ask for, and most blocks that it may span; the blocks of 10^7 lights at the default
/// density are 68,000.
const MOST_LIGHTS: u64 = 10_000_000;
const MOST_BLOCKS: f64 = 100_000.0;
/// Most boxes that its buildings may have: ten surfaces each, 1.6 GB of them. The 10^7 lights at the default density
/// have 800,000, the million of the shipped recipe 70,000.
const MOST_BOXES: f64 = 4e6;

impl City {
    /// What streets and blocks are laid out by.
    pub(super) fn grid(&self) -> Grid {
        let Self { block, street, pavement, squares, .. } = *self;
        Grid { block, street, pavement, squares, pitch: self.pitch(), area: self.area() }
    }

    /// Side of a block and one street at their mean widths, in m.
    fn pitch(&self) -> f64 {
        0.5 * (self.block[0] + self.block[1] + self.street[0] + self.street[1])
    }

    /// Ground that the lights are spread over, in m^2.
    fn area(&self) -> f64 {
        self.lights as f64 / self.density * 1e6
    }

    /// Holds the numbers against their ranges, and against what fits into memory.
    ///
    /// # Errors
    /// A number outside its range; numbers that together ask for a city too big for memory.
    pub fn check(&self) -> Result<()> {
        self.clone().visit(&mut Check { owner: "city".into() })?;
        let refuse = |name: &str, value: String, expected: String| {
            Err(Error::Parameter { owner: "city".into(), name: name.into(), value, expected })
        };
        let blocks = (self.area() / (self.pitch() * self.pitch())).max(1.0);
        if blocks > MOST_BLOCKS {
            return refuse(
                "density",
                format!("{}", self.density),
                format!(
                    "{} lights at this density would spread over {blocks:.0} blocks; at most {MOST_BLOCKS} are allowed: \
                     a higher density, longer blocks or fewer lights",
                    self.lights
                ),
            );
        }
        let land = self.block[1] - 2.0 * self.pavement;
        let built = self.buildings.as_ref().map_or(0.0, |p| (1.0 - self.squares) * p.boxes(land));
        let boxes = blocks * built;
        if boxes > MOST_BOXES {
            return refuse(
                "lights",
                self.lights.to_string(),
                format!(
                    "the city would have about {boxes:.0} boxes of buildings on {blocks:.0} blocks; at most {MOST_BOXES} \
                     are allowed: fewer lights, a higher density, lower buildings or a longer `lot`"
                ),
            );
        }
        // Upper estimates per block, from its two streets and its four sides.
        let (street, side) = (2.0 * (self.block[1] + self.street[1]), self.block[1]);
        let per_block = self.lamps.as_ref().map_or(0.0, |p| 2.0 * street / p.spacing)
            + self.shops.as_ref().map_or(0.0, |p| 2.0 * 4.0 * side * p.per_100m / 100.0)
            + self.signs.as_ref().map_or(0.0, |p| 4.0 * 4.0 * side * p.per_100m / 100.0)
            + self.traffic.as_ref().map_or(0.0, |p| 4.0 * street * p.per_km / 1000.0)
            + self.floodlights.as_ref().map_or(0.0, |p| p.per_km2 * self.pitch() * self.pitch() / 1e6)
            + self.bulbs.as_ref().map_or(0.0, |p| self.squares * p.most(side, side));
        let others = blocks * per_block;
        if others > 2.0 * MOST_LIGHTS as f64 {
            return refuse(
                "lights",
                self.lights.to_string(),
                format!(
                    "the parts beside the windows would make about {others:.0} lights on {blocks:.0} blocks; at most {} \
                     are allowed: fewer of them, or a higher density",
                    2 * MOST_LIGHTS
                ),
            );
        }
        Ok(())
    }
}
