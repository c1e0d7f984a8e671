//! Which shadow-ray offset keeps surfaces free of acne and of light leaks, and how far from the origin?
//!
//! Scenes are moved as a whole, coordinates rounded to f32 where they end up, and the same rays are cast under each
//! policy and in f64.
//!
//! | question | where |
//! |---|---|
//! | which tables does the study have? | `run` |
//! | what becomes of the same rays under each policy? | `counts` |
//! | how far from the origin does a policy start to fail? | `starts` |
//! | what stands in the scenes, and where are receivers? | `geometry` |
//! | is a light seen, as f64 tells? | `stability::tracer` |

mod counts;
mod geometry;
mod run;
mod starts;

pub(super) use run::ENTRY;
