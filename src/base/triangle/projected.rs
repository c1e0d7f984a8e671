//! Which point of a triangle is drawn in proportion to the light that it sends to a receiver?

use super::angles::{angle_minus_sine, arctan2};
use super::irradiance::Part;
use super::seen::{Seen, edge_normal};
use super::solid_angle::SolidAngle;
use glam::DVec3;

/// Points on a triangle, by their cosine to the receiver's normal over the solid angle; none below the horizon.
///
/// The density is `cos / irradiance()` per steradian, so that all points of an unshadowed Lambertian light weigh the
/// same. As there is no closed form for the map, the one for the plain solid angle ([`SolidAngle`]) is corrected by
/// Newton's steps, each held within a bracket: the distribution functions rise, so the root is found from anywhere. A
/// part's irradiance comes from the same code as the whole's.
///
/// Source: the two steps: Arvo, SIGGRAPH 2001 course 29, "Stratified sampling of spherical triangles"; the density:
/// Lambert, 1760.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projected {
    parts: [Piece; 2],
    count: usize,
    irradiance: f64,
    normal: DVec3,
}

/// A part above the horizon, ready to be drawn from.
#[derive(Clone, Copy, Debug)]
struct Piece {
    part: Part,
    by_angle: SolidAngle,
    irradiance: f64,
    /// `|a·(b×c)|`.
    triple: f64,
}

/// In each of these the error halves, or else the interval that holds the root, until 1e-12 is left; Newton's steps
/// take three to six.
const STEPS: usize = 120;

impl Projected {
    /// A sampler for a receiver's unit normal; `None` where no light arrives.
    pub(crate) fn new(seen: &Seen, normal: DVec3) -> Option<Self> {
        let (parts, count) = seen.above(normal);
        let piece = |part: &Part| {
            let irradiance = part.seen.whole(normal).abs();
            let by_angle = SolidAngle::new(&part.seen).filter(|_| irradiance > 0.0)?;
            // By way of the steradians at the first corner, which keep their digits where the product itself would
            // cancel: next to a corner at the receiver it would be off by orders of magnitude.
            let [la, _, _] = part.seen.lengths;
            let triple = part.seen.steradians_per_area([0.0; 2]) * (la * la * la);
            Some(Piece { part: *part, by_angle, irradiance, triple })
        };
        // Parts that add nothing are left out: a corner or an edge that touches the horizon.
        let mut pieces = parts[..count].iter().filter_map(piece);
        let first = pieces.next()?;
        let (second, count) = pieces.next().map_or((first, 1), |second| (second, 2));
        let irradiance = if count == 2 { first.irradiance + second.irradiance } else { first.irradiance };
        Some(Self { parts: [first, second], count, irradiance, normal })
    }

    /// The irradiance for unit radiance, as [`Seen::irradiance`] gives it: the density per steradian is the cosine over
    /// it.
    #[inline]
    pub(crate) fn irradiance(&self) -> f64 {
        self.irradiance
    }

    /// Barycentric weights of the second and third corner of the point for `u` in `[0, 1)^2`.
    pub(crate) fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        let target = u[0] * self.irradiance;
        let [first, second] = &self.parts;
        if self.count == 1 || target < first.irradiance {
            first.sample(target, u[1], self.normal)
        } else {
            second.sample(target - first.irradiance, u[1], self.normal)
        }
    }
}

impl Piece {
    /// The point where the part cut off has the irradiance `target`, and that within its last arc has the share `v`.
    fn sample(&self, target: f64, v: f64, normal: DVec3) -> [f64; 2] {
        let Seen { corners: [a, b, c], lengths: [la, lb, _] } = self.part.seen;
        let to_c = c - a;
        let cut = |share: f64| {
            let end = a + to_c * share;
            let length = end.length();
            let part = Seen { corners: [a, b, end], lengths: [la, lb, length] };
            // Turning by a radian about b adds half the arc's integral; this is by how much the end turns for each
            // share.
            let arc = Arc::new(normal, (b, lb), (end, length));
            let turn = self.triple * lb / arc.edge_normal2;
            (part.whole(normal).abs(), 0.5 * arc.integral(arc.angle).0 * turn)
        };
        let share = root(target, self.irradiance, self.by_angle.share((target / self.irradiance).min(1.0)), 1.0, cut);
        let end = a + to_c * share;
        let length = end.length();
        let arc = Arc::new(normal, (b, lb), (end, length));
        let total = arc.integral(arc.angle).0;
        let guess = 2.0 * (v.sqrt() * (0.5 * arc.angle).sin()).min(1.0).asin();
        let angle = root(v * total, total, guess, arc.angle, |angle| arc.integral(angle));
        // The law of sines in the arc's plane.
        let (within, beyond) = (lb * angle.sin().max(0.0), length * (arc.angle - angle).sin().max(0.0));
        let inverse = 1.0 / (within + beyond);
        let [rest, towards] = if inverse.is_finite() { [beyond * inverse, within * inverse] } else { [1.0, 0.0] };
        let [wa, wb, wc] = self.part.weights;
        [0, 1].map(|i| wb[i] * rest + (wa[i] * (1.0 - share) + wc[i] * share) * towards)
    }
}

/// Where within `[0, high]` a rising function takes the value `target`, up to rounding; `function` gives value and
/// derivative, `total` is its value at `high`.
#[inline]
fn root(target: f64, total: f64, guess: f64, high: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut above) = (0.0, high);
    let (mut at, mut before) = (guess.clamp(0.0, high), f64::INFINITY);
    for _ in 0..STEPS {
        let (value, slope) = function(at);
        let off = value - target;
        if off.abs() <= 4e-16 * total {
            break;
        }
        if off > 0.0 {
            above = at;
        } else {
            low = at;
        }
        let newton = at - off / slope;
        // A step that leaves the bracket, or a function too flat or too curved for Newton's: halve.
        // Once only rounding is left, nothing halves.
        let helps = off.abs() <= (0.5 * before).max(1e-12 * total);
        let next = if newton > low && newton < above && helps { newton } else { 0.5 * (low + above) };
        before = off.abs();
        if (next - at).abs() <= 1e-16 * high || next <= low || next >= above {
            return next.clamp(low, above);
        }
        at = next;
    }
    at
}

/// The cosine to a normal along an arc that starts at a pole: `at_pole cos(angle) + at_right sin(angle)`.
#[derive(Clone, Copy, Debug)]
struct Arc {
    at_pole: f64,
    at_right: f64,
    angle: f64,
    /// Squared length of pole x end.
    edge_normal2: f64,
}

impl Arc {
    /// From one point to another, each with its distance.
    fn new(normal: DVec3, pole: (DVec3, f64), end: (DVec3, f64)) -> Self {
        let edge_normal = edge_normal(pole.0, end.0, pole.1, end.1);
        let length = edge_normal.length();
        let at_pole = normal.dot(pole.0) / pole.1;
        let at_right = if length > 0.0 { normal.dot(edge_normal.cross(pole.0)) / (length * pole.1) } else { 0.0 };
        Self { at_pole, at_right, angle: arctan2(length, pole.0.dot(end.0)), edge_normal2: length * length }
    }

    /// Twice the integral of cosine times sine from the pole to an angle (the light of a narrow wedge there, per radian
    /// of its width), and its derivative.
    #[inline]
    fn integral(&self, angle: f64) -> (f64, f64) {
        let (sin, cos) = angle.sin_cos();
        let integral = self.at_pole * sin * sin + self.at_right * 0.5 * angle_minus_sine(2.0 * angle);
        (integral, 2.0 * sin * (self.at_pole * cos + self.at_right * sin))
    }
}
