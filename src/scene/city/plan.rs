//! What can be said about a city: its parts, their numbers, and the range that each number may have.
//!
//! A part is a struct with defaults that names its fields, in one place, with range and unit: [`Plan::visit`]. Whoever
//! reads a recipe, lists the known names or checks a plan made in code is a [`Fields`].

use crate::base::error::{Error, Result};
use crate::scene::city::{
    beacons::Beacons, buildings::Buildings, bulbs::Bulbs, floodlights::Floodlights, lamps::Lamps, moon::Moon,
    shops::Shops, signs::Signs, traffic::Traffic, windows::Windows,
};
use std::ops::RangeInclusive;

/// A table of a recipe.
pub trait Plan {
    /// Shows every field to `fields`, in order.
    fn visit(&mut self, fields: &mut dyn Fields) -> Result<()>;
}

/// Someone who goes through the fields of a [`Plan`], reading or checking them.
pub trait Fields {
    /// A number in `unit`.
    fn number(
        &mut self,
        name: &'static str,
        value: &mut f64,
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()>;
    /// Two numbers in `unit`, the lower first.
    fn span(
        &mut self,
        name: &'static str,
        value: &mut [f64; 2],
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()>;
    /// A whole number.
    fn count(&mut self, name: &'static str, value: &mut u64, allowed: RangeInclusive<u64>) -> Result<()>;
    /// One of `options`, by its place in the list.
    fn choice(&mut self, name: &'static str, value: &mut usize, options: &[&'static str]) -> Result<()>;
    /// Whether an optional table is there; `now` says whether the plan already holds one.
    fn has(&mut self, name: &'static str, now: bool) -> bool;
    /// A table within this one; only where [`has`](Self::has) said yes.
    fn table(&mut self, name: &'static str, plan: &mut dyn Plan) -> Result<()>;
}

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
    /// Side of a block and one street at their mean widths, in m.
    pub(super) fn pitch(&self) -> f64 {
        0.5 * (self.block[0] + self.block[1] + self.street[0] + self.street[1])
    }

    /// Ground that the lights are spread over, in m^2.
    pub(super) fn area(&self) -> f64 {
        self.lights as f64 / self.density * 1e6
    }

    /// Fails on a number outside its range, and on numbers that together ask for a city too big for memory.
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

/// Visits an optional table, making it where it is wanted and not there yet.
fn part<T: Plan + Default>(f: &mut dyn Fields, name: &'static str, value: &mut Option<T>) -> Result<()> {
    if f.has(name, value.is_some()) { f.table(name, value.get_or_insert_default()) } else { Ok(()) }
}

/// The names of a plan's fields and tables.
pub fn names(plan: &mut dyn Plan) -> Vec<&'static str> {
    let mut names = Names(Vec::new());
    // The collector refuses nothing.
    let _ = plan.visit(&mut names);
    names.0
}

struct Names(Vec<&'static str>);

impl Fields for Names {
    fn number(&mut self, name: &'static str, _: &mut f64, _: RangeInclusive<f64>, _: &'static str) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn span(&mut self, name: &'static str, _: &mut [f64; 2], _: RangeInclusive<f64>, _: &'static str) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn count(&mut self, name: &'static str, _: &mut u64, _: RangeInclusive<u64>) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn choice(&mut self, name: &'static str, _: &mut usize, _: &[&'static str]) -> Result<()> {
        self.0.push(name);
        Ok(())
    }
    fn has(&mut self, name: &'static str, _: bool) -> bool {
        self.0.push(name);
        false
    }
    fn table(&mut self, _: &'static str, _: &mut dyn Plan) -> Result<()> {
        Ok(())
    }
}

/// Holds the values of a plan made in code against their ranges.
struct Check {
    owner: String,
}

impl Check {
    fn hold(&self, ok: bool, name: &str, value: String, expected: impl FnOnce() -> String) -> Result<()> {
        if ok {
            return Ok(());
        }
        Err(Error::Parameter { owner: self.owner.clone(), name: name.into(), value, expected: expected() })
    }
}

impl Fields for Check {
    fn number(
        &mut self,
        name: &'static str,
        value: &mut f64,
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()> {
        self.hold(allowed.contains(value), name, value.to_string(), || number_wanted(&allowed, unit))
    }
    fn span(
        &mut self,
        name: &'static str,
        value: &mut [f64; 2],
        allowed: RangeInclusive<f64>,
        unit: &'static str,
    ) -> Result<()> {
        let ok = value.iter().all(|v| allowed.contains(v)) && value[0] <= value[1];
        self.hold(ok, name, format!("{value:?}"), || span_wanted(&allowed, unit))
    }
    fn count(&mut self, name: &'static str, value: &mut u64, allowed: RangeInclusive<u64>) -> Result<()> {
        self.hold(allowed.contains(value), name, value.to_string(), || count_wanted(&allowed))
    }
    fn choice(&mut self, name: &'static str, value: &mut usize, options: &[&'static str]) -> Result<()> {
        self.hold(*value < options.len(), name, value.to_string(), || format!("one of {}", options.join(", ")))
    }
    fn has(&mut self, _: &'static str, now: bool) -> bool {
        now
    }
    fn table(&mut self, name: &'static str, plan: &mut dyn Plan) -> Result<()> {
        plan.visit(&mut Self { owner: format!("{}.{name}", self.owner) })
    }
}

/// What is right for a number, in words.
pub(crate) fn number_wanted(allowed: &RangeInclusive<f64>, unit: &str) -> String {
    format!("a number within {} and {} is asked for ({unit})", allowed.start(), allowed.end())
}

/// What is right for two numbers, in words.
pub(crate) fn span_wanted(allowed: &RangeInclusive<f64>, unit: &str) -> String {
    format!("[least, greatest] within {} and {} is asked for ({unit})", allowed.start(), allowed.end())
}

/// What is right for a whole number, in words.
pub(crate) fn count_wanted(allowed: &RangeInclusive<u64>) -> String {
    format!("a whole number within {} and {} is asked for", allowed.start(), allowed.end())
}
