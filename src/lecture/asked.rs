//! What was asked for, and which pixel is looked at?

use crate::base::error::{Error, Result};
use crate::scene::Scene;
use crate::scene::receiver::Receiver;
use crate::strategy::Registry;
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use crate::visibility::view::Seen;

/// What a chapter is drawn from.
pub(crate) struct Asked<'a> {
    /// The scene, as it was read.
    pub(crate) scene: Scene,
    /// The pixel to look at, from the left and the top, where one was named.
    pub(crate) pixel: Option<[u32; 2]>,
    /// Seed of the random numbers.
    pub(crate) seed: u64,
    /// The strategies that can be named.
    pub(crate) registry: &'a Registry,
}

impl Asked<'_> {
    /// The scene made ready.
    pub(super) fn stage(&self) -> Result<Stage> {
        ready(self.scene.clone(), Offset::SCALED)
    }

    /// Scene and film in words.
    pub(super) fn scene_in_words(&self) -> String {
        let (width, height) = self.scene.camera().resolution();
        format!("scene {}, {width} x {height} pixels, seed {}", self.scene.name(), self.seed)
    }

    /// The receiver of the named pixel; without a name, `usual` chooses.
    pub(super) fn receiver<'s>(
        &self,
        stage: &'s Stage,
        usual: impl FnOnce(&'s [Receiver]) -> Option<&'s Receiver>,
    ) -> Result<&'s Receiver> {
        let Some([x, y]) = self.pixel else {
            let none =
                || Error::Invalid("no pixel gets any light here: name one with --pixel, or another scene".into());
            return usual(stage.receivers()).ok_or_else(none);
        };
        match stage.view().seen(x, y)? {
            Seen::Receiver(index) => Ok(&stage.receivers()[index as usize]),
            Seen::Sky => Err(Error::Invalid(format!("pixel {x},{y} sees the sky: name one that sees a surface"))),
            Seen::Emitter(_) | Seen::EmitterBack => {
                Err(Error::Invalid(format!("pixel {x},{y} sees an emitter: name one that sees a surface")))
            }
        }
    }
}

/// A scene made ready, all of it; refused where nothing is seen.
pub(super) fn ready(scene: Scene, offset: Offset) -> Result<Stage> {
    let stage = Stage::new(scene, LeaveOut::No, offset);
    if stage.receivers().is_empty() {
        return Err(Error::Invalid(format!("{}: the camera sees no surface", stage.scene().name())));
    }
    Ok(stage)
}

/// Where a receiver's pixel is, from the left and the top.
pub(super) fn place(stage: &Stage, at: &Receiver) -> [u32; 2] {
    let (width, _) = stage.view().resolution();
    [at.pixel % width, at.pixel / width]
}
