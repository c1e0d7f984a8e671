//! What do the lecture's systems look like, one after the other?
//!
//! Each chapter of `docs/LECTURE.md` has one labelled picture. All figures in it are computed from the scene at hand.
//!
//! | question | where |
//! |---|---|
//! | which chapters are there? | [`CHAPTERS`], [`find`] |
//! | what does a chapter show? | `shadow_rays`, `offsets`, `area_lights`, `points`, `solid_angle`, `samples`, `many_lights`, `range`, `picks` |
//! | what is it drawn from, and which pixel is looked at? | [`Asked`] |
//! | how much of the area lights does a receiver see? | `soft` |
//! | what does each light add there? | `each` |
//! | how do quantities become pixels, and figures words? | `colour`, `words` |
//! | what is on a labelled picture? | `plate`, `dots` |
//! | how does it become a file? | `draw` |
//!
//! Adding a chapter takes a file here and an entry in [`CHAPTERS`].

mod area_lights;
mod asked;
mod chapter;
mod colour;
mod dots;
mod draw;
mod each;
mod many_lights;
mod offsets;
mod picks;
mod plate;
mod points;
mod range;
mod samples;
mod shadow_rays;
mod soft;
mod solid_angle;
mod words;

pub(crate) use asked::Asked;
pub(crate) use chapter::{CHAPTERS, Chapter, find};
