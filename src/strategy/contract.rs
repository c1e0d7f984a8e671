//! What a strategy is: parameters, and how they become a sampler of a scene.

use super::any_sampler::AnySampler;
use super::arguments::Arguments;
use super::configured::AnyStrategy;
use super::context::BuildContext;
use super::info::{Info, Role};
use crate::base::error::Result;

/// How lights are chosen: the parameters, before any scene is known.
pub trait Strategy: Sized + Send + Sync + 'static {
    /// What it is.
    const INFO: Info;
    /// What it becomes for a scene.
    type Sampler: AnySampler + 'static;
    /// Reads the parameters; each has a default.
    ///
    /// # Errors
    /// A parameter whose value is not allowed.
    fn configure(arguments: &mut Arguments) -> Result<Self>;
    /// What it is with its parameters: they may decide the claim.
    fn info(&self) -> Info {
        Self::INFO
    }
    /// Whether other strategies may take candidates from it: it chooses at one receiver, without a view of the frame,
    /// and takes none itself.
    fn gives_candidates(&self) -> bool {
        Self::INFO.role == Role::Choosing
    }
    /// Whether it chooses by the same probabilities in the same scene in another unit of length: not if these depend on a
    /// length in metres, as that which its own shadow rays keep off surfaces.
    fn scale_free(&self) -> bool {
        Self::INFO.role != Role::Oracle
    }
    /// Builds the sampler: the set-up phase.
    ///
    /// # Errors
    /// A scene that it cannot serve.
    fn build(&self, context: BuildContext<'_>) -> Result<Self::Sampler>;
}

impl<S: Strategy> AnyStrategy for S {
    fn info(&self) -> Info {
        Strategy::info(self)
    }

    fn gives_candidates(&self) -> bool {
        Strategy::gives_candidates(self)
    }

    fn scale_free(&self) -> bool {
        Strategy::scale_free(self)
    }

    fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>> {
        Ok(Box::new(Strategy::build(self, context)?))
    }
}
