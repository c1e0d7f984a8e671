//! What is the mean of a texture over a triangle?
//!
//! Each texel is a rectangle of one colour; the triangle is cut along their edges, and each part weighs by its area. A
//! triangle over more cells than it may look at is held against the next level of coarser ones.

use super::picture::Picture;
use crate::base::polygon::above;
use glam::{DVec2, Vec3};

/// Triangles of less than this part of their extent's square are lines or points.
const FLAT: f64 = 1e-9;
/// Coordinates beyond this many images have no digits left for texels.
const FARTHEST: f64 = 1e6;
/// Samples along each side of a triangle that is a line: 64 in all.
const ALONG: u32 = 8;

/// What a texture is beyond its edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wrap {
    /// The same again.
    Repeat,
    /// The same again, every other time mirrored.
    Mirror,
    /// Its outermost texels, for ever.
    Clamp,
}

/// A cell's extent along one axis.
struct Span {
    from: f64,
    to: f64,
    cell: usize,
}

/// The mean over a triangle whose corners are in widths and heights from the image's upper left corner, looking at
/// about `most` cells, 1 or more; corners are finite.
pub(crate) fn mean(picture: &Picture, wrap: [Wrap; 2], corners: [DVec2; 3], most: usize) -> Vec3 {
    if corners.iter().any(|corner| corner.abs().max_element() > FARTHEST) {
        return picture.mean();
    }
    let size = DVec2::new(picture.size[0] as f64, picture.size[1] as f64);
    // Whole periods leave it where it is, nearer to 0.
    let low = corners.iter().fold(DVec2::INFINITY, |low, corner| low.min(*corner));
    let near = DVec2::new(periods(wrap[0], low.x), periods(wrap[1], low.y));
    let corners = corners.map(|corner| (corner - near) * size);
    let low = corners.iter().fold(DVec2::INFINITY, |low, corner| low.min(*corner));
    let high = corners.iter().fold(DVec2::NEG_INFINITY, |high, corner| high.max(*corner));
    let [a, b, c] = corners;
    let extent = (high - low).max_element();
    if (b - a).perp_dot(c - a).abs() <= FLAT * extent * extent {
        return along(picture, wrap, corners);
    }
    // At least one cell more than fit along each axis: ends of spans lie anywhere in theirs.
    let crossed = |axis: usize, shift: u32| {
        let (low, high, size) = (low[axis], high[axis], size[axis]);
        let (low, high) = if wrap[axis] == Wrap::Clamp { (low.max(0.0), high.min(size)) } else { (low, high) };
        let length = (high - low).max(0.0);
        length / f64::from(1u32 << shift.min(31)) + length / size + 2.0
    };
    let shift = picture.shifts().find(|&shift| crossed(0, shift) * crossed(1, shift) <= most as f64);
    let Some(shift) = shift.filter(|&shift| picture.cells(shift) != [1, 1]) else { return picture.mean() };
    let spans = |axis: usize| spans(picture.size[axis], wrap[axis], shift, low[axis], high[axis]);
    let (columns, rows) = (spans(0), spans(1));
    let (mut sum, mut area) = ([0.0; 3], 0.0);
    for row in &rows {
        let band = cut(&corners, DVec2::Y, row.from, row.to);
        for column in &columns {
            let part = twice_area(&cut(&band, DVec2::X, column.from, column.to));
            if part > 0.0 {
                let cell = picture.cell(shift, column.cell, row.cell).as_dvec3() * part;
                sum = [sum[0] + cell.x, sum[1] + cell.y, sum[2] + cell.z];
                area += part;
            }
        }
    }
    if area > 0.0 {
        Vec3::from_array(sum.map(|channel| (channel / area) as f32))
    } else {
        along(picture, wrap, corners)
    }
}

/// The mean over a triangle without an area: of the texels at points spread over it.
fn along(picture: &Picture, wrap: [Wrap; 2], [a, b, c]: [DVec2; 3]) -> Vec3 {
    let Some(shift) = picture.shifts().next() else { return Vec3::ZERO };
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    // Middles of the triangles that its sides cut into equal parts make.
    for i in 0..ALONG {
        for j in 0..ALONG {
            // The square's lower half, or the upper half of the one that lies opposite.
            let upright = i + j < ALONG;
            let [i, j] = if upright { [i, j] } else { [ALONG - 1 - i, ALONG - 1 - j] };
            let third = if upright { 1.0 / 3.0 } else { 2.0 / 3.0 };
            let [u, v] = [i, j].map(|k| (f64::from(k) + third) / f64::from(ALONG));
            let place = a + (b - a) * u + (c - a) * v;
            let cell = |axis: usize| span(picture.size[axis], wrap[axis], shift, place[axis]).cell;
            sum += picture.cell(shift, cell(0), cell(1));
            count += 1.0;
        }
    }
    sum / count
}

/// Whole periods below a coordinate.
fn periods(wrap: Wrap, low: f64) -> f64 {
    match wrap {
        Wrap::Repeat => low.floor(),
        Wrap::Mirror => (low / 2.0).floor() * 2.0,
        Wrap::Clamp => 0.0,
    }
}

/// The cells from `low` to `high`, one after another.
fn spans(size: usize, wrap: Wrap, shift: u32, low: f64, high: f64) -> Vec<Span> {
    let mut spans = vec![span(size, wrap, shift, low)];
    while let Some(last) = spans.last().filter(|last| last.to < high) {
        let next = span(size, wrap, shift, last.to);
        // Rounding never holds it up.
        let to = next.to.max(last.to + 0.5);
        spans.push(Span { from: last.to, to, ..next });
    }
    spans
}

/// The cell that begins at or holds a coordinate in texels.
fn span(size: usize, wrap: Wrap, shift: u32, at: f64) -> Span {
    let (whole, last) = (size as f64, (size - 1) >> shift);
    let begin = |cell: usize| ((cell << shift).min(size)) as f64;
    let tile = if wrap == Wrap::Clamp { 0.0 } else { (at / whole).floor() };
    let within = at - tile * whole;
    if wrap == Wrap::Mirror && tile.rem_euclid(2.0) == 1.0 {
        // Backwards: the texel that begins at `within` ends at what is left.
        let texel = ((whole - within).ceil() - 1.0).max(0.0) as usize;
        let cell = (texel >> shift).min(last);
        return Span { from: at, to: tile * whole + whole - begin(cell), cell };
    }
    let cell = (within.max(0.0) as usize >> shift).min(last);
    let to = if wrap == Wrap::Clamp && cell == last { f64::INFINITY } else { tile * whole + begin(cell + 1) };
    Span { from: at, to, cell }
}

/// What of a convex polygon lies between two lines across `axis`.
fn cut(polygon: &[DVec2], axis: DVec2, from: f64, to: f64) -> Vec<DVec2> {
    let above = half(polygon, axis, from);
    half(&above, -axis, -to)
}

/// What of a convex polygon lies where `axis` has at least `least`.
fn half(polygon: &[DVec2], axis: DVec2, least: f64) -> Vec<DVec2> {
    above(polygon, |corner| corner.dot(axis) - least)
}

fn twice_area(polygon: &[DVec2]) -> f64 {
    let Some(&first) = polygon.first() else { return 0.0 };
    polygon.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first)).sum::<f64>().abs()
}
