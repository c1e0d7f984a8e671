//! Which signs hang on the facades?
//!
//! Flat ones over the shops, blades that stick out and shine along the street on both sides (two rectangles back to
//! back), and now and then a large board. Colours are saturated.

use super::buildings::Town;
use super::facade::Wall;
use super::fields::{Fields, Plan};
use super::round;
use super::tag::Tag;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::Shape;
use glam::Vec3;
use rayon::prelude::*;

/// Distance between the two faces of a blade, in m.
const GAP: f64 = 0.0625;

/// Colours of signs, brightest channel 1: red, orange, green, cyan, blue, magenta, white.
const COLOURS: [[f32; 3]; 7] = [
    [1.0, 0.04, 0.03],
    [1.0, 0.35, 0.02],
    [0.05, 1.0, 0.15],
    [0.04, 0.75, 1.0],
    [0.06, 0.12, 1.0],
    [1.0, 0.05, 0.6],
    [1.0, 0.95, 0.85],
];

/// Signs.
#[derive(Clone, Debug)]
pub struct Signs {
    /// How many on 100 m of facade.
    pub per_100m: f64,
    /// Share of blades: two emitting faces back to back.
    pub blades: f64,
    /// Share of large boards, on walls that are high enough.
    pub boards: f64,
    /// Least and greatest radiance of the brightest channel in cd/m^2; uniform in the logarithm.
    pub radiance: [f64; 2],
}

impl Default for Signs {
    fn default() -> Self {
        Self { per_100m: 3.0, blades: 0.4, boards: 0.05, radiance: [20.0, 150.0] }
    }
}

impl Plan for Signs {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("per_100m", &mut self.per_100m, 0.0..=40.0, "signs on 100 m of facade")?;
        f.number("blades", &mut self.blades, 0.0..=1.0, "share of all signs")?;
        f.number("boards", &mut self.boards, 0.0..=1.0, "share of all signs")?;
        f.span("radiance", &mut self.radiance, 0.01..=1e5, "cd/m^2")
    }
}

pub(super) fn place(plan: &Signs, town: &Town, seed: u64) -> Vec<Shape> {
    town.blocks
        .par_iter()
        .flat_map_iter(|block| {
            let mut stream = Stream::keyed(&[seed, Tag::Signs as u64, block.place[0], block.place[1]]);
            let mut out = Vec::new();
            for wall in block.buildings.iter().flat_map(|building| building.base().walls()) {
                let count = (wall.width * plan.per_100m / 100.0 + stream.uniform64()).floor();
                let room = wall.width / count;
                for k in 0..count as u64 {
                    sign(plan, &wall, [k as f64 * room, (k + 1) as f64 * room], &mut stream, &mut out);
                }
            }
            out
        })
        .collect()
}

/// One sign on a wall, within `room` along it.
fn sign(plan: &Signs, wall: &Wall, room: [f64; 2], stream: &mut Stream, out: &mut Vec<Shape>) {
    let space = 0.9 * (room[1] - room[0]);
    let [kind, size, place, power] = std::array::from_fn(|_| stream.uniform64());
    let colour = Vec3::from(COLOURS[stream.below(COLOURS.len())]);
    let radiance = round::light(colour, round::log_uniform(plan.radiance, power));
    let flat = |width: f64| {
        let u = 0.5 * (room[0] + room[1] - space) + (space - width) * place;
        [u, u + width]
    };
    // Between the shop windows and the first row of windows there are 2.6 m of bare wall.
    if kind < plan.blades {
        let top = (5.0 + 2.0 * size).min(wall.height - 0.25);
        let reach = 1.0 + 0.5 * size;
        out.extend(wall.blade(flat(0.2)[0] + 0.1, [3.25, top], [0.25, reach], GAP, radiance));
    } else if kind < plan.blades + plan.boards && wall.height > 14.0 {
        out.extend(wall.panel(flat((4.0 + 3.0 * size).min(space)), [7.0, 10.5], 0.3125, radiance));
    } else {
        out.extend(wall.panel(flat((1.5 + 2.5 * size).min(space)), [3.25, 4.0 + 0.5 * size], 0.1875, radiance));
    }
}
