//! How far from the truth is each strategy, after how much time?
//!
//! One [`Target`](target::Target) a scene holds the receivers and the exact image. A strategy must pass a `gate` of
//! quick checks. A [`Pilot`](plan::Pilot) says how far each strategy can go within its budget. [`compare`] runs all of
//! it, interleaved, and hands out rows as they come. The [`engine`] alone reads a clock for a strategy.

pub mod clock;
pub mod compare;
pub mod curve;
pub mod engine;
pub mod errors;
pub mod experiment;
pub mod figure;
pub mod gate;
pub mod headline;
pub mod image_store;
pub mod observer;
mod options;
mod oracle;
pub mod plan;
mod ranking;
pub mod reference;
mod spread;
pub mod summary;
pub mod target;
pub mod tiles;
pub mod work;
