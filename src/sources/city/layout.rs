//! Where do streets and blocks lie?
//!
//! A grid with rows and columns of different widths: two middle streets cross at the coordinate origin, blocks and
//! streets alternate outwards. A row or column keeps its width over the whole city, so streets are straight.

use super::round;
use super::tag::Tag;
use crate::base::random::Stream;
use glam::DVec2;

/// What streets and blocks are laid out by; lengths in metres, the lesser of two first.
pub(super) struct Grid {
    /// Length of a block's side.
    pub(super) block: [f64; 2],
    /// Width of a street between its kerbs.
    pub(super) street: [f64; 2],
    /// Width of the pavement between kerb and buildings.
    pub(super) pavement: f64,
    /// Share of the blocks that stay open as squares.
    pub(super) squares: f64,
    /// Side of a block and one street at their mean widths.
    pub(super) pitch: f64,
    /// Ground to be covered, in m^2.
    pub(super) area: f64,
}

/// The streets and blocks along one axis: intervals in metres, ascending.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// The streets, one more than blocks.
    pub(super) streets: Vec<[f64; 2]>,
    /// The blocks between them.
    pub(super) blocks: Vec<[f64; 2]>,
}

impl Axis {
    fn draw(grid: &Grid, seed: u64, tag: Tag, blocks: usize) -> Self {
        let left = blocks / 2;
        let width = |span: [f64; 2], what: u64, place: i64| {
            let u = Stream::keyed(&[seed, tag as u64, what, place as u64]).uniform64();
            // Half metres: the numbers stay readable in an inspected scene.
            (round::uniform(span, u) * 2.0).round() / 2.0
        };
        let street = |place| width(grid.street, 0, place);
        let block = |place| width(grid.block, 1, place);
        let mut axis = Self { streets: Vec::new(), blocks: Vec::new() };
        let left_blocks = -(left as i64);
        let mut at = -0.5 * street(0) - (left_blocks..0).map(|i| street(i) + block(i)).sum::<f64>();
        for place in left_blocks..=(blocks - left) as i64 {
            let kerb = at + street(place);
            axis.streets.push([at, kerb]);
            at = kerb;
            if place < (blocks - left) as i64 {
                at = kerb + block(place);
                axis.blocks.push([kerb, at]);
            }
        }
        axis
    }

    /// Both ends, in metres.
    pub(super) fn ends(&self) -> [f64; 2] {
        [self.streets[0][0], self.streets[self.streets.len() - 1][1]]
    }

    /// Length in metres.
    pub(super) fn length(&self) -> f64 {
        self.ends()[1] - self.ends()[0]
    }
}

/// The grid.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// Streets that run along y, and the blocks between them.
    pub(super) x: Axis,
    /// Streets that run along x, and the blocks between them.
    pub(super) y: Axis,
}

impl Layout {
    /// As near to a square of the area as whole blocks allow.
    pub(super) fn draw(grid: &Grid, seed: u64) -> Self {
        let blocks = |length: f64| ((length / grid.pitch).round() as usize).max(1);
        let x = Axis::draw(grid, seed, Tag::StreetsX, blocks(grid.area.sqrt()));
        let y = Axis::draw(grid, seed, Tag::StreetsY, blocks(grid.area / x.length()));
        Self { x, y }
    }

    /// Every street with its number.
    pub(super) fn streets(&self) -> Vec<Street> {
        let along_y = self.x.streets.iter().map(|&[low, high]| (true, low, high, self.y.ends()));
        let along_x = self.y.streets.iter().map(|&[low, high]| (false, low, high, self.x.ends()));
        let all = along_y.chain(along_x).enumerate();
        all.map(|(i, (along_y, low, high, ends))| Street { number: i as u64, along_y, low, high, ends }).collect()
    }
}

/// One straight street.
pub(super) struct Street {
    /// Its place in the list of all streets.
    pub(super) number: u64,
    /// Whether it runs along y.
    pub(super) along_y: bool,
    /// The coordinate of one kerb, across the street, in m.
    pub(super) low: f64,
    /// That of the other kerb; greater.
    pub(super) high: f64,
    /// The coordinates of its ends, along it, in m.
    pub(super) ends: [f64; 2],
}

impl Street {
    /// The point with these coordinates along and across the street.
    pub(super) fn place(&self, along: f64, across: f64) -> DVec2 {
        if self.along_y { DVec2::new(across, along) } else { DVec2::new(along, across) }
    }

    pub(super) fn width(&self) -> f64 {
        self.high - self.low
    }

    pub(super) fn length(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}
