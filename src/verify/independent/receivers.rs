//! Does each pixel see that point, with that normal and that albedo?

use super::geometry::Geometry;
use crate::base::random::Stream;
use crate::scene::receiver::Receiver;
use crate::verify::check::Check;

/// The check's name.
pub(super) const RECEIVERS: &str = "receivers";

/// Most receivers whose ray, plane, side and material are looked at.
const MOST: usize = 1 << 16;

/// Receivers whose ray is traced through all triangles.
const TRACED: usize = 100;

/// Counts the receivers that are not where their pixel looks, or not on the surface that it sees first, or whose normal,
/// view or albedo is another.
pub(super) fn receivers(geometry: &Geometry<'_>, receivers: &[Receiver], seed: u64) -> Check {
    let step = receivers.len().div_ceil(MOST).max(1);
    let looked = || receivers.iter().step_by(step);
    let mut wrong: Vec<u32> = looked().filter(|at| !is_right(geometry, at)).map(|at| at.pixel).collect();
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"receiver")]);
    let traced = if receivers.is_empty() { 0 } else { TRACED.min(geometry.rays()) };
    let drawn = (0..traced).map(|_| &receivers[rng.below(receivers.len())]);
    wrong.extend(drawn.filter(|at| !sees_first(geometry, at)).map(|at| at.pixel));
    let detail = format!(
        "receivers in the wrong place or of another normal or albedo, of {}, {traced} of them traced; seed {seed}",
        looked().count()
    );
    Check::new(RECEIVERS, wrong.len() as f64, 0.0, detail).at(wrong.first().copied(), None)
}

/// On its pixel's ray, in the plane of its surface, facing the camera.
fn is_right(geometry: &Geometry<'_>, at: &Receiver) -> bool {
    let Some(place) = geometry.place(at) else { return false };
    let ray = geometry.ray(at.pixel, [0.0; 2]);
    let slope = place.normal.dot(ray).abs();
    // Corners are rounded in f32, and a plane that is seen at a slant is met later for it.
    let rounding = 1e-6 * geometry.size * (1.0 + 1.0 / slope);
    let near = (place.met - place.position).length() <= rounding;
    let turned = (place.normal - at.normal.as_dvec3()).length() > 1e-5;
    let looks_back = (at.view.as_dvec3() + ray).length() < 1e-5;
    near && !turned && looks_back && place.albedo == at.albedo.as_dvec3()
}

/// Nothing else is met before it, unless an edge is so near that a hundredth of a pixel decides.
fn sees_first(geometry: &Geometry<'_>, at: &Receiver) -> bool {
    let eye = geometry.eye();
    let distance = (at.position.as_dvec3() - eye).length();
    let meets = |beside: [f64; 2]| {
        let ray = geometry.ray(at.pixel, beside);
        let near = 1e-3 * distance + 1e-5 * geometry.size;
        geometry.first(eye, ray).is_some_and(|(t, surface)| surface == Some(at.surface) || (t - distance).abs() < near)
    };
    let around = [[0.0, 0.0], [0.01, 0.0], [-0.01, 0.0], [0.0, 0.01], [0.0, -0.01]];
    around.into_iter().any(meets)
}
