//! Which point of a triangle is uniform over what a receiver sees of it?

use super::angles::sine;
use super::seen::{Seen, edge_normal, openness};
use glam::DVec3;

/// Points on a triangle, uniform over its solid angle.
///
/// The density is `1 / solid_angle()` per steradian. No term of the map is a difference: it keeps its digits from triangles
/// of 1e-30 sr to one that fills half the sphere, in one form without a switch. (Girard's sum of three angles less π, which
/// earlier maps start from, has none left below 1e-12 sr, nor in slivers.)
///
/// With half-angles: of the triangle `(a, b, q)`, q at the share s of the way from a to c, the solid angle ω has
/// `tan(ω/2) = s a·(b×c) / D`, where D is the denominator of Van Oosterom and Strackee. As |q|² is quadratic in s, this can be
/// solved for s; both then and along the arc from b to q the half-angle forms leave sums of positive terms alone.
///
/// Source: the idea of cutting a sub-triangle by solid angle, then an arc by height: Arvo, SIGGRAPH 1995. The form: derived
/// here.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolidAngle {
    seen: Seen,
    solid_angle: f64,
    /// `|a||c| + a·c`.
    opening: f64,
    /// `hypot(numerator, denominator) / (|a||b| + a·b)` of the solid angle's tangent.
    ratio: f64,
}

impl SolidAngle {
    /// A sampler; `None` where the solid angle is 0.
    #[inline]
    pub(crate) fn new(seen: &Seen) -> Option<Self> {
        let solid_angle = seen.solid_angle().abs();
        let [a, b, c] = seen.corners;
        let [la, lb, lc] = seen.lengths;
        let between = |p: DVec3, q: DVec3, lp: f64, lq: f64| openness(p, q, lp, lq, edge_normal(p, q, lp, lq));
        let (ab, bc, ca) = (between(a, b, la, lb), between(b, c, lb, lc), between(c, a, lc, la));
        // numerator^2 + denominator^2 = 2 (|a||b| + a·b) (|b||c| + b·c) (|c||a| + c·a).
        let ratio = (2.0 * bc * ca / ab).sqrt();
        (solid_angle > 0.0 && ratio.is_finite()).then_some(Self { seen: *seen, solid_angle, opening: ca, ratio })
    }

    /// The unsigned solid angle in steradians, as [`Seen::solid_angle`] gives it: one over the density.
    #[inline]
    pub(crate) fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Barycentric weights of the second and third corner of the point for `u` in `[0, 1)^2`.
    #[inline]
    pub(crate) fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        let share = self.share(u[0]);
        let [a, b, c] = self.seen.corners;
        let end = a + (c - a) * share;
        let [rest, towards] = self.ways(end, b, self.seen.lengths[1], u[1]);
        [rest, towards * share]
    }

    /// How far from the first corner towards the third the triangle is cut for the share `u` of its solid angle.
    #[inline(always)]
    pub(super) fn share(&self, u: f64) -> f64 {
        let [la, _, lc] = self.seen.lengths;
        let half = 0.5 * self.solid_angle;
        let (inside, outside) = (sine(half * u), self.ratio * sine(half - half * u));
        let part = 2.0 * inside * (self.opening * inside + la * outside);
        let whole = 2.0 * inside * (self.opening * inside + (la + lc) * outside) + outside * outside;
        (part / (whole + f64::MIN_POSITIVE)).min(1.0)
    }

    /// How far from `b` towards `end` the point lies for the share `v` of the arc's zone, after what is left to 1: next to a
    /// corner at the receiver, one of the two is tiny and needs all its digits.
    #[inline(always)]
    fn ways(&self, end: DVec3, b: DVec3, lb: f64, v: f64) -> [f64; 2] {
        // The end can round onto the receiver; any direction is then as good as another.
        let length = end.length().max(1e-150);
        let opposite = openness(b, end, lb, length, edge_normal(b, end, lb, length)) / (2.0 * lb * length);
        // Cosine and squared sine of half the arc; of half its part the sine is root(v) times the arc's.
        let (cos, sin2) = (opposite.sqrt(), (1.0 - opposite).max(0.0));
        let root = v.sqrt();
        let part_cos = (1.0 - v * sin2).sqrt();
        // The law of sines in the plane of the arc, all divided by the sine of its half.
        let beyond = length * (1.0 - v) * (cos * part_cos + root * sin2);
        let within = lb * root * part_cos * (part_cos + root * cos);
        // The smallest number: an arc of exactly π has neither at v = 0.
        let inverse = 1.0 / (beyond + within + f64::MIN_POSITIVE);
        [beyond * inverse, within * inverse]
    }
}
