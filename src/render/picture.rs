//! All pixels of a view: receivers as rendered, emitters as they shine, the rest black.

use crate::visibility::stage::Stage;
use crate::visibility::view::Seen;
use glam::Vec3;

/// Radiance in cd/m^2 of every pixel, row by row from the top; `receivers` holds that of the stage's receivers.
pub(crate) fn picture(stage: &Stage, receivers: &[Vec3]) -> Vec<[f32; 3]> {
    let radiance = |seen: &Seen| match seen {
        Seen::Sky | Seen::EmitterBack => Vec3::ZERO,
        Seen::Emitter(light) => stage.scene().lights()[*light as usize].colour,
        Seen::Receiver(index) => receivers[*index as usize],
    };
    stage.view().pixels().iter().map(|seen| radiance(seen).to_array()).collect()
}
