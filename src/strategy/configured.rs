//! A strategy with all its parameters settled, of any type.

use super::any_sampler::{AnySampler, Block};
use super::context::BuildContext;
use super::frame::Frame;
use super::info::Info;
use super::parameter::Parameter;
use super::source::Source;
use crate::base::draws::Points;
use crate::base::error::Result;
use crate::scene::receiver::Receiver;
use std::ops::Range;

/// A strategy of any type.
pub(crate) trait AnyStrategy: Send + Sync {
    /// As [`Strategy::info`](super::Strategy::info).
    fn info(&self) -> Info;
    /// As [`Strategy::gives_candidates`](super::Strategy::gives_candidates).
    fn gives_candidates(&self) -> bool;
    /// As [`Strategy::scale_free`](super::Strategy::scale_free).
    fn scale_free(&self) -> bool;
    /// Builds its sampler for a scene.
    fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>>;
}

/// A strategy with all its parameters settled.
pub struct Configured {
    name: String,
    plain_name: String,
    parameters: Vec<Parameter>,
    strategy: Box<dyn AnyStrategy>,
    points: Points,
}

impl Configured {
    /// A strategy that has read its parameters; its name holds those in `varied`, and those that are not at their defaults.
    pub(super) fn new(
        name: &str,
        varied: &[String],
        parameters: Vec<Parameter>,
        strategy: Box<dyn AnyStrategy>,
        points: Points,
    ) -> Self {
        let with = |varied: &[String]| {
            let named = |p: &&Parameter| p.value != p.default || varied.iter().any(|name| name == p.name);
            let shown = parameters.iter().filter(named).map(|p| format!("{}={}", p.name, p.value));
            let shown: Vec<String> = shown.collect();
            if shown.is_empty() { name.to_owned() } else { format!("{name}:{}", shown.join(",")) }
        };
        let (plain_name, name) = (with(&[]), with(varied));
        Self { name, plain_name, parameters, strategy, points }
    }

    /// Its name with the parameters that differ from their defaults, `power:picks=4`, and those that a sweep varied.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The same, with no parameter at its default.
    pub(super) fn plain_name(&self) -> &str {
        &self.plain_name
    }

    /// What it is.
    pub fn info(&self) -> Info {
        self.strategy.info()
    }

    /// As [`Strategy::scale_free`](super::Strategy::scale_free).
    pub fn scale_free(&self) -> bool {
        self.strategy.scale_free()
    }

    /// As [`Strategy::gives_candidates`](super::Strategy::gives_candidates).
    pub(super) fn gives_candidates(&self) -> bool {
        self.strategy.gives_candidates()
    }

    /// Its parameters.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// How its numbers are spread over a pixel's passes.
    pub fn points(&self) -> Points {
        self.points
    }

    /// Builds its sampler for a scene.
    ///
    /// # Errors
    /// A scene that the strategy cannot serve.
    pub fn build(&self, context: BuildContext<'_>) -> Result<Box<dyn AnySampler>> {
        Ok(Box::new(Spread { sampler: self.strategy.build(context)?, points: self.points }))
    }
}

/// A sampler whose numbers are spread in a way of its own.
struct Spread {
    sampler: Box<dyn AnySampler>,
    points: Points,
}

impl AnySampler for Spread {
    fn most_passes(&self) -> u32 {
        self.sampler.most_passes()
    }

    fn begin<'a>(&'a self, frame: Frame<'a>, passes: Range<u32>) -> Box<dyn Block + 'a> {
        self.sampler.begin(Frame { points: self.points, ..frame }, passes)
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        self.sampler.expected_counts(at, counts)
    }

    fn heap_bytes(&self) -> usize {
        self.sampler.heap_bytes()
    }

    fn source(&self) -> Option<&dyn Source> {
        self.sampler.source()
    }
}
