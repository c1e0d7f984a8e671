//! Which extremes are there?

use super::tally::{Finding, Tally, relative};
use super::triangles::{self, Draw, Posed};
use super::vectors::{AREALESS_LIMIT, IRRADIANCE_FLOOR, IRRADIANCE_LIMIT, SOLID_ANGLE_LIMIT};
use super::{bounds, choices, precise, reach, textbook, trees};
use crate::base::random::Stream;
use crate::base::triangle::SolidAngle;

/// An extreme case.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    /// Its name: what is computed and where.
    pub name: &'static str,
    /// What is hard about it, and in what the error is measured.
    pub what: &'static str,
    /// Tries it.
    pub run: fn() -> Finding,
}

/// All of them, in the order of the table.
pub(crate) const CASES: &[Case] = &[
    Case {
        name: "solid-angle/ordinary",
        what: "any sign, any size: the denominator is negative beyond pi",
        run: || solid_angle(triangles::ordinary),
    },
    Case {
        name: "solid-angle/distant",
        what: "down to 1e-10 sr: the triple product of the corners cancels",
        run: || solid_angle(triangles::distant),
    },
    Case {
        name: "solid-angle/sliver",
        what: "up to ten million times as long as wide",
        run: || solid_angle(triangles::sliver),
    },
    Case {
        name: "solid-angle/vertex",
        what: "a corner 1e-12 to 1e-4 of the size from the receiver",
        run: || solid_angle(triangles::vertex),
    },
    Case {
        name: "solid-angle/edge",
        what: "an edge 1e-12 to 1e-2 of the size from the receiver",
        run: || solid_angle(triangles::edge),
    },
    Case { name: "solid-angle/micro", what: "1e-16 to 1e-9 m large", run: || solid_angle(triangles::micro) },
    Case { name: "solid-angle/huge", what: "1e8 to 1e12 m large", run: || solid_angle(triangles::huge) },
    Case {
        name: "solid-angle/touching",
        what: "the receiver 1e-6 to 0.1 of the size from the plane",
        run: || solid_angle(triangles::touching),
    },
    Case {
        name: "solid-angle/grazing",
        what: "the receiver in the plane but for rounding",
        run: || solid_angle(triangles::grazing),
    },
    Case {
        name: "solid-angle/degenerate",
        what: "corners on a line but for rounding; error in sr",
        run: || solid_angle_of_no_area(triangles::degenerate),
    },
    Case {
        name: "solid-angle/repeated",
        what: "two corners are one; error in sr",
        run: || solid_angle_of_no_area(triangles::repeated),
    },
    Case { name: "irradiance/ordinary", what: "cut by the horizon or not", run: || irradiance(triangles::ordinary) },
    Case {
        name: "irradiance/distant",
        what: "down to 1e-10 sr: the edges' sum cancels; error of the value itself",
        run: || irradiance_itself(triangles::distant),
    },
    Case { name: "irradiance/sliver", what: "as above", run: || irradiance(triangles::sliver) },
    Case { name: "irradiance/vertex", what: "as above", run: || irradiance(triangles::vertex) },
    Case {
        name: "irradiance/edge",
        what: "an edge's direction turns by rounding",
        run: || irradiance(triangles::edge),
    },
    Case { name: "irradiance/micro", what: "products underflow in f32", run: || irradiance(triangles::micro) },
    Case { name: "irradiance/huge", what: "products overflow in f32", run: || irradiance(triangles::huge) },
    Case { name: "irradiance/touching", what: "as above", run: || irradiance(triangles::touching) },
    Case { name: "irradiance/grazing", what: "as above", run: || irradiance(triangles::grazing) },
    Case { name: "irradiance/degenerate", what: "as above", run: || irradiance(triangles::degenerate) },
    Case { name: "irradiance/repeated", what: "as above", run: || irradiance(triangles::repeated) },
    Case {
        name: "solid-angle-sample/ordinary",
        what: "how far the shares of the solid angle are from the numbers drawn by",
        run: || sample(triangles::ordinary),
    },
    Case { name: "solid-angle-sample/distant", what: "Girard's angle sum cancels", run: || sample(triangles::distant) },
    Case { name: "solid-angle-sample/sliver", what: "as above", run: || sample(triangles::sliver) },
    Case { name: "solid-angle-sample/vertex", what: "as above", run: || sample(triangles::vertex) },
    Case { name: "solid-angle-sample/edge", what: "arcs of nearly pi", run: || sample(triangles::edge) },
    Case { name: "solid-angle-sample/micro", what: "as above", run: || sample(triangles::micro) },
    Case { name: "solid-angle-sample/huge", what: "as above", run: || sample(triangles::huge) },
    Case {
        name: "solid-angle-sample/touching",
        what: "up to 2 pi: others give up and draw by area",
        run: || sample(triangles::touching),
    },
    Case { name: "solid-angle-sample/grazing", what: "as above", run: || sample(triangles::grazing) },
    Case {
        name: "choice/running-sum",
        what: "a million log-normal weights: in f32 small ones add nothing; relative error",
        run: choices::cumulative,
    },
    Case { name: "choice/alias-table", what: "the same; error over the mean probability", run: choices::alias },
    Case { name: "choice/uniform", what: "numbers that reach 1", run: choices::uniform },
    Case {
        name: "choice/stretched",
        what: "what is left of a number, at the edges of shares: 1 if it leaves [0, 1)",
        run: bounds::stretched,
    },
    Case {
        name: "light-tree/sum",
        what: "2000 lights over 18 orders of magnitude: probabilities' sum less 1",
        run: trees::sum,
    },
    Case {
        name: "light-tree/reach",
        what: "the same of three kinds, receivers at lights too: 1 for one that adds something and has no chance",
        run: trees::reach,
    },
    Case {
        name: "light-tree/far-apart",
        what: "as above, a quarter of them 1e18 m away: fourth powers are infinite",
        run: trees::far_apart,
    },
    Case {
        name: "light-tree/infinite",
        what: "as above, a quarter of them 3e38 m away: sizes are infinite, and NaN cast to a number is 0",
        run: trees::infinite,
    },
    Case { name: "light-tree/walk", what: "a pick's probability against the one told; relative", run: trees::walk },
    Case { name: "light-tree/dark", what: "all behind the horizon: probabilities' sum", run: trees::dark },
    Case {
        name: "light-tree/identical",
        what: "1, 2, 3 and 100,000 in one place: relative error of 1/n",
        run: trees::identical,
    },
    Case { name: "light-tree/boxes", what: "how far lights stick out, over the box", run: bounds::boxes },
    Case { name: "light-tree/directions", what: "the same in 16 bits", run: bounds::directions },
    Case { name: "light-tree/variance", what: "of 1/d^2, for splits: E[g^2] - E[g]^2 cancels", run: bounds::variance },
    Case {
        name: "contribution/point",
        what: "0, 1 um to 1000 km away, 1e-6 to 1e12 cd; over what a receiver that faces it gets",
        run: reach::point_light,
    },
    Case {
        name: "contribution/triangle",
        what: "by projected solid angle from 1e-3 to 1e4 of its size; over the exact value or 1e-7 pi",
        run: reach::triangle,
    },
    Case { name: "contribution/scaled", what: "2^k times the light, k from -20 to 39", run: reach::scaled },
    Case { name: "importance/point", what: "as for its contribution", run: reach::point_importance },
    Case { name: "spot/cone", what: "cones 1e-7 to 1 wide, about their edges; error in cosine", run: reach::cone },
    Case { name: "influence/radius", what: "squared, of 1e-6 to 1e12 cd; relative", run: reach::radius },
    Case { name: "influence/in-range", what: "next to the edge, over the radius", run: reach::in_range },
    Case { name: "influence/chance", what: "that a random range reaches; relative", run: reach::range_chance },
    Case {
        name: "influence/drawn-range",
        what: "r / sqrt(1 - u) for u at 0 and next to 1; squared, relative",
        run: reach::drawn_range,
    },
    Case {
        name: "offset/push",
        what: "0 to 1000 km from the origin: start above its surface, and how far beyond 4 units; in m",
        run: bounds::push,
    },
];

