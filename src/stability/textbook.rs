//! What does the textbook's formula give in f32?
//!
//! As printed, in the precision of a GPU: to show what it costs, not to be used.

use glam::Vec3;
use std::array;

/// Solid angle of a triangle, signed as ours, by the triple product of its corners over the printed denominator.
///
/// Source: Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983, eq. 8.
pub(crate) fn solid_angle([a, b, c]: [Vec3; 3]) -> f32 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let numerator = a.dot(b.cross(c));
    let denominator = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    2.0 * numerator.atan2(denominator)
}

/// Irradiance of a triangle of unit radiance, clipped at the horizon: half the sum of arc cosines times edge normals.
///
/// Source: Lambert, Photometria, 1760; Baum, Rushmeier and Winget, SIGGRAPH 1989, eq. 13.
pub(crate) fn irradiance(corners: [Vec3; 3], normal: Vec3) -> f32 {
    let above: Vec<Vec3> = (0..3)
        .flat_map(|i| {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            let (h, k) = (normal.dot(from), normal.dot(to));
            let crossing = (h < 0.0) != (k < 0.0);
            [(h >= 0.0).then_some(from), crossing.then(|| from + (to - from) * (h / (h - k)))]
        })
        .flatten()
        .collect();
    let edges = (0..above.len()).map(|i| {
        let [from, to] = array::from_fn(|j| above[(i + j) % above.len()].normalize());
        from.dot(to).clamp(-1.0, 1.0).acos() * normal.dot(from.cross(to).normalize_or_zero())
    });
    (0.5 * edges.sum::<f32>()).abs()
}
