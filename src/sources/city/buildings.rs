//! What stands on the blocks?
//!
//! A block's land inside the pavement is cut into lots; the lots along its edge carry one building each and the rest
//! is courtyard. Heights are log-normal and whole floors; tall buildings step back once or twice.

use super::facade::{Side, Wall};
use super::fields::{Fields, Plan};
use super::layout::{Grid, Layout};
use super::materials::{FACADES, FIRST_FACADE, KERB, ROOF};
use super::round;
use super::solid::{Solid, faces};
use super::tag::Tag;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::Surface;
use glam::{DVec2, DVec3};
use rand_distr::{Distribution, LogNormal};
use rayon::prelude::*;

/// Height of the ground floor, with its shops, in m.
pub(super) const GROUND_FLOOR: f64 = 4.5;
/// Height of every other floor, in m.
pub(super) const FLOOR: f64 = 3.25;

/// The buildings of a city.
#[derive(Clone, Debug)]
pub struct Buildings {
    /// Median height in m.
    pub height: f64,
    /// Standard deviation of the height's logarithm.
    pub spread: f64,
    /// No building is higher, in m.
    pub tallest: f64,
    /// Length of a lot's side in m, about.
    pub lot: f64,
    /// Share of the lots that are empty.
    pub gaps: f64,
}

impl Default for Buildings {
    fn default() -> Self {
        Self { height: 20.0, spread: 0.45, tallest: 160.0, lot: 28.0, gaps: 0.03 }
    }
}

impl Plan for Buildings {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("height", &mut self.height, 5.0..=300.0, "metres")?;
        f.number("spread", &mut self.spread, 0.0..=2.0, "standard deviation of the natural logarithm")?;
        f.number("tallest", &mut self.tallest, 8.0..=900.0, "metres")?;
        f.number("lot", &mut self.lot, 12.0..=100.0, "metres")?;
        f.number("gaps", &mut self.gaps, 0.0..=1.0, "share of all lots")
    }
}

impl Buildings {
    /// How many boxes the buildings of a block with this side have, about and rather too many, where all blocks are as
    /// long as the longest.
    pub(super) fn boxes(&self, side: f64) -> f64 {
        let lots = lots(side, self.lot) as f64;
        let edge = if lots > 1.0 { 4.0 * (lots - 1.0) } else { 1.0 };
        // Five of six buildings are lower than one standard deviation above the median.
        let tiers = 1 + steps(floors((self.height * self.spread.exp()).min(self.tallest))).len();
        edge * (1.0 - self.gaps) * tiers as f64
    }
}

/// How many lots lie along a side of a block's land.
fn lots(length: f64, lot: f64) -> usize {
    ((length / lot).round() as usize).max(1)
}

/// Whole floors: which also keeps the last bits of `ln` and `exp` out of the result.
fn floors(height: f64) -> u32 {
    ((height - GROUND_FLOOR) / FLOOR).round().max(1.0) as u32
}

/// The shares of its floors at which a building steps back.
fn steps(floors: u32) -> &'static [f64] {
    match floors {
        0..=11 => &[],
        12..=24 => &[0.65],
        _ => &[0.45, 0.8],
    }
}

/// A box of a building, on the ground or on the one below.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tier {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    /// The sides with windows, by [`Side`].
    pub(super) open: [bool; 4],
}

impl Tier {
    /// The walls with windows.
    pub(super) fn walls(&self) -> impl Iterator<Item = Wall> {
        Side::ALL.into_iter().filter(|&side| self.open[side as usize]).map(|side| Wall::of(self.low, self.high, side))
    }
}

/// A building: tiers from the ground up.
#[derive(Clone, Debug)]
pub(super) struct Building {
    pub(super) tiers: Vec<Tier>,
    facade: u32,
}

impl Building {
    /// The tier on the ground; its open sides face streets.
    pub(super) fn base(&self) -> &Tier {
        &self.tiers[0]
    }

    /// The uppermost tier.
    pub(super) fn top(&self) -> &Tier {
        &self.tiers[self.tiers.len() - 1]
    }
}

/// A block: a slab of pavement with buildings.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Column and row.
    pub(super) place: [u64; 2],
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    /// Whether it stays open.
    pub(super) square: bool,
    pub(super) buildings: Vec<Building>,
}

