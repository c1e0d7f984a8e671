//! How many shadow rays does a soft shadow take, where should they go, and how should their points be drawn?
//!
//! | question | where |
//! |---|---|
//! | which tables does the study have? | `run` |
//! | how does the error of a soft shadow fall with its rays? | `rays` |
//! | which lights should the rays go to? | `shares` |
//! | how should points on a light be drawn? | `ways` |
//! | which scenes show soft shadows? | `scene` |
//! | how far off are samplers, one beside the other? | `measure` |
//! | what does a shadow look like? | `picture` |

mod measure;
mod picture;
mod rays;
mod run;
mod scene;
mod shares;
mod ways;

pub(super) use run::ENTRY;
