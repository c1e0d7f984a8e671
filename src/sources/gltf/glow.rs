//! How does a surface shine whose brightness a texture decides?
//!
//! In pieces of one brightness each, the mean of the texture over the piece times the material's factors. A triangle is
//! cut in four at the middles of its edges, these again, and so on; then four that are alike are put together again. How
//! often is the same for all of a file: as often as leaves at most 2^17 pieces in all, at most five times (1,024 pieces),
//! and never below a texel. The light of a triangle is that of its texels, whatever its pieces.
//!
//! Pieces darker than 1/500 of the texture's brightest texel reflect, as the rest of the material does: they are what is
//! black around the lamps of a facade, but for the noise of JPEG.

use super::mapping::Mapping;
use crate::texture::coverage;
use crate::texture::picture::Picture;
use glam::{DVec2, Vec3};

/// Most pieces of all textured triangles, where they are cut at all.
const MOST_PIECES: usize = 1 << 17;
/// Most times that a triangle is cut in four.
const DEEPEST: u32 = 5;
/// Pieces are alike if no channel differs by more than this share of the brightest.
const ALIKE: f32 = 1.0 / 32.0;
/// Pieces darker than this share of the brightest texel reflect.
const DARK: f32 = 1.0 / 500.0;
/// Most cells of textures that are looked at, in all and for a piece: 2^24 take a second.
const MOST_CELLS: usize = 1 << 24;
const MOST_CELLS_EACH: usize = 1 << 12;

/// A textured emitter.
pub(super) struct Glow {
    /// The number of its picture.
    pub(super) picture: usize,
    pub(super) mapping: Mapping,
    /// Radiance in cd/m^2 where the texture is white.
    pub(super) radiance: Vec3,
}

/// All textured emitters of a document.
#[derive(Default)]
pub(super) struct Glows {
    pub(super) all: Vec<Glow>,
    pub(super) pictures: Vec<Picture>,
    depth: u32,
    cells: usize,
}

/// A triangle of one brightness.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) corners: [Vec3; 3],
    /// Radiance in cd/m^2.
    pub(super) radiance: Vec3,
    /// Whether it reflects.
    pub(super) dark: bool,
}

impl Glows {
    /// Decides how fine so many textured triangles are cut.
    pub(super) fn plan(&mut self, triangles: usize) {
        let pieces = |depth: u32| triangles.saturating_mul(1 << (2 * depth));
        self.depth = (0..=DEEPEST).rev().find(|&depth| pieces(depth) <= MOST_PIECES).unwrap_or(0);
        self.cells = (MOST_CELLS / pieces(self.depth).max(1)).clamp(1, MOST_CELLS_EACH);
    }

    /// Appends the pieces of a triangle whose corners lie at `places` in the picture of a glow.
    pub(super) fn cut(&self, glow: &Glow, corners: [Vec3; 3], places: [DVec2; 3], parts: &mut Vec<Part>) {
        self.cut_to(self.depth, glow, corners, places, parts);
    }

    fn cut_to(&self, depth: u32, glow: &Glow, corners: [Vec3; 3], places: [DVec2; 3], parts: &mut Vec<Part>) {
        let picture = &self.pictures[glow.picture];
        let size = DVec2::new(picture.size[0] as f64, picture.size[1] as f64);
        let edges = [places[1] - places[0], places[2] - places[0], places[2] - places[1]];
        let within_a_texel = edges.iter().all(|edge| (*edge * size).abs().max_element() <= 1.0);
        if depth == 0 || within_a_texel {
            let radiance = glow.radiance * coverage::mean(picture, glow.mapping.wrap, places, self.cells);
            let brightest = (glow.radiance * picture.brightest()).max_element();
            parts.push(Part { corners, radiance, dark: radiance.max_element() <= DARK * brightest });
            return;
        }
        let begun = parts.len();
        let ([a, b, c], [u, v, w]) = (corners, places);
        let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
        let [uv, vw, wu] = [u.midpoint(v), v.midpoint(w), w.midpoint(u)];
        for (corners, places) in [
            ([a, ab, ca], [u, uv, wu]),
            ([ab, b, bc], [uv, v, vw]),
            ([ca, bc, c], [wu, vw, w]),
            ([ab, bc, ca], [uv, vw, wu]),
        ] {
            self.cut_to(depth - 1, glow, corners, places, parts);
        }
        // Four pieces are the four parts, none cut further.
        let four = &parts[begun..];
        if four.len() == 4 && alike(four) {
            let radiance = four.iter().map(|part| part.radiance).sum::<Vec3>() / 4.0;
            let dark = four[0].dark;
            parts.truncate(begun);
            parts.push(Part { corners, radiance, dark });
        }
    }
}

fn alike(parts: &[Part]) -> bool {
    let all = |dark: bool| parts.iter().all(|part| part.dark == dark);
    let low = parts.iter().fold(Vec3::INFINITY, |low, part| low.min(part.radiance));
    let high = parts.iter().fold(Vec3::ZERO, |high, part| high.max(part.radiance));
    all(true) || (all(false) && (high - low).max_element() <= ALIKE * high.max_element())
}
