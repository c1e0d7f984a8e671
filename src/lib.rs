//! Many-light strategies on night cities, measured: error against run time.
//!
//! Data flows one way: recipe, [`scene`], receivers ([`visibility`]), [`strategy`], picks, radiance ([`render`]), film,
//! error (`measure`), rows (`record`), tables (`report`). A module imports only from the floors below its own.
//!
//! ```
//! use citylights::base::random::RunKey;
//! use citylights::render::{film::Film, passes::Plan};
//! use citylights::sources::{Overrides, recipe};
//! use citylights::strategy::{BuildContext, Registry};
//! use citylights::visibility::{offset::Offset, stage::{LeaveOut, Stage}};
//!
//! let text = r#"
//!     name = "a lamp"
//!     seed = 1
//!     version = 1
//!     camera = { position = [0, -8, 3], target = [0, 0, 0], resolution = [16, 9] }
//!     ground = { size = 100, material = "paving" }
//!     materials.paving = { albedo = [0.3, 0.3, 0.3] }
//!     light = [{ kind = "point", position = [0, 0, 6], intensity = 100 }]
//! "#;
//! let scene = recipe::parse(text, "lamp.toml".as_ref(), &Overrides::default())?;
//! let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
//! let sampler = Registry::standard().parse("power:picks=2")?.build(BuildContext { stage: &stage, seed: 1 })?;
//! let key = RunKey { seed: 1, run: 0 };
//! let mut film = Film::new(stage.receivers().len());
//! Plan { stage: &stage, receivers: stage.receivers(), sampler: sampler.as_ref(), key }.run(4, &mut film);
//! assert!(film.image().iter().all(|radiance| radiance.is_finite()));
//! # Ok::<(), citylights::base::error::Error>(())
//! ```

#![cfg_attr(not(test), forbid(unsafe_code))]
#![allow(rustdoc::private_intra_doc_links, reason = "a room says what it keeps to itself, too")]
#![cfg_attr(not(feature = "cli"), allow(dead_code, reason = "the command line alone needs every part of every room"))]

pub mod base;
#[cfg(feature = "bench")]
pub mod bench;
#[cfg(feature = "cli")]
pub mod calls;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "measure")]
mod explain;
#[cfg(feature = "gltf")]
mod export;
#[cfg(feature = "image")]
pub mod image;
#[cfg(feature = "measure")]
mod inspect;
#[cfg(feature = "cli")]
mod lecture;
#[cfg(feature = "measure")]
mod measure;
#[cfg(feature = "peers")]
mod peers;
pub mod prelude;
#[cfg(feature = "measure")]
pub mod record;
pub mod render;
#[cfg(feature = "plots")]
mod report;
pub mod scene;
pub mod shading;
pub mod sources;
#[cfg(feature = "measure")]
mod stability;
pub mod strategies;
pub mod strategy;
#[cfg(feature = "study")]
mod study;
#[cfg(feature = "gltf")]
mod texture;
pub mod tree;
#[cfg(feature = "measure")]
pub mod verify;
pub mod visibility;

#[cfg(test)]
extern crate self as citylights;

/// Promises that look behind closed doors. They stand in `tests` with those that do not, and run with the library's own.
#[cfg(all(test, feature = "cli"))]
#[path = "../tests"]
mod promises {
    pub(crate) mod common;

    #[path = "common/alone.rs"]
    mod alone;
    #[path = "common/counting.rs"]
    mod counting;
    #[path = "common/pictures.rs"]
    mod pictures;

    mod charged;
    mod contract;
    mod exchange;
    mod measuring;
    mod mutants;
    mod numerics;
    mod statistics;
}
