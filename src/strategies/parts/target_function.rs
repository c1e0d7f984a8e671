//! What is a candidate worth at a receiver?
//!
//! The receiver's albedo is left out: it changes no choice at one receiver, and between receivers of different
//! materials the values keep one scale.

use crate::base::colour::luminance;
use crate::scene::Scene;
use crate::scene::light_sampling::LightSampling;
use crate::scene::receiver::Receiver;
use crate::shading::contribution::{Arrival, contribution};
use crate::shading::importance::importance;
use crate::strategy::{BuildContext, Pick, Tally};
use crate::visibility::occluders::Occluders;
use crate::visibility::offset::RayEnds;
use glam::Vec3;
use std::sync::Arc;

/// Values of lights and of points on them.
pub(in crate::strategies) struct TargetFunction {
    scene: Arc<Scene>,
    /// `None` where nothing can stand between a receiver and a light.
    occluders: Option<Arc<Occluders>>,
    ray_ends: RayEnds,
    by: LightSampling,
}

impl TargetFunction {
    pub(in crate::strategies) fn new(context: BuildContext<'_>) -> Self {
        let stage = context.stage;
        let occluders = stage.needs().occlusion.then(|| Arc::clone(stage.occluders()));
        Self { scene: Arc::clone(stage.scene()), occluders, ray_ends: stage.ray_ends(), by: stage.light_sampling() }
    }

    pub(in crate::strategies) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Of a light as a whole, nothing in between; positive wherever a part of it can add anything.
    #[inline]
    pub(in crate::strategies) fn of_light<T: Tally>(&self, pick: &Pick, at: &Receiver, tally: &mut T) -> f32 {
        tally.weighed(1);
        importance(&self.scene.lights()[pick.light as usize], at)
    }

    /// Of the point on the light, nothing in between.
    #[inline]
    pub(in crate::strategies) fn of_point<T: Tally>(&self, pick: &Pick, at: &Receiver, tally: &mut T) -> f32 {
        self.arrival(pick, at, tally).map_or(0.0, value)
    }

    /// Of the point on the light, 0 where it is hidden; `of_point` where it is not.
    #[inline]
    pub(in crate::strategies) fn of_visible_point<T: Tally>(&self, pick: &Pick, at: &Receiver, tally: &mut T) -> f32 {
        let (value, visible) = self.of_point_seen(pick, at, tally);
        if visible { value } else { 0.0 }
    }

    /// `of_point`, and whether the point is visible: not asked of one that adds nothing.
    #[inline]
    pub(in crate::strategies) fn of_point_seen<T: Tally>(
        &self,
        pick: &Pick,
        at: &Receiver,
        tally: &mut T,
    ) -> (f32, bool) {
        let Some(arrival) = self.arrival(pick, at, tally) else { return (0.0, false) };
        let Some(occluders) = &self.occluders else { return (value(arrival), true) };
        let light = &self.scene.lights()[pick.light as usize];
        tally.shadow_rays(1);
        // The very ray that the harness would cast: what is hidden here is hidden there.
        let segment = self.ray_ends.segment(at, light, arrival.direction, arrival.distance);
        (value(arrival), occluders.visible(&segment))
    }

    #[inline]
    fn arrival<T: Tally>(&self, pick: &Pick, at: &Receiver, tally: &mut T) -> Option<Arrival> {
        tally.weighed(1);
        let light = &self.scene.lights()[pick.light as usize];
        contribution::<0b1111>(self.by, light, pick.uv, &Receiver { albedo: Vec3::ONE, ..*at }).ok()
    }
}

#[inline]
fn value(arrival: Arrival) -> f32 {
    luminance(arrival.radiance)
}
