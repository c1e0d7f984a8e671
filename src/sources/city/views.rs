//! Where does a camera stand that the generator places?
//!
//! In a street, at a roof's edge or high above: wherever streets and buildings lie, so that many cities can be looked at
//! without a word about any of them. Each view draws from a stream of its own and changes no byte of the city.

use super::buildings::{self, Block, Building, Town};
use super::facade::{Side, Wall};
use super::layout::Layout;
use super::plan::City;
use super::round;
use super::tag::Tag;
use crate::base::error::{Error, Result};
use crate::base::random::Stream;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Height of an eye over what its owner stands on, in m.
const EYE: f64 = 1.7;
/// How far from a roof's edge somebody stands who looks down, in m.
const FROM_EDGE: f64 = 0.3;
/// Height of the view from the sky over the ground, in m.
const HIGH: f64 = 150.0;
/// How far it keeps above the tallest roof, in m.
const CLEAR: f64 = 20.0;

/// A view of a generated city.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// At eye height in a street near the middle, along the street and a little across it.
    Street,
    /// At the edge of a roof of middling height near the middle, out and down over a street.
    Roof,
    /// From 150 m up, and above every building, obliquely down to the middle.
    Sky,
}

impl View {
    /// Every view.
    pub(crate) const ALL: [Self; 3] = [Self::Street, Self::Roof, Self::Sky];

    /// Its name: `street`, `roof`, `sky`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Street => "street",
            Self::Roof => "roof",
            Self::Sky => "sky",
        }
    }
}

/// Where a camera stands, and what it looks at; multiples of 2^-10 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Standpoint {
    /// Where it stands.
    pub(crate) eye: DVec3,
    /// What it looks at.
    pub(crate) target: DVec3,
}

impl Standpoint {
    fn of(eye: DVec3, target: DVec3) -> Self {
        Self { eye: eye.map(round::metres), target: target.map(round::metres) }
    }
}

/// The standpoint of a view in the city of a plan and a seed.
///
/// # Errors
/// A plan that [`City::check`] refuses; a view from a roof where nothing is built.
pub(crate) fn stand(plan: &City, seed: u64, view: View) -> Result<Standpoint> {
    plan.check()?;
    let town = buildings::build(&plan.grid(), plan.buildings.as_ref(), seed);
    let mut stream = Stream::keyed(&[seed, Tag::Views as u64, view as u64]);
    match view {
        View::Street => Ok(street(&town.layout, &mut stream)),
        View::Roof => roof(&town, &mut stream).ok_or_else(|| Error::Parameter {
            owner: "city".into(),
            name: "buildings".into(),
            value: "no building".into(),
            expected: "the view `roof` needs one; `street` and `sky` do without".into(),
        }),
        View::Sky => Ok(sky(&town, &mut stream)),
    }
}

/// The middle third of `count` things in a row; one at least where there is any.
fn middle(count: usize) -> std::ops::Range<usize> {
    count / 3..count - count / 3
}

fn street(layout: &Layout, stream: &mut Stream) -> Standpoint {
    let along_y = stream.uniform64() < 0.5;
    let streets = layout.streets();
    let parallel: Vec<_> = streets.iter().filter(|street| street.along_y == along_y).collect();
    let middle = middle(parallel.len());
    let at = middle.start + stream.below(middle.len());
    let street = parallel[at];
    // Nearer to one kerb than to the other, and looking towards that: from the rim into the city.
    let from_low = match at {
        0 => true,
        last if last + 1 == parallel.len() => false,
        _ => stream.uniform64() < 0.5,
    };
    let share = round::uniform([0.15, 0.35], stream.uniform64()) * street.width();
    let (across, opposite) =
        if from_low { (street.low + share, street.high) } else { (street.high - share, street.low) };
    let [start, end] = street.ends;
    let along = start + street.length() * round::uniform([1.0 / 3.0, 2.0 / 3.0], stream.uniform64());
    // Towards the farther end, past the middle.
    let forward = if along - start < end - along { 1.0 } else { -1.0 };
    // A dozen degrees across in a street of any width, and 4 up.
    let ahead = 4.0 * street.width().max(15.0);
    let target = street.place(along + forward * ahead, opposite).extend(EYE + 0.07 * ahead);
    Standpoint::of(street.place(along, across).extend(EYE), target)
}

