//! How far from the truth is each strategy, after how much time?
//!
//! One [`Target`](target::Target) a scene holds the receivers and the exact image. A strategy must pass a `gate` of
//! quick checks. A [`Pilot`](plan::Pilot) says how far each strategy can go within its budget. [`compare`] runs all of
//! it, interleaved, and hands out rows as they come; [`trials`] answer the smaller question of an experiment: how good
//! at one budget?

pub mod clock;
pub mod compare;
pub mod environment;
pub mod errors;
pub mod films;
pub mod gate;
pub mod inspect;
pub mod observer;
mod once;
mod oracle;
pub mod plan;
pub mod reference;
pub mod summary;
pub mod target;
pub mod tiles;
pub mod trials;