/// All blocks, row after row.
#[derive(Clone, Debug)]
pub(super) struct Town {
    pub(super) layout: Layout,
    pub(super) blocks: Vec<Block>,
}

impl Town {
    pub(super) fn surfaces(&self) -> impl Iterator<Item = Surface> {
        self.blocks.iter().flat_map(|block| &block.buildings).flat_map(|building| {
            let facade = FIRST_FACADE + building.facade;
            building.tiers.iter().flat_map(move |tier| faces(tier.low, tier.high, facade, ROOF))
        })
    }

    pub(super) fn solids(&self) -> Vec<Solid> {
        let tiers = self.blocks.iter().flat_map(|block| &block.buildings).flat_map(|building| &building.tiers);
        tiers.map(|tier| Solid { low: round::position(tier.low), high: round::position(tier.high) }).collect()
    }
}

/// Lays out the streets and raises the buildings; bare blocks without any.
pub(super) fn build(grid: &Grid, buildings: Option<&Buildings>, seed: u64) -> Town {
    let layout = Layout::draw(grid, seed);
    let columns = layout.x.blocks.len();
    let blocks = (0..columns * layout.y.blocks.len())
        .into_par_iter()
        .map(|i| {
            let (column, row) = (i % columns, i / columns);
            let ([x0, x1], [y0, y1]) = (layout.x.blocks[column], layout.y.blocks[row]);
            let mut stream = Stream::keyed(&[seed, Tag::Block as u64, column as u64, row as u64]);
            let (low, high) = (DVec2::new(x0, y0), DVec2::new(x1, y1));
            let square = stream.uniform64() < grid.squares;
            let buildings = match buildings {
                Some(buildings) if !square => fill(buildings, low + grid.pavement, high - grid.pavement, &mut stream),
                _ => Vec::new(),
            };
            Block { place: [column as u64, row as u64], low, high, square, buildings }
        })
        .collect();
    Town { layout, blocks }
}

/// The buildings on a block's land.
fn fill(plan: &Buildings, low: DVec2, high: DVec2, stream: &mut Stream) -> Vec<Building> {
    let (columns, rows) = (lots(high.x - low.x, plan.lot), lots(high.y - low.y, plan.lot));
    let cut = |low: f64, high: f64, i: usize, n: usize| round::metres(low + (high - low) * i as f64 / n as f64);
    let mut out = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let open = [row == 0, column + 1 == columns, row + 1 == rows, column == 0];
            if open == [false; 4] || stream.uniform64() < plan.gaps {
                continue;
            }
            let low_corner = DVec2::new(cut(low.x, high.x, column, columns), cut(low.y, high.y, row, rows));
            let high_corner = DVec2::new(cut(low.x, high.x, column + 1, columns), cut(low.y, high.y, row + 1, rows));
            out.push(raise(plan, low_corner, high_corner, open, stream));
        }
    }
    out
}

/// One building on its lot.
fn raise(plan: &Buildings, low: DVec2, high: DVec2, open: [bool; 4], stream: &mut Stream) -> Building {
    let height = LogNormal::new(plan.height.ln(), plan.spread)
        .expect("the plan's spread is finite and not negative")
        .sample(stream.generator())
        .min(plan.tallest);
    let floors = floors(height);
    let mut tiers = vec![];
    let (mut low, mut high) = (low.extend(KERB), high.extend(0.0));
    let mut open = open;
    let mut done = 0;
    for &share in steps(floors).iter().chain(&[1.0]) {
        let until = (f64::from(floors) * share).round() as u32;
        let ground = if done == 0 { GROUND_FLOOR } else { 0.0 };
        high.z = low.z + ground + FLOOR * f64::from(until - done);
        tiers.push(Tier { low, high, open });
        done = until;
        // Every side of a tier that steps back is free. Narrow lots do not step back further.
        let inset = round::metres(2.5 + 2.0 * stream.uniform64());
        if (high - low).truncate().min_element() < 2.0 * inset + 8.0 {
            low.z = high.z;
            continue;
        }
        low = DVec3::new(low.x + inset, low.y + inset, high.z);
        high = DVec3::new(high.x - inset, high.y - inset, high.z);
        open = [true; 4];
    }
    Building { tiers, facade: stream.below(FACADES.len()) as u32 }
}
