//! Which lights provably cannot touch any receiver?
//!
//! Only by facing, never by range or occlusion: every visible point lies behind the light, outside its cone, or has the
//! light below its horizon. Receivers are bounded in groups by boxes and their few normals; margins cover rounding, so
//! that a light that is left out would have added exactly 0 to every pixel.

use crate::scene::Scene;
use crate::scene::light::{Kind, Light, LightId};
use crate::scene::receiver::Receiver;
use glam::Vec3;
use rayon::prelude::*;

/// The lights that can touch at least one receiver, in table order.
pub(crate) fn reaching(scene: &Scene, receivers: &[Receiver]) -> Vec<LightId> {
    let groups: Vec<Group> = receivers.chunks(GROUP).flat_map(Group::by_normal).collect();
    let ids: Vec<LightId> = (0..scene.lights().len() as LightId).collect();
    ids.into_par_iter()
        .filter(|&id| {
            let light = &scene.lights()[id as usize];
            light.colour != Vec3::ZERO && groups.iter().any(|group| group.may_see(light))
        })
        .collect()
}

/// Receivers a group: one 8 x 8 square of pixels.
const GROUP: usize = 64;

/// Receivers that share a normal, and the box around them.
struct Group {
    low: Vec3,
    high: Vec3,
    normal: Vec3,
}

impl Group {
    fn by_normal(receivers: &[Receiver]) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for r in receivers {
            if let Some(group) = groups.iter_mut().find(|group| group.normal == r.normal) {
                group.low = group.low.min(r.position);
                group.high = group.high.max(r.position);
            } else {
                groups.push(Self { low: r.position, high: r.position, normal: r.normal });
            }
        }
        groups
    }

    /// False only if no receiver of the group can get anything from the light.
    fn may_see(&self, light: &Light) -> bool {
        let margin =
            1e-5 * (self.low.abs().max(self.high.abs()).max_element() + light.position.abs().max_element() + 1.0);
        // Greatest height of a corner of the light over the lowest receiver of the group, along the normal.
        let above = |point: Vec3| self.normal.dot(point) - self.least(self.normal) > -margin;
        match light.kind() {
            Kind::Point => above(light.position),
            // Half-space of the cone's axis: the outer angle is at most 90 degrees.
            Kind::Spot => above(light.position) && self.most(light.a) - light.a.dot(light.position) > -margin,
            Kind::Directional => self.normal.dot(light.position) > -1e-5,
            Kind::Triangle => {
                let front = light.c.normalize_or_zero();
                light.corners().into_iter().any(above) && self.most(front) - front.dot(light.position) > -margin
            }
        }
    }

    /// Least value of `direction . p` over the box.
    fn least(&self, direction: Vec3) -> f32 {
        direction.dot(Vec3::select(direction.cmpge(Vec3::ZERO), self.low, self.high))
    }

    /// Greatest value of `direction . p` over the box.
    fn most(&self, direction: Vec3) -> f32 {
        -self.least(-direction)
    }
}
