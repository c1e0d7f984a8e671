//! How near does a triangle come to a point?

use glam::Vec3;

/// Squared distance of a triangle from the origin; `corner` is one of its corners, `a` and `b` are the edges from there.
///
/// f32 is enough for what it decides: a rounding of `corner` is carried over and no more.
///
/// Source: by the regions of the plane about a triangle, Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
#[inline]
pub(crate) fn nearest_squared(corner: Vec3, a: Vec3, b: Vec3) -> f32 {
    let to_edge = |from: Vec3, edge: Vec3| {
        let along = (-from.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        // An edge without length is its corner.
        (from + edge * if along.is_nan() { 0.0 } else { along }).length_squared()
    };
    let c = a.cross(b);
    // The foot of the origin on the plane, by its barycentric weights times `c^2`.
    let (u, v) = (b.cross(corner).dot(c), corner.cross(a).dot(c));
    let area = c.length_squared();
    if u >= 0.0 && v >= 0.0 && u + v <= area && area > 0.0 {
        return (corner.dot(c) / area.sqrt()).powi(2);
    }
    to_edge(corner, a).min(to_edge(corner, b)).min(to_edge(corner + a, b - a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    #[test]
    fn no_point_of_a_grid_is_nearer_and_one_is_as_near() {
        let mut rng = Stream::keyed(&[31]);
        for _ in 0..300 {
            let mut any = || Vec3::from([rng.uniform(), rng.uniform(), rng.uniform()]) * 2.0 - 1.0;
            let (corner, a, b) = (any(), any(), any());
            let n = 200;
            let points = (0..=n).flat_map(|i| (0..=n - i).map(move |j| (i as f32 / n as f32, j as f32 / n as f32)));
            let least = points.map(|(s, t)| (corner + a * s + b * t).length_squared()).fold(f32::INFINITY, f32::min);
            let found = nearest_squared(corner, a, b);
            let step = a.length().max(b.length()) / n as f32;
            assert!(found <= least * 1.001 + 1e-6 && found.sqrt() >= least.sqrt() - step, "{found} {least}");
        }
    }

    #[test]
    fn slivers_and_points_have_a_distance() {
        let (x, y) = (Vec3::X, Vec3::Y);
        assert_eq!(nearest_squared(y - x, 2.0 * x, x), 1.0);
        assert_eq!(nearest_squared(y, Vec3::ZERO, Vec3::ZERO), 1.0);
        assert_eq!(nearest_squared(Vec3::ZERO, x, y), 0.0);
    }
}
