//! Which receivers share a table?
//!
//! Those in one cube of a grid whose normals have the same greatest component and sign. Where they are few, as far from the
//! camera, the cube is one of a coarser grid, and holds those alone that found no company in a finer one. Cells are known when
//! the sampler is built; each keeps a few of its receivers, spread over all of them, for its table to be learned at.

use super::learned::{Table as Learned, WIDTH};
use crate::base::random::hash;
use crate::scene::receiver::Receiver;
use crate::tree::Region;
use glam::Vec3;
use std::cmp::Reverse;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::ops::Range;
use std::sync::OnceLock;

/// Most receivers of a cell that its clusters are tried at.
const TRIED: usize = 8;

/// How far receivers are moved along their normal before the grid is laid, as a share of a cell: a wall in a plane of
/// the grid would lie on both sides of it by rounding.
const LIFT: f32 = 1e-3;

type Table = Learned<WIDTH>;

/// Grids, each of twice the side of the one before.
const GRIDS: i32 = 4;

/// The cells of a scene's receivers.
#[derive(Default)]
pub(super) struct Cells {
    /// Cells a metre, the smallest first.
    scales: Vec<f32>,
    /// The place of each cell by its name.
    places: HashMap<u64, u32, BuildHasherDefault<Named>>,
    cells: Vec<Cell>,
    /// Receivers to learn at, those of each cell together.
    tried: Vec<Spot>,
}

/// Receivers that share a table.
struct Cell {
    name: u64,
    low: Vec3,
    high: Vec3,
    /// Sum of the normals.
    normals: Vec3,
    /// How many of the stage's receivers there are.
    count: u32,
    /// Where those to learn at start.
    first: u32,
    table: OnceLock<Table>,
}

/// What shadow rays need to know of a receiver.
#[derive(Clone, Copy)]
struct Spot {
    position: Vec3,
    normal: Vec3,
}

impl Spot {
    fn receiver(self) -> Receiver {
        let Self { position, normal } = self;
        Receiver { position, normal, view: normal, albedo: Vec3::ONE, pixel: 0, surface: 0 }
    }
}

/// The names are hashes already.
#[derive(Default)]
struct Named(u64);

impl Hasher for Named {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, _bytes: &[u8]) {
        unreachable!("a name is a u64");
    }

    fn write_u64(&mut self, name: u64) {
        self.0 = name;
    }
}

/// The name of the cell of that size that a receiver is in. Two cells may by chance, one in 10^19, have the same: they then share
/// a table.
#[inline]
fn name(at: &Receiver, scale: f32) -> u64 {
    let [x, y, z] = (at.position * scale + at.normal * LIFT).floor().to_array().map(|x| x as i32 as u32);
    let axis = at.normal.abs().max_position();
    let way = 2 * axis as u64 + u64::from(at.normal[axis] < 0.0);
    hash(&[u64::from(x) << 32 | u64::from(y), u64::from(z) << 32 | way, u64::from(scale.to_bits())])
}

