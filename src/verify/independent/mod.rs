//! Does arithmetic that shares nothing with the program's come to the same?
//!
//! The truth that strategies are held to is made by the code that shades their picks: a fault there is in both and cannot
//! be seen. So everything is evaluated once more, from the formulas alone, in f64: pixel rays, normals on the viewer's
//! side, points on triangles, intensities, falloff, reflection, shadow rays with offsets of their own through a plain
//! list of all triangles. It shares no function with `visibility`, `shading` or `render`, and reads nothing but the
//! scene's numbers.
//!
//! | check | question | where |
//! |---|---|---|
//! | `receivers` | does each pixel see that point, with that normal and albedo? | `receivers` |
//! | `visits` | where receivers move: does a pass visit what its pixel sees, or what a bounce from there meets? | `visits` |
//! | `contribution` | does a point of a light add as much, with nothing in between? | `pairs` |
//! | `visibility` | does it arrive? | `pairs` |
//! | `triangle-mean` | do points drawn by angle add up to the triangle's closed form? | `means` |
//! | `importance` | is no triangle left out that can add anything? | `means` |
//! | `exact-sum` | is the exact image the sum over all lights? | `sums` |
//!
//! [`independent`](independent()) makes them all, of any [`Path`](path::Path): the program's [`Own`], or a test's wrong one. What
//! they hold it to is in `geometry` and `light`.
//!
//! Shadow rays are traced through every triangle, so their number is bounded (`TESTS` in `geometry`).

mod checks;
mod geometry;
mod light;
mod means;
mod own;
mod pairs;
mod path;
mod receivers;
mod sums;
mod visits;

pub(super) use checks::NAMES;
pub(crate) use checks::independent;
pub(crate) use own::Own;
#[cfg(test)]
pub(crate) use path::Path;