/// Triangles that each case tries.
const TRIED: usize = 4000;
/// Names the triangles.
const SEED: u64 = 4;

fn draws(draw: Draw) -> impl Iterator<Item = Posed> {
    let mut stream = Stream::keyed(&[SEED]);
    (0..TRIED).map(move |_| draw(&mut stream))
}

fn solid_angle(draw: Draw) -> Finding {
    solid_angles(draw, relative, SOLID_ANGLE_LIMIT)
}

fn solid_angle_of_no_area(draw: Draw) -> Finding {
    solid_angles(draw, |found, exact| (found - exact).abs(), AREALESS_LIMIT)
}

fn solid_angles(draw: Draw, off: fn(f64, f64) -> f64, limit: f64) -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    for posed in draws(draw) {
        let exact = precise::solid_angle(posed.coordinates());
        let found = posed.seen().solid_angle();
        ours.add(found, off(found, exact));
        let found = f64::from(textbook::solid_angle(posed.corners));
        theirs.add(found, off(found, exact));
    }
    Finding { ours, textbook: Some(theirs), limit }
}

fn irradiance(draw: Draw) -> Finding {
    irradiances(draw, |found, exact| (found - exact).abs() / exact.max(IRRADIANCE_FLOOR))
}

/// Of all that is no mere speck over the horizon, which is at the mercy of the last digits.
fn irradiance_itself(draw: Draw) -> Finding {
    irradiances(draw, |found, exact| if exact > 1e-20 { relative(found, exact) } else { (found - exact).abs() })
}

fn irradiances(draw: Draw, off: fn(f64, f64) -> f64) -> Finding {
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    for posed in draws(draw) {
        let exact = precise::irradiance(posed.coordinates(), posed.normal.as_dvec3().to_array());
        let found = posed.seen().irradiance(posed.normal.as_dvec3());
        ours.add_positive(found, off(found, exact));
        let found = f64::from(textbook::irradiance(posed.corners, posed.normal));
        theirs.add_positive(found, off(found, exact));
    }
    Finding { ours, textbook: Some(theirs), limit: IRRADIANCE_LIMIT }
}

/// Worst error of a share of the solid angle that is right: a histogram of 10^8 samples could not tell.
const SHARE_LIMIT: f64 = 1e-4;

/// By how much the shares of the solid angle before and along the cut differ from the two numbers that a point was drawn by.
fn sample(draw: Draw) -> Finding {
    let mut ours = Tally::default();
    let mut stream = Stream::keyed(&[SEED, 1]);
    for posed in draws(draw) {
        let Some(sampler) = SolidAngle::new(&posed.seen()) else { continue };
        let u = [stream.uniform64(), stream.uniform64()];
        let weights = sampler.sample(u);
        let [cut, along] = precise::shares(posed.coordinates(), weights);
        ours.add_positive(weights[0].min(weights[1]), (cut - u[0]).abs().max((along - u[1]).abs()));
    }
    Finding { ours, textbook: None, limit: SHARE_LIMIT }
}
