//! How far from the truth is each strategy, after how much time?
//!
//! One [`Target`](target::Target) a scene holds the receivers and the exact image. A strategy must pass a `gate` of
//! quick checks. A [`Pilot`](plan::Pilot) says how far each strategy can go within its budget. [`compare`] runs all of
//! it, interleaved, and hands out rows as they come. The [`engine`] alone reads a clock for a strategy.

pub(crate) mod clock;
pub(crate) mod compare;
pub(crate) mod counted;
pub(crate) mod curve;
pub(crate) mod engine;
pub(crate) mod errors;
pub(crate) mod experiment;
pub(crate) mod figure;
pub(crate) mod gate;
pub(crate) mod headline;
pub(crate) mod image_store;
pub(crate) mod observer;
mod options;
mod oracle;
pub(crate) mod plan;
mod ranking;
pub(crate) mod reference;
mod spread;
pub(crate) mod summary;
pub(crate) mod target;
pub(crate) mod tiles;
pub(crate) mod tune;
pub(crate) mod tuned;
pub(crate) mod tuning_cities;
pub(crate) mod work;
