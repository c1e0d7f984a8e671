//! Does a pass visit what its pixel sees, or what a bounce from there meets?

use super::geometry::Geometry;
use super::path::Path;
use crate::base::random::Stream;
use crate::scene::receiver::Receiver;
use crate::verify::check::Check;
use crate::visibility::visits::Receivers;
use glam::DVec3;

/// The check's name.
pub(super) const VISITS: &str = "visits";

/// Receivers that are looked at, each of a pass of its own.
const LOOKED: usize = 200;

/// Passes they are of.
const PASSES: usize = 1 << 10;

/// Counts the receivers of passes that lie on no surface, or that nobody sees who should: the camera through their pixel or,
/// after a bounce, a point that the camera sees through it. Two rays each through all triangles, within what the scene
/// allows.
pub(super) fn visits(geometry: &Geometry<'_>, path: &dyn Path, kind: Receivers, seed: u64) -> Check {
    let mut rng = Stream::keyed(&[seed, u64::from_le_bytes(*b"visits..")]);
    let centres = path.receivers();
    let wanted = if centres.is_empty() { 0 } else { LOOKED.min(geometry.rays() / 8) };
    let mut visited = || {
        let (centre, pass) = (&centres[rng.below(centres.len())], rng.below(PASSES) as u32);
        path.visited(centre, pass)
    };
    let found: Vec<Option<Receiver>> = (0..wanted).map(|_| visited()).collect();
    let wrong: Vec<u32> =
        found.iter().flatten().filter(|at| !is_right(geometry, kind, at)).map(|at| at.pixel).collect();
    let detail = format!(
        "receivers of passes that are not where they should be, of {}; {} more passes meet no surface; seed {seed}",
        found.iter().flatten().count(),
        found.iter().filter(|at| at.is_none()).count()
    );
    Check::new(VISITS, wrong.len() as f64, 0.0, detail).at(wrong.first().copied(), None)
}

/// On its surface, facing whence it is seen, and seen from there: by the camera, or by a point that this sees.
fn is_right(geometry: &Geometry<'_>, kind: Receivers, at: &Receiver) -> bool {
    let Some((normal, off)) = geometry.plane(at) else { return false };
    let (position, back) = (at.position.as_dvec3(), at.view.as_dvec3());
    let slope = normal.dot(back).abs();
    let rounding = 1e-6 * geometry.size * (1.0 + 1.0 / slope.max(1e-6));
    let turned = (at.normal.as_dvec3() - normal * normal.dot(back).signum()).length() > 1e-5;
    if off.abs() > rounding || turned || (back.length() - 1.0).abs() > 1e-5 {
        return false;
    }
    if kind != Receivers::Bounce {
        return is_seen(geometry, at.pixel, position);
    }
    // Whence it was met is the first surface on the way back, unless a hair's breadth decides.
    let skin = at.normal.as_dvec3() * 1e-5 * (1.0 + geometry.size);
    let (a, b) = back.any_orthonormal_pair();
    let hairs = [DVec3::ZERO, a, -a, b, -b].map(|step| step * 1e-3);
    hairs.into_iter().any(|hair| {
        let origin = position + skin + hair;
        let met = geometry.first(origin, back);
        met.is_some_and(|(t, surface)| surface.is_some() && is_seen(geometry, at.pixel, origin + back * t))
    })
}

/// Whether the camera sees a point through a pixel, unless an edge is so near that a hundredth of a pixel decides.
fn is_seen(geometry: &Geometry<'_>, pixel: u32, point: DVec3) -> bool {
    let (to, distance) = (point - geometry.eye(), (point - geometry.eye()).length());
    let Some([x, y]) = geometry.on_film(to) else { return false };
    let width = geometry.scene.camera().resolution().0;
    let beside = [x - f64::from(pixel % width) - 0.5, y - f64::from(pixel / width) - 0.5];
    // What is near the eye moves far on the film for a little.
    let slack = 0.02 + 1e-5 * geometry.size / distance * f64::from(geometry.scene.camera().resolution().1);
    if beside.iter().any(|x| x.abs() > 0.5 + slack) {
        return false;
    }
    let near = 1e-3 * distance + 1e-5 * geometry.size;
    let around = [[0.0, 0.0], [0.01, 0.0], [-0.01, 0.0], [0.0, 0.01], [0.0, -0.01]];
    around.into_iter().any(|[dx, dy]| {
        let ray = geometry.ray(pixel, [beside[0] + dx, beside[1] + dy]);
        geometry.first(geometry.eye(), ray).is_some_and(|(t, _)| (t - distance).abs() < near)
    })
}
