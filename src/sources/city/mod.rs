//! A night city, grown from a few tables of numbers.
//!
//! [`City`] says what there is, [`generate()`] makes it: first the layout of streets and blocks, then the
//! buildings, then each part's lights, last as many lit windows as the number of lights still asks for.
//! Distributions follow what is known of real cities: about 10,600 lights per km^2 (Kyba et al. 2025), lamps 25-40 m
//! apart, street canyons, and a heavy tail of floodlights.
//!
//! The same plan and seed give the same bytes on any number of threads: each street, block and building draws from a
//! stream of its own and results are joined in order. Positions are multiples of 2^-10 m and intensities of 10^-4,
//! because the last bit of `ln`, `exp` and `sin` differs between platforms.
//! Where many cities are looked at, a [`View`] says from where, without a word about any of them.
//! Arrays keep the degeneracies of real ones: lamps exactly collinear, window grids exactly coplanar with equal
//! powers, signs back to back.

mod beacons;
mod buildings;
mod bulbs;
mod facade;
mod fields;
mod floodlights;
mod generate;
mod ground;
mod lamps;
mod layout;
mod materials;
mod moon;
mod plan;
mod round;
mod shops;
mod signs;
mod solid;
mod tag;
mod traffic;
mod views;
mod windows;

#[cfg(feature = "recipe")]
pub(crate) use fields::{Fields, Plan, count_wanted, names, number_wanted, span_wanted};
pub use generate::{Grown, generate};
#[cfg(feature = "recipe")]
pub(crate) use materials::builtin_materials;
pub use solid::Solid;
#[cfg(feature = "recipe")]
pub(crate) use views::{Standpoint, stand};

pub use beacons::Beacons;
pub use buildings::Buildings;
pub use bulbs::Bulbs;
pub use floodlights::Floodlights;
pub use lamps::{LampKind, Lamps};
pub use moon::Moon;
pub use plan::City;
pub use shops::Shops;
pub use signs::Signs;
pub use traffic::Traffic;
pub use views::View;
pub use windows::Windows;
