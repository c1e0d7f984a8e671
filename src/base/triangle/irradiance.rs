//! How much light does a triangle of unit radiance send to a receiver?

use super::angles::{DEFECT_LIMIT, arctan_defect, arctan2};
use super::seen::{Seen, edge_normal};
use glam::DVec3;

/// A part of a triangle that lies above the horizon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) seen: Seen,
    /// Barycentric weights of the part's corners within the whole triangle: of its second and its third corner.
    pub(super) weights: [[f64; 2]; 3],
}

/// A corner of a triangle that the horizon cuts.
struct Corner {
    at: DVec3,
    length: f64,
    height: f64,
    weights: [f64; 2],
}

impl Corner {
    /// Where the edge to a corner on the other side crosses the horizon, and the weights there.
    fn crossing(&self, to: &Self, normal: DVec3) -> (DVec3, [f64; 2]) {
        let drop = self.height - to.height;
        let t = (self.height / drop).clamp(0.0, 1.0);
        // By the line in which horizon and edge's plane meet: a mixture of corners would be off by their rounding, and
        // so turn the edge when it passes close to the receiver.
        let at = edge_normal(self.at, to.at, self.length, to.length).cross(normal) / drop;
        (at, [0, 1].map(|i| self.weights[i] + t * (to.weights[i] - self.weights[i])))
    }
}

impl Seen {
    /// Irradiance in units of the triangle's radiance, of a Lambertian triangle that shines to both sides, clipped at
    /// the receiver's horizon: within `[0, π]`. `normal` is the receiver's, of unit length.
    ///
    /// Error below 1e-14, and below 1e-13 of the value but for a plane or a horizon that is grazed, whatever the
    /// distance.
    ///
    /// Source: Lambert, Photometria, 1760; Baum, Rushmeier and Winget, SIGGRAPH 1989, eq. 13.
    #[inline]
    pub(crate) fn irradiance(&self, normal: DVec3) -> f64 {
        if self.corners.iter().all(|corner| normal.dot(*corner) >= 0.0) {
            return self.whole(normal).abs();
        }
        let (parts, count) = self.above(normal);
        parts[..count].iter().map(|part| part.seen.whole(normal).abs()).sum()
    }

    /// Its parts above the horizon, and how many there are: up to two.
    ///
    /// A triangle cut twice leaves a quadrangle, which is taken as two triangles: both add light, so nothing cancels.
    pub(super) fn above(&self, normal: DVec3) -> ([Part; 2], usize) {
        const WHOLE: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let [a, b, c] = self.corners;
        let [la, lb, lc] = self.lengths;
        let heights = self.corners.map(|corner| normal.dot(corner));
        let all = Part { seen: *self, weights: WHOLE };
        let part = |weights: [[f64; 2]; 3], corners| Part { seen: Seen::new(corners), weights };
        let up = heights.map(|height| height >= 0.0);
        // The corner that is alone on its side of the horizon, the others following in order.
        let first = match up {
            [true, true, true] => return ([all, all], 1),
            [false, false, false] => return ([all, all], 0),
            [x, y, z] if y == z && x != y => 0,
            [x, y, z] if z == x && y != z => 1,
            _ => 2,
        };
        let corner = |i: usize| Corner {
            at: [a, b, c][i % 3],
            length: [la, lb, lc][i % 3],
            height: heights[i % 3],
            weights: WHOLE[i % 3],
        };
        let (alone, next, last) = (corner(first), corner(first + 1), corner(first + 2));
        let ((p, p_weights), (q, q_weights)) = (alone.crossing(&next, normal), alone.crossing(&last, normal));
        if up[first] {
            let tip = part([alone.weights, p_weights, q_weights], [alone.at, p, q]);
            ([tip, tip], 1)
        } else {
            let upper = part([next.weights, last.weights, q_weights], [next.at, last.at, q]);
            let lower = part([next.weights, q_weights, p_weights], [next.at, q, p]);
            ([upper, lower], 2)
        }
    }

    /// Irradiance of a triangle wholly above the horizon, signed as its solid angle.
    #[inline]
    pub(super) fn whole(&self, normal: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        let [la, lb, lc] = self.lengths;
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let (nab, nbc, nca) = (edge_normal(a, b, la, lb), edge_normal(b, c, lb, lc), edge_normal(c, a, lc, la));
        let (kab, kbc, kca) = (la * lb + a.dot(b), lb * lc + b.dot(c), lc * la + c.dot(a));
        // Squared tangents of half the edges' angles.
        let (nab2, nbc2, nca2) = (nab.length_squared(), nbc.length_squared(), nca.length_squared());
        let near = |n2: f64, k: f64| k > 0.0 && n2 <= DEFECT_LIMIT * k * k;
        // The differences keep their digits among corners of like distance.
        let like = la.max(lb).max(lc) <= 4.0 * la.min(lb).min(lc);
        if like && near(nab2, kab) && near(nbc2, kbc) && near(nca2, kca) {
            // With w = angle / |edge normal| the irradiance is half the sum of w n·(edge normal). The edge normals
            // nearly cancel, so what they sum to, the triangle's own normal, is taken out at the first edge's w; the
            // rest are small differences, each written so that it keeps its digits.
            let own = normal.dot(ab.cross(-ca));
            let (inverse_ab, inverse_bc, inverse_ca) = (1.0 / kab, 1.0 / kbc, 1.0 / kca);
            let defect = |n2: f64, inverse: f64| inverse * arctan_defect(n2 * (inverse * inverse));
            let (dab, dbc, dca) = (defect(nab2, inverse_ab), defect(nbc2, inverse_bc), defect(nca2, inverse_ca));
            // |a|-|c| and |b|-|c|
            let (la_lc, lb_lc) = (ca.dot(a + c) / (la + lc), -bc.dot(b + c) / (lb + lc));
            let wbc_wab = (lb * la_lc + b.dot(ca)) * (inverse_ab * inverse_bc) - dbc + dab;
            let wca_wab = (la * lb_lc - a.dot(bc)) * (inverse_ab * inverse_ca) - dca + dab;
            return own * (inverse_ab - dab) + normal.dot(nbc) * wbc_wab + normal.dot(nca) * wca_wab;
        }
        let edge = |n: DVec3, n2: f64, dot: f64| {
            let length = n2.sqrt();
            if length > 0.0 { normal.dot(n) * (arctan2(length, dot) / length) } else { 0.0 }
        };
        0.5 * (edge(nab, nab2, a.dot(b)) + edge(nbc, nbc2, b.dot(c)) + edge(nca, nca2, c.dot(a)))
    }
}
