//! How large does a triangle look?

use super::angles::arctan2;
use crate::base::double_double::DoubleDouble;
use glam::DVec3;

/// A triangle as a receiver sees it that is at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    pub(super) corners: [DVec3; 3],
    /// Distances of the corners.
    pub(super) lengths: [f64; 3],
}

impl Seen {
    /// A triangle from its corners relative to the receiver, each of its coordinates 0 or within about 1e-45 to 1e38 in
    /// magnitude, the range of f32.
    #[inline]
    pub(crate) fn new(corners: [DVec3; 3]) -> Self {
        Self { corners, lengths: corners.map(DVec3::length) }
    }

    /// Signed solid angle in steradians, within `[-2π, 2π]`.
    ///
    /// Positive when `a·(b×c) > 0`: with counter-clockwise fronts, when the receiver is *behind* the triangle. A triangle without area,
    /// and one whose plane holds the receiver exactly, gives 0: it is seen from neither side.
    ///
    /// Relative error below 1e-7, for a usual triangle below 1e-12, at any distance. The numerator is written in edge form, `a·((b−a)×(c−a))`: the triple product loses all digits once the triangle is small against its
    /// distance. Where even this cancels (slivers, grazing planes, a corner or an edge at the receiver), it is taken again in twice the digits.
    ///
    /// Source: Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983, eq. 8.
    #[inline(always)]
    pub(crate) fn solid_angle(&self) -> f64 {
        match self.tangent() {
            Some((triple, denominator)) => signed_angle(triple, denominator),
            // Of a copy: what is called for by reference is kept in memory on the other way as well, at 11 ns.
            None => angle_of_more_digits(self.corners),
        }
    }

    /// Numerator and denominator of the tangent of half the solid angle: `a·(b×c)` and the printed denominator; `None` where
    /// either cancels.
    #[inline(always)]
    fn tangent(&self) -> Option<(f64, f64)> {
        let [a, b, c] = self.corners;
        let [la, lb, lc] = self.lengths;
        let (to_b, to_c) = (b - a, c - a);
        let triple = a.dot(to_b.cross(to_c));
        let la_lb = la * lb;
        let product = la_lb * lc;
        let denominator = (la_lb + a.dot(b)) * lc + (a.dot(c) * lb + b.dot(c) * la);
        // Rounding leaves errors of a few 1e-16 of these products: up to a hundred-millionth may be wrong.
        let rounded = (1.6e-15 * (la * la)) * (to_b.length_squared() * to_c.length_squared());
        let cancelled =
            triple * triple <= rounded || triple * triple + denominator * denominator <= 1e-15 * (product * product);
        (!cancelled).then_some((triple, denominator))
    }

    /// The point of barycentric weights `(b1, b2)` of the second and third corner, relative to the receiver.
    #[inline]
    pub(crate) fn point(&self, [b1, b2]: [f64; 2]) -> DVec3 {
        let [a, b, c] = self.corners;
        a * (1.0 - b1 - b2) + b * b1 + c * b2
    }

    /// Steradians for each unit of barycentric area `db1 db2` at a point: what turns a density per steradian into one
    /// over the barycentric weights. Infinite at a point that lies at the receiver.
    #[inline]
    pub(crate) fn steradians_per_area(&self, at: [f64; 2]) -> f64 {
        // Twice the area times the distance of the plane, over the cubed distance of the point.
        let distance2 = self.point(at).length_squared();
        let (triple, _) = self.tangent().unwrap_or_else(|| tangent_of_more_digits(self.corners));
        triple.abs() / (distance2 * distance2.sqrt())
    }
}

/// The angle whose half has this tangent, with the sign of the numerator.
#[inline(always)]
fn signed_angle(triple: f64, denominator: f64) -> f64 {
    (2.0 * arctan2(triple.abs(), denominator)).copysign(triple)
}

/// Signed solid angle by 31 digits.
#[cold]
#[inline(never)]
fn angle_of_more_digits(corners: [DVec3; 3]) -> f64 {
    let (triple, denominator) = tangent_of_more_digits(corners);
    signed_angle(triple, denominator)
}

/// Numerator and denominator by 31 digits: both 0 where the numerator is 0.
#[cold]
#[inline(never)]
fn tangent_of_more_digits(corners: [DVec3; 3]) -> (f64, f64) {
    let [a, b, c] = corners.map(|corner| corner.to_array().map(DoubleDouble::from));
    let minus = |p: [DoubleDouble; 3], q: [DoubleDouble; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let triple = DoubleDouble::dot(a, DoubleDouble::cross(minus(b, a), minus(c, a))).high;
    // Exactly in the plane, or no triangle at all: there is no side to see it from.
    if triple == 0.0 {
        return (0.0, 0.0);
    }
    let length = |p| DoubleDouble::dot(p, p).sqrt();
    let (la, lb, lc) = (length(a), length(b), length(c));
    let denominator =
        la * lb * lc + DoubleDouble::dot(a, b) * lc + DoubleDouble::dot(a, c) * lb + DoubleDouble::dot(b, c) * la;
    (triple, denominator.high)
}

/// `a×b` for two corners and their distances, of digits enough also where both lie on nearly one line with the receiver.
///
/// Written as the shorter one times the edge: far away two corners are nearly one vector, and of their own product too few digits
/// are left to say where the edge crosses the horizon.
#[inline(always)]
pub(super) fn edge_normal(a: DVec3, b: DVec3, la: f64, lb: f64) -> DVec3 {
    let edge = b - a;
    let (short, length) = if la <= lb { (a, la) } else { (b, lb) };
    let normal = short.cross(edge);
    // Rounding leaves 1e-16 of this product, so that from here on fewer than eleven digits would be right.
    if normal.length_squared() <= 1e-10 * (length * length) * edge.length_squared() {
        return normal_of_more_digits(a, b);
    }
    normal
}

/// `a×b`, each component to 16 digits of the vector's length.
#[cold]
fn normal_of_more_digits(a: DVec3, b: DVec3) -> DVec3 {
    let wide = |p: DVec3| p.to_array().map(DoubleDouble::from);
    DVec3::from_array(DoubleDouble::cross(wide(a), wide(b)).map(|component| component.high))
}

/// `|a||b| + a·b`: 0 for corners on opposite sides of the receiver, and of all digits there too. `normal` is `a×b`.
#[inline(always)]
pub(super) fn openness(a: DVec3, b: DVec3, la: f64, lb: f64, normal: DVec3) -> f64 {
    let (product, dot) = (la * lb, a.dot(b));
    if dot >= 0.0 {
        product + dot
    } else {
        // The product of sum and difference is |a|^2 |b|^2 - (a·b)^2 = |a×b|^2.
        normal.length_squared() / (product - dot)
    }
}
