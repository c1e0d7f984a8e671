//! Where do the street lamps hang?
//!
//! In straight rows along every street, over the carriageway: one row in narrow streets, two in wider ones, opposite
//! or staggered. The lamps of a row are exactly collinear, of equal height and equal power.

use super::fields::{Fields, Plan};
use super::layout::{Layout, Street};
use super::round;
use super::tag::Tag;
use crate::base::colour::black_body;
use crate::base::error::Result;
use crate::base::random::Stream;
use crate::scene::light::{Shape, cone_flux};
use glam::Vec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// What a lamp is made as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LampKind {
    /// A spot that shines straight down, nothing at or above the horizon: full cut-off.
    Spot,
    /// A bare point.
    Point,
}

/// Street lamps.
#[derive(Clone, Debug)]
pub struct Lamps {
    /// Spots or bare points.
    pub kind: LampKind,
    /// Distance along the street in m.
    pub spacing: f64,
    /// Height above the carriageway in m.
    pub height: f64,
    /// How far the arm reaches over the carriageway, in m from the kerb.
    pub arm: f64,
    /// Least and greatest luminous flux in lm; each street draws its own.
    pub flux: [f64; 2],
    /// Least and greatest colour temperature in K; each street draws its own.
    pub kelvin: [f64; 2],
    /// Half-angle of full intensity in degrees; spots only.
    pub inner: f64,
    /// Half-angle beyond which nothing shines, in degrees; spots only.
    pub outer: f64,
    /// Streets at least this wide, in m, have two rows.
    pub two_rows_from: f64,
}

impl Default for Lamps {
    fn default() -> Self {
        Self {
            kind: LampKind::Spot,
            spacing: 30.0,
            height: 9.0,
            arm: 1.5,
            flux: [5_000.0, 9_000.0],
            kelvin: [2_200.0, 4_000.0],
            inner: 30.0,
            outer: 75.0,
            two_rows_from: 18.0,
        }
    }
}

impl Plan for Lamps {
    fn visit(&mut self, f: &mut dyn Fields) -> Result<()> {
        let mut kind = self.kind as usize;
        f.choice("kind", &mut kind, &["spot", "point"])?;
        self.kind = if kind == 0 { LampKind::Spot } else { LampKind::Point };
        f.number("spacing", &mut self.spacing, 5.0..=500.0, "metres")?;
        f.number("height", &mut self.height, 2.0..=40.0, "metres")?;
        f.number("arm", &mut self.arm, 0.0..=3.0, "metres")?;
        f.span("flux", &mut self.flux, 1.0..=1e6, "lumens")?;
        f.span("kelvin", &mut self.kelvin, 1_700.0..=15_000.0, "kelvin")?;
        // A narrower ramp than a degree would lose its shape to the rounding of the cosines.
        f.number("outer", &mut self.outer, 5.0..=89.0, "degrees")?;
        f.number("inner", &mut self.inner, 0.0..=self.outer - 1.0, "degrees, and below `outer`")?;
        f.number("two_rows_from", &mut self.two_rows_from, 0.0..=1e3, "metres")
    }
}

pub(super) fn place(plan: &Lamps, layout: &Layout, seed: u64) -> Vec<Shape> {
    layout.streets().par_iter().flat_map_iter(|street| rows(plan, street, seed)).collect()
}

fn rows(plan: &Lamps, street: &Street, seed: u64) -> Vec<Shape> {
    let mut stream = Stream::keyed(&[seed, Tag::Lamps as u64, street.number]);
    let kelvin = (round::uniform(plan.kelvin, stream.uniform64()) / 100.0).round() * 100.0;
    let shape = lamp(plan, black_body(kelvin as f32), round::log_uniform(plan.flux, stream.uniform64()));
    let spacing = round::metres(plan.spacing);
    let first = round::metres(spacing * stream.uniform64());
    let staggered = stream.uniform64() < 0.5;
    // At most the middle of the street.
    let arm = round::metres(plan.arm.min(0.5 * street.width()));
    let other = if staggered { round::metres((first + 0.5 * spacing) % spacing) } else { first };
    let mut rows = vec![(street.low + arm, first), (street.high - arm, other)];
    // Two arms that reach the middle would put lamp on lamp.
    if street.width() < plan.two_rows_from.max(2.0 * arm + 1.0) {
        rows.swap_remove(stream.below(2));
    }
    let z = round::metres(plan.height);
    rows.iter()
        .flat_map(|&(across, first)| {
            let count = ((street.length() - first) / spacing).floor().max(-1.0) as i64 + 1;
            (0..count).map(move |k| (across, first + k as f64 * spacing))
        })
        .map(|(across, along)| shape(round::position(street.place(street.ends[0] + along, across).extend(z))))
        .collect()
}

/// A lamp of `flux` lm, to be put somewhere.
fn lamp(plan: &Lamps, colour: Vec3, flux: f64) -> impl Fn(Vec3) -> Shape + use<> {
    let kind = plan.kind;
    let (cos_inner, cos_outer) = (round::cosine(plan.inner), round::cosine(plan.outer));
    let intensity = match kind {
        LampKind::Spot => round::light(colour, flux / f64::from(cone_flux(cos_inner, cos_outer))),
        LampKind::Point => round::light(colour, flux / (4.0 * PI)),
    };
    move |position| match kind {
        LampKind::Spot => Shape::Spot { position, axis: Vec3::NEG_Z, intensity, cos_inner, cos_outer },
        LampKind::Point => Shape::Point { position, intensity },
    }
}