/// A view from a roof; none where there is no roof.
fn roof(town: &Town, stream: &mut Stream) -> Option<Standpoint> {
    let blocks = town.blocks.iter();
    let mut buildings: Vec<(&Block, &Building)> =
        blocks.flat_map(|block| block.buildings.iter().map(move |building| (block, building))).collect();
    // Of middling height, so that other roofs lie below and above.
    buildings.sort_by(|(_, a), (_, b)| a.top().high.z.total_cmp(&b.top().high.z));
    let mut middling = buildings[middle(buildings.len())].to_vec();
    let centre = centre(&town.layout);
    let off = |(_, building): &(&Block, &Building)| building.base().low.truncate().distance_squared(centre);
    middling.sort_by(|a, b| off(a).total_cmp(&off(b)));
    let &(block, building) = middling.get(stream.below(middling.len().div_ceil(3)))?;

    let faced = Side::ALL.into_iter().filter(|&side| building.base().open[side as usize]);
    let faced: Vec<Faced> = faced.map(|side| Faced::of(&town.layout, block.place, side)).collect();
    // A street between two blocks, where there is one.
    let inner: Vec<Faced> = faced.iter().copied().filter(|faced| !faced.rim).collect();
    let faced = if inner.is_empty() { faced } else { inner };
    let Faced { side, street, .. } = faced[stream.below(faced.len())];
    let wall = Wall::of(building.top().low, building.top().high, side);
    let eye = wall.point(0.5 * wall.width, wall.height + EYE, -FROM_EDGE);
    // As far along the street as to its middle, towards the middle of the city.
    let along = DVec3::new(-wall.out.y, wall.out.x, 0.0);
    let along = if along.truncate().dot(centre - eye.truncate()) < 0.0 { -along } else { along };
    let off = (street - eye.dot(wall.out.abs())).abs();
    let level = (wall.out + along).normalize();
    let down = (off * (wall.out + along)).with_z(-eye.z).normalize();
    // Halfway between the horizon and the middle of the street.
    Some(Standpoint::of(eye, eye + 40.0 * (level + down).normalize()))
}

/// A street that a building faces.
#[derive(Clone, Copy)]
struct Faced {
    /// The building's side.
    side: Side,
    /// The coordinate of the street's middle, across it, in m.
    street: f64,
    /// Whether the city ends with it.
    rim: bool,
}

impl Faced {
    /// The street before a side of the block in a column and a row.
    fn of(layout: &Layout, [column, row]: [u64; 2], side: Side) -> Self {
        let (streets, at) = match side {
            Side::South => (&layout.y.streets, row),
            Side::East => (&layout.x.streets, column + 1),
            Side::North => (&layout.y.streets, row + 1),
            Side::West => (&layout.x.streets, column),
        };
        let [low, high] = streets[at as usize];
        Self { side, street: 0.5 * (low + high), rim: at == 0 || at as usize + 1 == streets.len() }
    }
}

fn sky(town: &Town, stream: &mut Stream) -> Standpoint {
    let roofs = town.blocks.iter().flat_map(|block| &block.buildings).map(|building| building.top().high.z);
    let height = roofs.fold(HIGH - CLEAR, f64::max) + CLEAR;
    // Small cities from a steeper angle: beside them there is nothing to be seen.
    let off = (2.0 * height).min(0.25 * town.layout.x.length().min(town.layout.y.length()));
    let (sin, cos) = (TAU * stream.uniform64()).sin_cos();
    let centre = centre(&town.layout);
    Standpoint::of((centre + off * DVec2::new(cos, sin)).extend(height), centre.extend(0.0))
}

/// The middle of the city.
fn centre(layout: &Layout) -> DVec2 {
    let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
    DVec2::new(middle(layout.x.ends()), middle(layout.y.ends()))
}
