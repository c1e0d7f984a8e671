//! What of a convex polygon lies on one side of a line or a plane?

use std::ops::{Add, Mul, Sub};

/// What of a convex polygon lies where `height`, linear over it, is at least 0; its corners in their order.
///
/// Source: Sutherland and Hodgman, "Reentrant polygon clipping", CACM 17(1), 1974.
pub(crate) fn above<V>(polygon: &[V], height: impl Fn(V) -> f64) -> Vec<V>
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<f64, Output = V>,
{
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &here) in polygon.iter().enumerate() {
        let next = polygon[(i + 1) % polygon.len()];
        let (mine, its) = (height(here), height(next));
        if mine >= 0.0 {
            kept.push(here);
        }
        if (mine >= 0.0) != (its >= 0.0) {
            kept.push(here + (next - here) * (mine / (mine - its)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn a_square_is_cut_to_a_triangle_to_itself_and_to_nothing() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let corner = above(&square, |p| p.x + p.y - 1.5);
        assert_eq!(corner, [DVec2::new(1.0, 0.5), DVec2::ONE, DVec2::new(0.5, 1.0)]);
        assert_eq!(above(&square, |p| p.x), square);
        assert!(above(&square, |p| p.x - 2.0).is_empty());
    }
}
