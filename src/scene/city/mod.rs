//! A night city, grown from a few tables of numbers.
//!
//! [`City`] says what there is, [`generate`] makes it: first the [layout] of streets and blocks, then the
//! [buildings], then each part's lights, last as many lit [windows] as the number of lights still asks for.
//! Distributions follow what is known of real cities: about 10,600 lights per km^2 (Kyba et al. 2025), lamps 25-40 m
//! apart, street canyons, and a heavy tail of floodlights.
//!
//! The same plan and seed give the same bytes on any number of threads: each street, block and building draws from a
//! stream of its own and results are joined in order. Positions are multiples of 2^-10 m and intensities of 10^-4,
//! because the last bit of `ln`, `exp` and `sin` differs between platforms.
//! Arrays keep the degeneracies of real ones: lamps exactly collinear, window grids exactly coplanar with equal
//! powers, signs back to back.

pub mod beacons;
pub mod buildings;
pub mod bulbs;
mod facade;
pub mod floodlights;
mod ground;
pub mod lamps;
pub mod layout;
pub mod moon;
pub mod plan;
mod round;
pub mod shops;
pub mod signs;
pub mod traffic;
pub mod windows;

use crate::base::error::Result;
use crate::scene::light::Shape;
use crate::scene::{LightGroup, Material, Surface};
use glam::{DVec2, Vec3};
pub use plan::City;

/// Version of the generator's output; part of every scene's hash.
pub const GENERATOR_VERSION: u32 = 1;

/// What the streams of the parts are keyed by, beside the seed and a place: no two parts share one.
#[derive(Clone, Copy)]
#[repr(u64)]
enum Tag {
    StreetsX = 1,
    StreetsY,
    Block,
    Lamps,
    Windows,
    Palette,
    Shops,
    Signs,
    Traffic,
    Floodlights,
}

/// An axis-aligned box that is filled; corners in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// The corner with the least coordinates.
    pub low: Vec3,
    /// The corner with the greatest coordinates.
    pub high: Vec3,
}

impl Solid {
    /// Whether a point lies inside, not on a face.
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpgt(self.low).all() && point.cmplt(self.high).all()
    }
}

/// A generated city. Its crossing of the two middle streets lies at the coordinate origin, the street surface at z = 0.
#[derive(Clone, Debug, Default)]
pub struct Grown {
    /// All lights, group after group.
    pub lights: Vec<Shape>,
    /// Which part made which lights.
    pub groups: Vec<LightGroup>,
    /// Streets, pavements and buildings; faces run counter-clockwise seen from outside.
    pub surfaces: Vec<Surface>,
    /// The materials that the surfaces name.
    pub materials: Vec<Material>,
    /// The buildings as filled boxes, one per tier.
    pub solids: Vec<Solid>,
    /// The least and greatest x and y, in metres.
    pub extent: [DVec2; 2],
    /// What a reader should know.
    pub notes: Vec<String>,
}

/// The materials of every city, by whose names recipes can call them.
pub fn builtin_materials() -> Vec<Material> {
    ground::materials()
}

/// Generates a city; fails on a plan with a number outside its range.
pub fn generate(plan: &City, seed: u64) -> Result<Grown> {
    plan.check()?;
    let town = buildings::build(plan, seed);
    let mut grown = Grown {
        surfaces: ground::surfaces(&town),
        materials: builtin_materials(),
        solids: town.solids(),
        extent: town.layout.extent(),
        ..Grown::default()
    };
    grown.surfaces.extend(town.surfaces());
    if let Some(part) = &plan.lamps {
        grown.add("street lamps", lamps::place(part, &town.layout, seed));
    }
    if let Some(part) = &plan.shops {
        grown.add("shop windows", shops::place(part, &town, seed));
    }
    if let Some(part) = &plan.signs {
        grown.add("signs", signs::place(part, &town, seed));
    }
    if let Some(part) = &plan.traffic {
        let (heads, tails) = traffic::place(part, &town.layout, seed);
        grown.add("headlights", heads);
        grown.add("tail lights", tails);
    }
    if let Some(part) = &plan.beacons {
        grown.add("beacons", beacons::place(part, &town));
    }
    if let Some(part) = &plan.floodlights {
        grown.add("floodlights", floodlights::place(part, &town, seed));
    }
    if let Some(part) = &plan.bulbs {
        grown.add("bulbs", bulbs::place(part, &town));
    }
    if let Some(part) = &plan.moon {
        grown.add("moon", vec![part.shape()]);
    }
    let wanted = plan.lights as usize;
    if let Some(part) = &plan.windows {
        let (lights, slots) = windows::place(part, &town, seed, wanted.saturating_sub(grown.lights.len()) / 2);
        let others = grown.lights.len();
        grown.add("windows", lights);
        if others > wanted {
            grown.notes.push(format!(
                "the other parts alone make {others} lights, more than the {wanted} asked for: no window is lit"
            ));
        } else if grown.lights.len() + 1 < wanted {
            grown.notes.push(format!(
                "every one of the {slots} windows is lit and the city has {} lights, not the {wanted} asked for",
                grown.lights.len()
            ));
        }
    } else if grown.lights.len() != wanted {
        grown.notes.push(format!("the city has no windows: {} lights on the extent of {wanted}", grown.lights.len()));
    }
    Ok(grown)
}

impl Grown {
    fn add(&mut self, name: &str, lights: Vec<Shape>) {
        let start = self.lights.len() as u32;
        self.lights.extend(lights);
        self.groups.push(LightGroup { name: name.to_owned(), range: start..self.lights.len() as u32 });
    }
}
