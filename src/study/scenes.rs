//! Can the scenes of a study be told apart in its tables?

use crate::base::error::{Error, Result};
use crate::scene::Scene;

/// Refuses scenes of one name: their rows could not be told apart.
pub(super) fn told_apart(scenes: &[Scene]) -> Result<()> {
    let twice =
        scenes.iter().enumerate().find(|(i, scene)| scenes[..*i].iter().any(|other| other.name() == scene.name()));
    twice.map_or(Ok(()), |(_, scene)| {
        Err(Error::Invalid(format!("two scenes are named `{}`; rows could not be told apart", scene.name())))
    })
}
