//! Which cars are on the streets?
//!
//! Each is two headlights (narrow spots that dip a little) and two red tail lights (points); it keeps to the right.
//! Bodies are left out.

use super::fields::{Fields, Plan};
use super::layout::{Layout, Street};
use super::round;
use super::tag::Tag;
use crate::base::colour::black_body;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::{Shape, cone_flux};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Half the distance between a pair of lights, and from the car's middle to its lamps, in m.
const HALF: [f64; 2] = [0.7, 2.2];

/// Cars.
#[derive(Clone, Debug)]
pub struct Traffic {
    /// Cars on a kilometre of street.
    pub per_km: f64,
    /// Flux of one headlight in lm.
    pub headlight: f64,
    /// Intensity of one tail light in cd.
    pub tail_light: f64,
}

impl Default for Traffic {
    fn default() -> Self {
        Self { per_km: 12.0, headlight: 900.0, tail_light: 6.0 }
    }
}

impl Plan for Traffic {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        f.number("per_km", &mut self.per_km, 0.0..=150.0, "cars on a kilometre of street")?;
        f.number("headlight", &mut self.headlight, 1.0..=1e5, "lumens")?;
        f.number("tail_light", &mut self.tail_light, 0.01..=1e4, "candelas")
    }
}

/// Headlights and tail lights.
pub(super) fn place(plan: &Traffic, layout: &Layout, seed: u64) -> (Vec<Shape>, Vec<Shape>) {
    let per_street: Vec<_> = layout.streets().par_iter().map(|street| drive(plan, street, seed)).collect();
    let (heads, tails): (Vec<_>, Vec<_>) = per_street.into_iter().unzip();
    (heads.concat(), tails.concat())
}

fn drive(plan: &Traffic, street: &Street, seed: u64) -> (Vec<Shape>, Vec<Shape>) {
    // Half-angles of the beam and dip of its axis: about those of a low beam.
    let (cos_inner, cos_outer) = (round::cosine(6.0), round::cosine(22.0));
    let beam = round::light(black_body(4_300.0), plan.headlight / f64::from(cone_flux(cos_inner, cos_outer)));
    let red = round::light(Vec3::new(1.0, 0.03, 0.02), plan.tail_light);
    let mut stream = Stream::keyed(&[seed, Tag::Traffic as u64, street.number]);
    let (mut heads, mut tails) = (Vec::new(), Vec::new());
    for forwards in [true, false] {
        let count = (0.5 * street.length() * plan.per_km / 1000.0 + stream.uniform64()).floor();
        let room = street.length() / count;
        let ahead = if forwards { 1.0 } else { -1.0 };
        // Driving along +y the right side is +x; along +x it is -y.
        let right = if street.along_y { ahead } else { -ahead };
        let lane = 0.5 * (street.low + street.high) + 0.25 * street.width() * right;
        let axis = round::unit(street.place(ahead, 0.0).extend(-0.03));
        for k in 0..count as u64 {
            let middle = street.ends[0] + (k as f64 + stream.uniform64()) * room;
            for side in [-HALF[0], HALF[0]] {
                let at = |along: f64, z: f64| -> Vec3 {
                    let place: DVec3 = street.place(middle + along * ahead, lane + side).extend(z);
                    round::position(place)
                };
                heads.push(Shape::Spot { position: at(HALF[1], 0.65), axis, intensity: beam, cos_inner, cos_outer });
                tails.push(Shape::Point { position: at(-HALF[1], 0.85), intensity: red });
            }
        }
    }
    (heads, tails)
}
