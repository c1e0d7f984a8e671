//! Which point of a triangle does a uniform point of the square stand for, all of the area alike?

/// Barycentric weights `(b1, b2)` of the second and third corner for a uniform point on a triangle; `u` in `[0, 1)^2`.
///
/// The map that folds the square along a diagonal (Heitz 2019), which tears nothing, gave 0.5 to 1.5 times the error of this
/// one with R2's points under lights of 30 cm to 3 m, and was no better on the whole.
///
/// Source: the lecture's map, `1 - sqrt(u)` for the first corner (Turk, Graphics Gems, 1990).
#[inline]
pub(crate) fn uniform_point(u: [f32; 2]) -> [f32; 2] {
    let root = u[0].sqrt();
    [root * (1.0 - u[1]), root * u[1]]
}

/// What [`uniform_point`] takes to the centroid.
pub(crate) const CENTROID: [f32; 2] = [4.0 / 9.0, 0.5];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    #[test]
    fn the_centroid_is_a_third_of_each_corner() {
        uniform_point(CENTROID).into_iter().for_each(|b| assert!((b - 1.0 / 3.0).abs() < 1e-6, "{b}"));
    }

    #[test]
    fn points_are_uniform_over_the_four_midpoint_triangles() {
        let mut stream = Stream::keyed(&[11]);
        let mut counts = [0u32; 4];
        for _ in 0..40_000 {
            let [b1, b2] = uniform_point(stream.uniform2());
            let b0 = 1.0 - b1 - b2;
            assert!(b0 >= 0.0 && b1 >= 0.0 && b2 >= 0.0, "{b0}, {b1}, {b2}");
            counts[[b0, b1, b2].iter().position(|&b| b > 0.5).unwrap_or(3)] += 1;
        }
        let chi2: f64 = counts.iter().map(|&c| (f64::from(c) - 1e4).powi(2) / 1e4).sum();
        assert!(chi2 < 21.1, "chi-squared {chi2}, limit 21.1 (3 degrees of freedom, 1e-4), seed 11");
    }
}
