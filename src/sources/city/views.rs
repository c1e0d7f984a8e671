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
    // Along the street towards the middle of the city; less than across it, or the roof itself would fill a corner.
    let along = DVec3::new(-wall.out.y, wall.out.x, 0.0);
    let along = if along.truncate().dot(centre - eye.truncate()) < 0.0 { -along } else { along };
    let level = wall.out + 0.7 * along;
    let off = (street - eye.dot(wall.out.abs())).abs();
    let down = (off * level).with_z(-eye.z).normalize();
    // Halfway between the horizon and the middle of the street.
    Some(Standpoint::of(eye, eye + 40.0 * (level.normalize() + down).normalize()))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sources::city::{Buildings, Lamps, generate};

    /// The standpoint of a view, which lies in the city and in no building.
    fn stood(plan: &City, seed: u64, view: View) -> Standpoint {
        let at = stand(plan, seed, view).unwrap_or_else(|error| panic!("{} of seed {seed}: {error}", view.name()));
        let grown = generate(plan, seed).expect("a plan within its ranges");
        let within = grown.solids.iter().find(|solid| solid.contains(at.eye.as_vec3()));
        assert!(within.is_none(), "{} of seed {seed} stands in {within:?}: {at:?}", view.name());
        let corners = || grown.surfaces.iter().flat_map(|surface| surface.corners).map(glam::Vec3::truncate);
        let [low, high] =
            [corners().reduce(glam::Vec2::min), corners().reduce(glam::Vec2::max)].map(Option::unwrap_or_default);
        let eye = at.eye.as_vec3().truncate();
        assert!(eye.cmpge(low).all() && eye.cmple(high).all(), "{} of seed {seed} stands outside: {at:?}", view.name());
        assert!(at.eye.distance(at.target) > 10.0 && at.eye.is_finite(), "{at:?}");
        at
    }

    fn plans() -> [(&'static str, City); 5] {
        let built = |buildings| City { buildings: Some(buildings), lamps: Some(Lamps::default()), ..City::default() };
        [
            ("usual", built(Buildings::default())),
            ("one block", City { lights: 1, density: 1e6, squares: 0.0, ..built(Buildings::default()) }),
            (
                "one lot a block",
                City {
                    lights: 400,
                    block: [40.0, 44.0],
                    pavement: 10.0,
                    ..built(Buildings { lot: 100.0, ..Buildings::default() })
                },
            ),
            (
                "towers over alleys",
                City {
                    street: [6.0, 7.0],
                    ..built(Buildings { height: 300.0, spread: 1.0, tallest: 900.0, ..Buildings::default() })
                },
            ),
            (
                "low over wide streets",
                City { street: [70.0, 80.0], ..built(Buildings { height: 5.0, spread: 0.0, ..Buildings::default() }) },
            ),
        ]
    }

    #[test]
    fn every_plan_has_its_views() {
        for ((name, plan), seed) in plans().into_iter().flat_map(|plan| (1..=20).map(move |seed| (plan.clone(), seed)))
        {
            let grown = generate(&plan, seed).expect(name);
            let tallest = grown.solids.iter().map(|solid| solid.high.z).fold(0.0, f32::max);
            let street = stood(&plan, seed, View::Street);
            assert!((street.eye.z - EYE).abs() < 1e-3 && street.target.z > street.eye.z, "{name}: {street:?}");
            let roof = stood(&plan, seed, View::Roof);
            let below = |solid: &&crate::sources::city::Solid| {
                let foot = roof.eye.with_z(roof.eye.z - EYE - 0.01).as_vec3();
                solid.contains(foot)
            };
            assert!(grown.solids.iter().any(|solid| below(&solid)), "{name}: no roof below {roof:?}");
            assert!(roof.target.z < roof.eye.z, "{name}: {roof:?}");
            let sky = stood(&plan, seed, View::Sky);
            assert!(
                sky.eye.z >= HIGH && sky.eye.z >= f64::from(tallest) + CLEAR - 1e-3,
                "{name}: {sky:?} over {tallest}"
            );
            assert_eq!(sky.target.z, 0.0, "{name}");
        }
    }

    #[test]
    fn a_roof_needs_a_building_and_nothing_else_does() {
        for plan in [City::default(), City { squares: 1.0, buildings: Some(Buildings::default()), ..City::default() }] {
            let error = stand(&plan, 1, View::Roof).expect_err("no roof").to_string();
            assert!(error.contains("no building") && error.contains("`street` and `sky`"), "{error}");
            stood(&plan, 1, View::Street);
            stood(&plan, 1, View::Sky);
        }
    }

    #[test]
    fn a_city_of_a_million_lights_is_seen_from_its_middle() {
        let plan = City { lights: 1_000_000, buildings: Some(Buildings::default()), ..City::default() };
        let reach = 0.5 * (plan.lights as f64 / plan.density * 1e6).sqrt();
        for view in View::ALL {
            let at = stand(&plan, 1, view).expect("a view");
            let off = at.eye.truncate().abs().max_element();
            assert!(off < 0.4 * reach, "{} stands {off} m from the middle of a city of {reach} m", view.name());
        }
    }

    #[test]
    fn a_view_follows_from_the_plan_and_the_seed() {
        let [(_, plan), ..] = plans();
        for view in View::ALL {
            let at = stand(&plan, 5, view).expect("a view");
            assert_eq!(at, stand(&plan, 5, view).expect("a view"));
            assert_ne!(at, stand(&plan, 6, view).expect("a view"));
            for coordinate in at.eye.to_array().into_iter().chain(at.target.to_array()) {
                assert_eq!((coordinate * 1024.0).fract(), 0.0, "{at:?}");
            }
        }
    }
}
