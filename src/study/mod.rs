//! The experiments behind `results/`: named, seeded, each with its question.
//!
//! A study opens its tables, fills them row by row and says in notes what a reader must know. Tables, page and plots
//! are then made from what it recorded, as for any result.
//!
//! | question | where |
//! |---|---|
//! | which studies are there? | [`STUDIES`], [`find`] |
//! | what is a study, and how is it run? | [`Entry`] |
//! | what may a user change of it? | [`StudyOptions`] |
//! | how is its question answered? | `strategies`, `visible`, `elsewhere`, `cutoff`, `scaling`, `soft_shadows`, `offsets` |
//! | what does it have while it runs? | `session` |
//! | how good is each strategy within a budget? | [`trial`] |
//! | how good is a choice of lights, before any ray is cast? | [`quality`] |
//! | how does something grow? | [`fit`] |
//! | which receivers stand for a city, and which city has a closed form? | `area`, `plane` |
//! | which scenes does it take, and how large are they? | `scenes`, `sizes` |
//! | what are its tables made of, and what stands in them? | `columns`, `cells` |
//!
//! Adding one takes a file here and a line in [`STUDIES`].

mod area;
mod cells;
mod columns;
mod cutoff;
mod elsewhere;
mod entry;
pub(crate) mod fit;
mod list;
mod offsets;
mod options;
mod plane;
pub(crate) mod quality;
mod scaling;
mod scenes;
mod session;
mod sizes;
mod soft_shadows;
mod strategies;
pub(crate) mod trial;
mod visible;

pub(crate) use entry::Entry;
pub(crate) use list::{STUDIES, find};
pub(crate) use options::StudyOptions;
