//! Which windows are lit?
//!
//! All walls that look on a street or stand free carry a grid of windows. As many are lit as the number of lights
//! still asks for: each building gets its share by its number of windows, exactly, and lights them at random, or,
//! in an office, floor after floor. A lit window is two triangles.

use super::buildings::{Building, FLOOR, GROUND_FLOOR, Town};
use super::facade::Wall;
use super::fields::{Fields, Plan};
use super::round;
use super::tag::Tag;
use crate::base::colour::black_body;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::Shape;
use glam::Vec3;
use rayon::prelude::*;

/// How far windows stand before their wall, in m: a gap of 2 cm made results depend on the ray offset.
const PROUD: f64 = 0.1;
/// Height of the sill over the floor, in m.
const SILL: f64 = 0.9;
/// How many radiances the windows of a city share; equal powers are ties that builders must survive.
const PALETTE: usize = 24;

/// Lit windows.
#[derive(Clone, Debug)]
pub struct Windows {
    /// Width in m.
    pub width: f64,
    /// Height in m.
    pub height: f64,
    /// Distance between the middles of neighbours, in m.
    pub pitch: f64,
    /// Least and greatest radiance in cd/m^2; uniform in the logarithm.
    pub radiance: [f64; 2],
    /// Least and greatest colour temperature in K.
    pub kelvin: [f64; 2],
    /// Share of the buildings that light whole floors.
    pub offices: f64,
}

impl Default for Windows {
    fn default() -> Self {
        Self { width: 1.4, height: 1.5, pitch: 3.0, radiance: [5.0, 80.0], kelvin: [2_700.0, 4_000.0], offices: 0.25 }
    }
}

impl Plan for Windows {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("pitch", &mut self.pitch, 1.0..=20.0, "metres")?;
        f.number("width", &mut self.width, 0.2..=self.pitch - 0.2, "metres, and at least 0.2 below `pitch`")?;
        f.number("height", &mut self.height, 0.2..=2.2, "metres")?;
        f.span("radiance", &mut self.radiance, 0.01..=1e5, "cd/m^2")?;
        f.span("kelvin", &mut self.kelvin, 1_700.0..=15_000.0, "kelvin")?;
        f.number("offices", &mut self.offices, 0.0..=1.0, "share of all buildings")
    }
}

/// Two triangles for each of at most `wanted` lit windows; and how many windows there are, lit or not.
pub(super) fn place(plan: &Windows, town: &Town, seed: u64, wanted: usize) -> (Vec<Shape>, u64) {
    // Where each building stands in the order of all windows.
    let mut slots = 0u64;
    let numbered: Vec<_> = town
        .blocks
        .iter()
        .flat_map(|block| block.buildings.iter().enumerate().map(move |(i, building)| (block, i as u64, building)))
        .map(|(block, i, building)| {
            let grids: Vec<Grid> = (0..building.tiers.len()).map(|tier| Grid::of(plan, building, tier)).collect();
            let start = slots;
            slots += grids.iter().map(Grid::slots).sum::<u64>();
            ([block.place[0], block.place[1], i], grids, start..slots)
        })
        .collect();
    let lit = (wanted as u64).min(slots);
    // The shares of all buildings up to a place, rounded down: their differences add up to `lit` exactly.
    let share = |until: u64| (u128::from(lit) * u128::from(until) / u128::from(slots.max(1))) as u64;
    let palette = palette(plan, seed);
    let lights = numbered
        .par_iter()
        .flat_map_iter(|([column, row, i], grids, range)| {
            let mut stream = Stream::keyed(&[seed, Tag::Windows as u64, *column, *row, *i]);
            let count = share(range.end) - share(range.start);
            let slots = choose(grids, range.end - range.start, count, stream.uniform64() < plan.offices, &mut stream);
            let mut out = Vec::with_capacity(2 * slots.len());
            for slot in slots {
                out.extend(panel(plan, grids, slot, palette[stream.below(PALETTE)]).into_iter().flatten());
            }
            out
        })
        .collect();
    (lights, slots)
}

/// The windows of one tier: floors of equal rows, each running over all its walls.
struct Grid {
    walls: Vec<(Wall, u64)>,
    floors: u64,
    first_sill: f64,
}

impl Grid {
    fn of(plan: &Windows, building: &Building, tier: usize) -> Self {
        let below = if tier == 0 { GROUND_FLOOR } else { 0.0 };
        let tier = &building.tiers[tier];
        let walls = tier.walls().map(|wall| (wall, ((wall.width - 1.0) / plan.pitch).floor().max(0.0) as u64));
        Self {
            walls: walls.collect(),
            floors: ((tier.high.z - tier.low.z - below) / FLOOR).round().max(0.0) as u64,
            first_sill: below + SILL,
        }
    }

    fn per_floor(&self) -> u64 {
        self.walls.iter().map(|(_, columns)| columns).sum()
    }

    fn slots(&self) -> u64 {
        self.floors * self.per_floor()
    }
}

/// Which `count` of a building's windows are lit, ascending, except that an office's floors may wrap around.
fn choose(grids: &[Grid], slots: u64, count: u64, office: bool, stream: &mut Stream) -> Vec<u64> {
    if office {
        // Tenants hold neighbouring floors.
        let per_floor = grids.first().map_or(1, Grid::per_floor).max(1);
        let start = stream.below((slots / per_floor) as usize) as u64 * per_floor;
        return (0..count).map(|k| (start + k) % slots).collect();
    }
    // Selection sampling (Knuth, TAOCP 2, 3.4.2 S): every set of `count` windows is equally likely.
    let mut wanted = count;
    let mut chosen = Vec::with_capacity(count as usize);
    for slot in 0..slots {
        if wanted == 0 {
            break;
        }
        if stream.uniform64() * ((slots - slot) as f64) < wanted as f64 {
            chosen.push(slot);
            wanted -= 1;
        }
    }
    chosen
}

fn panel(plan: &Windows, grids: &[Grid], mut slot: u64, radiance: Vec3) -> Option<[Shape; 2]> {
    let grid = grids.iter().find(|grid| {
        let here = slot < grid.slots();
        if !here {
            slot -= grid.slots();
        }
        here
    })?;
    let (floor, mut column) = (slot / grid.per_floor(), slot % grid.per_floor());
    let (wall, columns) = grid.walls.iter().find(|(_, columns)| {
        let here = column < *columns;
        if !here {
            column -= columns;
        }
        here
    })?;
    // The grid stands in the middle of its wall.
    let u = 0.5 * (wall.width - *columns as f64 * plan.pitch) + (column as f64 + 0.5) * plan.pitch - 0.5 * plan.width;
    let v = grid.first_sill + FLOOR * floor as f64;
    Some(wall.panel([u, u + plan.width], [v, v + plan.height], PROUD, radiance))
}

fn palette(plan: &Windows, seed: u64) -> [Vec3; PALETTE] {
    let mut stream = Stream::keyed(&[seed, Tag::Palette as u64]);
    std::array::from_fn(|_| {
        let colour = black_body(round::uniform(plan.kelvin, stream.uniform64()).round() as f32);
        round::light(colour, round::log_uniform(plan.radiance, stream.uniform64()))
    })
}
