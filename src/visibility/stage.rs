//! A scene made ready to be measured: occluders built, receivers found, what it does not need left out.

use super::occluders::Occluders;
use super::offset::{Offset, RayEnds};
use super::reach;
use super::view::View;
use super::visits::{Receivers, visited};
use crate::scene::Scene;
use crate::scene::light::LightId;
use crate::scene::light_sampling::LightSampling;
use crate::scene::needs::Needs;
use crate::scene::receiver::Receiver;
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

/// Everything that strategies and renderers share; built once a scene, off every clock.
pub struct Stage {
    scene: Arc<Scene>,
    occluders: Arc<Occluders>,
    view: View,
    visits: Receivers,
    needs: Needs,
    lights: Vec<LightId>,
    offset: Offset,
    ray_ends: RayEnds,
    /// Where bounces start: receivers do not depend on how shadow rays are tried to keep off them.
    bounce_starts: RayEnds,
    light_sampling: LightSampling,
    shared: Vec<Shared>,
}

/// A part of what all strategies share, and how long it took: it is on no strategy's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shared {
    /// What was done: occluders, view (primary rays) or leave-out.
    pub part: &'static str,
    /// Wall seconds, on as many threads as the pool has that made the stage.
    pub wall_s: f64,
}

/// Whether a stage leaves out what its scene provably does not need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LeaveOut {
    /// Leave it out.
    #[default]
    Yes,
    /// Keep everything: for proof that nothing is lost.
    No,
}

impl Stage {
    /// Prepares a scene whose receivers are what pixels see through their centres.
    pub fn new(scene: Scene, leave_out: LeaveOut, offset: Offset) -> Self {
        Self::visiting(scene, leave_out, offset, Receivers::Centre)
    }

    /// Prepares a scene whose passes visit these receivers.
    ///
    /// Where receivers move, no light is left out for facing away from all of them: nobody knows them yet.
    pub(crate) fn visiting(scene: Scene, leave_out: LeaveOut, offset: Offset, receivers: Receivers) -> Self {
        let mut shared = Vec::new();
        let occluders = timed(&mut shared, "occluders", || Occluders::new(&scene));
        let view = timed(&mut shared, "view", || View::new(&scene, &occluders));
        let all = || (0..scene.lights().len() as LightId).collect();
        let (needs, lights) = match leave_out {
            LeaveOut::Yes => {
                let needs = Needs::of(&scene);
                // The historical policies fail far from the origin: a surface then blocks its own rays, and shows it.
                let occlusion = needs.occlusion || offset != Offset::SCALED;
                let reaching = || if receivers.moves() { all() } else { reach::reaching(&scene, view.receivers()) };
                (Needs { occlusion, ..needs }, timed(&mut shared, "leave-out", reaching))
            }
            LeaveOut::No => (Needs::ALL, all()),
        };
        Self {
            ray_ends: offset.in_scene(&scene),
            bounce_starts: Offset::SCALED.in_scene(&scene),
            scene: Arc::new(scene),
            occluders: Arc::new(occluders),
            view,
            visits: receivers,
            needs,
            lights,
            offset,
            light_sampling: LightSampling::default(),
            shared,
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What blocks light.
    pub fn occluders(&self) -> &Arc<Occluders> {
        &self.occluders
    }

    /// What the camera sees.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// What pixels see through their centres: the receivers of every pass or, where these [move](Receivers::moves), a hint
    /// of where they may lie.
    pub fn receivers(&self) -> &[Receiver] {
        self.view.receivers()
    }

    /// Which points the passes visit.
    pub(crate) fn visits(&self) -> Receivers {
        self.visits
    }

    /// The receiver that a pixel visits in a pass, given what it sees through its centre; none where it meets no surface.
    pub(crate) fn visited(&self, centre: &Receiver, pass: u32) -> Option<Receiver> {
        if !self.visits.moves() {
            return Some(*centre);
        }
        visited(self.visits, &self.scene, &self.occluders, self.bounce_starts, centre.pixel, pass)
    }

    /// Where passes visit, at one point a pixel: the receivers themselves where they stay or keep to their pixels, or else
    /// those of a pass that is never rendered. What is learned of these places says nothing of who arrives.
    pub(crate) fn places(&self) -> Cow<'_, [Receiver]> {
        match self.visits {
            Receivers::Centre | Receivers::Spread => self.receivers().into(),
            Receivers::Bounce => self
                .receivers()
                .par_iter()
                .filter_map(|centre| self.visited(centre, u32::MAX))
                .collect::<Vec<_>>()
                .into(),
        }
    }

    /// What the scene needs of a renderer.
    pub(crate) fn needs(&self) -> Needs {
        self.needs
    }

    /// The lights to choose from, in table order: all, or those that can touch a receiver.
    pub fn lights(&self) -> &[LightId] {
        &self.lights
    }

    /// What making the stage took, part by part.
    pub(crate) fn shared(&self) -> &[Shared] {
        &self.shared
    }

    /// How shadow rays keep off their own surfaces.
    pub fn offset(&self) -> Offset {
        self.offset
    }

    /// Where shadow rays start and end here.
    #[inline]
    pub fn ray_ends(&self) -> RayEnds {
        self.ray_ends
    }

    /// How the point on a triangle light is drawn.
    pub fn light_sampling(&self) -> LightSampling {
        self.light_sampling
    }

    /// The same stage with points on triangle lights drawn that way.
    pub fn with_light_sampling(mut self, by: LightSampling) -> Self {
        self.light_sampling = by;
        self
    }

    /// The same stage with another set of needs: for measuring what leaving out saves.
    #[cfg(any(test, feature = "bench"))]
    pub(crate) fn with_needs(mut self, needs: Needs) -> Self {
        self.needs = needs;
        self
    }
}

/// Does a part of the shared work and notes how long it took.
fn timed<T>(shared: &mut Vec<Shared>, part: &'static str, work: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let done = work();
    shared.push(Shared { part, wall_s: begun.elapsed().as_secs_f64() });
    done
}
