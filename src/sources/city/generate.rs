//! From a plan to lights, surfaces and materials.

use super::buildings;
use super::materials::builtin_materials;
use super::plan::City;
use super::solid::Solid;
use super::{beacons, bulbs, floodlights, ground, lamps, shops, signs, traffic, windows};
use crate::base::error::Result;
use crate::scene::light::Shape;
use crate::scene::{LightGroup, Material, Surface};

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
    /// What a reader should know.
    pub notes: Vec<String>,
}

/// Generates a city.
///
/// # Errors
/// A plan that [`City::check`] refuses.
pub fn generate(plan: &City, seed: u64) -> Result<Grown> {
    plan.check()?;
    let town = buildings::build(&plan.grid(), plan.buildings.as_ref(), seed);
    let mut grown = Grown {
        surfaces: ground::surfaces(&town),
        materials: builtin_materials(),
        solids: town.solids(),
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