impl Cell {
    fn new(name: u64) -> Self {
        let (low, high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        Self { name, low, high, normals: Vec3::ZERO, count: 0, first: 0, table: OnceLock::new() }
    }

    fn add(&mut self, at: &Receiver) {
        self.low = self.low.min(at.position);
        self.high = self.high.max(at.position);
        self.normals += at.normal;
        self.count += 1;
    }

    /// How many receivers it is learned at.
    fn tried(&self) -> u32 {
        self.count.min(TRIED as u32)
    }

    fn spots(&self) -> Range<usize> {
        self.first as usize..(self.first + self.tried()) as usize
    }

    fn region(&self) -> Region {
        let (centre, half) = (0.5 * self.low + 0.5 * self.high, 0.5 * self.high - 0.5 * self.low);
        Region { middle: Spot { position: centre, normal: self.normals.normalize() }.receiver(), half }
    }
}

impl Cells {
    /// The cells of all receivers: of `side` in metres, or of twice that and so on where fewer than `least` are in one. If their
    /// tables of `table` bytes each do not fit into `memory` bytes, only those with the most receivers are kept.
    pub(super) fn new(receivers: &[Receiver], side: f32, least: u32, memory: usize, table: usize) -> Self {
        let mut cells: Vec<Cell> = Vec::new();
        let mut left: Vec<&Receiver> = receivers.iter().collect();
        let mut scales = Vec::new();
        for grid in 0..GRIDS {
            let scale = 0.5f32.powi(grid) / side;
            let mut places = HashMap::<u64, usize, BuildHasherDefault<Named>>::default();
            let mut here: Vec<Cell> = Vec::new();
            for at in &left {
                let name = name(at, scale);
                let place = *places.entry(name).or_insert_with(|| {
                    here.push(Cell::new(name));
                    here.len() - 1
                });
                here[place].add(at);
            }
            left.retain(|at| here[places[&name(at, scale)]].count < least);
            cells.extend(here.into_iter().filter(|cell| cell.count >= least));
            scales.push(scale);
        }
        let each = size_of::<Cell>() + TRIED * size_of::<Spot>() + table + 2 * size_of::<(u64, u32)>();
        // The first of as many receivers come first: the sort is stable.
        cells.sort_by_key(|cell| Reverse(cell.count));
        cells.truncate(memory / each);
        cells.shrink_to_fit();
        let places = cells.iter().zip(0..).map(|(cell, place)| (cell.name, place)).collect();
        let mut found = Self { scales, places, cells, tried: Vec::new() };
        found.count(receivers);
        found.spread(receivers);
        found
    }

    /// Counts the receivers anew: those of a cell that did not fit may have found a coarser one.
    fn count(&mut self, receivers: &[Receiver]) {
        self.cells.iter_mut().for_each(|cell| *cell = Cell::new(cell.name));
        for at in receivers {
            if let Some(place) = self.find(at) {
                self.cells[place as usize].add(at);
            }
        }
        let mut first = 0;
        for cell in &mut self.cells {
            cell.first = first;
            first += cell.tried();
        }
        self.tried = vec![Spot { position: Vec3::ZERO, normal: Vec3::Z }; first as usize];
    }

    /// Chooses the receivers to try.
    fn spread(&mut self, receivers: &[Receiver]) {
        let mut met = vec![0u32; self.cells.len()];
        for at in receivers {
            let Some(place) = self.find(at) else { continue };
            let (cell, met) = (&self.cells[place as usize], &mut met[place as usize]);
            // In equal steps through the cell's receivers, which are neighbours together.
            let upto = |met: u32| (u64::from(met) * u64::from(cell.tried()) / u64::from(cell.count)) as u32;
            let (before, after) = (upto(*met), upto(*met + 1));
            if after > before {
                self.tried[(cell.first + before) as usize] = Spot { position: at.position, normal: at.normal };
            }
            *met += 1;
        }
        debug_assert!(met.iter().zip(&self.cells).all(|(&met, cell)| met == cell.count), "cells count their receivers");
    }

    /// The cell that a receiver is in; `None` if it has no table.
    #[inline]
    pub(super) fn find(&self, at: &Receiver) -> Option<u32> {
        if self.cells.is_empty() {
            return None;
        }
        self.scales.iter().find_map(|&scale| self.places.get(&name(at, scale)).copied())
    }

    /// The table of a cell; `learn` makes it of the cell's region, the receivers to try and the cell's name.
    #[inline]
    pub(super) fn table(&self, cell: u32, learn: impl FnOnce(&Region, &[Receiver], u64) -> Table) -> &Table {
        let cell = &self.cells[cell as usize];
        cell.table.get_or_init(|| {
            let tried: Vec<Receiver> = self.tried[cell.spots()].iter().map(|spot| spot.receiver()).collect();
            learn(&cell.region(), &tried, cell.name)
        })
    }

    pub(super) fn heap_bytes(&self) -> usize {
        let tables = self.cells.iter().filter_map(|cell| cell.table.get()).map(Table::heap_bytes).sum::<usize>();
        size_of_val(&self.cells[..])
            + size_of_val(&self.tried[..])
            + self.places.capacity() * size_of::<(u64, u32)>()
            + tables
    }
}
