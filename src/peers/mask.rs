//! Which receivers see the same point in every renderer?
//!
//! Not those beside an emitter, whose pixels hold its radiance where a renderer shows emitters at all; and not those on a
//! silhouette, where the rounding of a pixel's centre decides which surface is seen: a few pixels in a thousand that
//! would decide every figure.

use crate::scene::receiver::Receiver;
use crate::visibility::occluders::Met;
use crate::visibility::stage::Stage;
use crate::visibility::view::Seen;
use glam::Vec3;

/// How far, in pixels, the centre of a pixel may be off: twice what the narrowest filter of a peer reaches, and far more
/// than rounding to f32 does.
const OFF: f64 = 0.02;

/// The places in `receivers`, some or all of the stage's, that can be compared, ascending.
pub(crate) fn clear(stage: &Stage, receivers: &[Receiver]) -> Vec<usize> {
    let clear = |at: &Receiver| !beside_emitter(stage, at) && !on_silhouette(stage, at);
    receivers.iter().enumerate().filter(|(_, at)| clear(at)).map(|(i, _)| i).collect()
}

/// Whether any of the eight pixels around sees an emitter.
fn beside_emitter(stage: &Stage, at: &Receiver) -> bool {
    let (width, height) = stage.view().resolution();
    let (x, y) = (at.pixel % width, at.pixel / width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    let seen = |x: u32, y: u32| stage.view().pixels()[(y * width + x) as usize];
    let emitter = |x, y| matches!(seen(x, y), Seen::Emitter(_) | Seen::EmitterBack);
    rows.into_iter().any(|y| (x.saturating_sub(1)..(x + 2).min(width)).any(|x| emitter(x, y)))
}

/// Whether something else is seen a little off the pixel's centre.
fn on_silhouette(stage: &Stage, at: &Receiver) -> bool {
    let camera = stage.scene().camera();
    let width = camera.resolution().0;
    let (x, y) = (f64::from(at.pixel % width) + 0.5, f64::from(at.pixel / width) + 0.5);
    [(-OFF, -OFF), (OFF, -OFF), (-OFF, OFF), (OFF, OFF)].into_iter().any(|(dx, dy)| {
        let direction = camera.direction_through(x + dx, y + dy);
        let Some((Met::Surface(index), t)) = stage.occluders().first(camera.position(), direction) else { return true };
        !same_plane(stage, at, index, camera.position().as_dvec3() + direction * t)
    })
}

/// Whether a surface is the receiver's own or goes on from it: the same plane and albedo, with `point` on it.
fn same_plane(stage: &Stage, at: &Receiver, index: u32, point: glam::DVec3) -> bool {
    if index == at.surface {
        return true;
    }
    let surface = &stage.scene().surfaces()[index as usize];
    let [p, q, r] = surface.corners.map(Vec3::as_dvec3);
    let normal = (q - p).cross(r - p).normalize();
    let apart = (point - at.position.as_dvec3()).dot(at.normal.as_dvec3()).abs();
    let albedo = stage.scene().materials()[surface.material as usize].albedo;
    // A millimetre: what f32 makes of a plane within a kilometre, and less than any step in a scene.
    albedo == at.albedo && normal.dot(at.normal.as_dvec3()).abs() > 1.0 - 1e-6 && apart < 1e-3
}
