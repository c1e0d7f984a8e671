//! What does a texture show, on the whole and in parts?
//!
//! Its texels, and above them levels of cells of 2 x 2, 4 x 4 ... texels with their means: a large part takes as little
//! time as a small one.

use crate::base::colour::srgb_decode;
use glam::Vec3;
use std::sync::LazyLock;

/// What the 8-bit codes of sRGB stand for.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|code| srgb_decode(code as f32 / 255.0)));

/// An image in linear Rec. 709.
pub(crate) struct Picture {
    /// Texels across and down.
    pub(crate) size: [usize; 2],
    /// The levels that are kept, the finest first, the last of one cell.
    levels: Vec<Level>,
    brightest: Vec3,
}

/// An image in cells of the same number of texels, but for those at its far edges.
struct Level {
    /// The binary logarithm of a cell's side in texels.
    shift: u32,
    across: usize,
    cells: Cells,
}

enum Cells {
    /// sRGB in 8 bits.
    Codes(Vec<u8>),
    Linear(Vec<[f32; 3]>),
}

impl Level {
    fn get(&self, x: usize, y: usize) -> Vec3 {
        let at = y * self.across + x;
        match &self.cells {
            Cells::Codes(codes) => {
                Vec3::from_array(std::array::from_fn(|channel| LINEAR[usize::from(codes[3 * at + channel])]))
            }
            Cells::Linear(cells) => Vec3::from_array(cells[at]),
        }
    }
}

impl Picture {
    /// The image of these 8-bit sRGB codes, three for each texel, row by row from the top; neither side is 0. A level of more
    /// than `most` cells is not kept, be they texels: a cell takes 12 bytes, a texel 3.
    pub(crate) fn new(size: [usize; 2], codes: Vec<u8>, most: usize) -> Self {
        let brightest = codes.chunks_exact(3).fold([0u8; 3], |most, texel| [0, 1, 2].map(|c| most[c].max(texel[c])));
        let brightest = Vec3::from_array(brightest.map(|code| LINEAR[usize::from(code)]));
        let mut levels = vec![Level { shift: 0, across: size[0], cells: Cells::Codes(codes) }];
        while let Some(finer) = levels.last().filter(|level| count(size, level.shift).iter().any(|&cells| cells > 1)) {
            let coarser = coarser(size, finer);
            let [across, down] = count(size, finer.shift);
            if across * down > most {
                levels.clear();
            }
            levels.push(coarser);
        }
        Self { size, levels, brightest }
    }

    /// Per channel, what its brightest texel has.
    pub(crate) fn brightest(&self) -> Vec3 {
        self.brightest
    }

    /// The mean of all texels.
    pub(crate) fn mean(&self) -> Vec3 {
        self.levels.last().map_or(Vec3::ZERO, |level| level.get(0, 0))
    }

    /// The levels that are kept, the finest first, as binary logarithms of a cell's side in texels.
    pub(crate) fn shifts(&self) -> impl Iterator<Item = u32> + Clone {
        self.levels.iter().map(|level| level.shift)
    }

    /// Cells along each side of a level.
    pub(crate) fn cells(&self, shift: u32) -> [usize; 2] {
        count(self.size, shift)
    }

    /// The mean of a cell of a level that is kept; `x` and `y` are below [`cells`](Self::cells).
    pub(crate) fn cell(&self, shift: u32, x: usize, y: usize) -> Vec3 {
        let finest = self.levels[0].shift;
        self.levels[(shift - finest) as usize].get(x, y)
    }
}

/// Cells along each side.
fn count(size: [usize; 2], shift: u32) -> [usize; 2] {
    size.map(|side| side.div_ceil(1 << shift))
}

/// The next level: each cell the mean of up to four, by their texels.
fn coarser(size: [usize; 2], finer: &Level) -> Level {
    let shift = finer.shift + 1;
    let ([wide, high], [across, down]) = (count(size, finer.shift), count(size, shift));
    // Texels along one side of a finer cell.
    let side = |of: usize, at: usize| ((at + 1) << finer.shift).min(of) - (at << finer.shift);
    let mut cells = Vec::with_capacity(across * down);
    for y in 0..down {
        for x in 0..across {
            let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
            for fine_y in 2 * y..(2 * y + 2).min(high) {
                for fine_x in 2 * x..(2 * x + 2).min(wide) {
                    let texels = (side(size[0], fine_x) * side(size[1], fine_y)) as f32;
                    sum += texels * finer.get(fine_x, fine_y);
                    weight += texels;
                }
            }
            cells.push((sum / weight).to_array());
        }
    }
    Level { shift, across, cells: Cells::Linear(cells) }
}
