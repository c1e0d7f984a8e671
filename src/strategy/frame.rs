//! Lights chosen with state that is drawn anew for each pass, or with a view of the whole frame.

use super::sampler::LightSampler;
use crate::base::draws::Points;
use crate::base::random::RunKey;
use crate::scene::receiver::Receiver;

/// All that is sampled in a pass, and by which numbers.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// The receivers, neighbours together.
    pub receivers: &'a [Receiver],
    /// Names the random numbers.
    pub key: RunKey,
    /// How they are spread over a pixel's passes; a strategy that was named has its own say.
    pub points: Points,
}

impl<'a> Frame<'a> {
    /// A frame with independent numbers.
    pub fn new(receivers: &'a [Receiver], key: RunKey) -> Self {
        Self { receivers, key, points: Points::Random }
    }
}

/// Lights chosen with state that is drawn anew for each pass, or with a view of the whole frame.
///
/// ```
/// use citylights::prelude::*;
/// use citylights::strategy::{Frame, FrameSampler, PerPass};
///
/// /// In each pass one light for all receivers.
/// struct OneForAll;
///
/// /// The lights of a scene.
/// struct Lights(Vec<LightId>);
///
/// /// The light of a pass and its weight; none where there are no lights.
/// struct Chosen(Option<(LightId, f32)>);
///
/// impl Strategy for OneForAll {
///     const INFO: Info = Info {
///         name: "one-for-all",
///         summary: "picks one light a pass",
///         source: "an example",
///         claim: Claim::Unbiased,
///     };
///     type Sampler = PerPass<Lights>;
///     fn configure(_: &mut Arguments<'_>) -> Result<Self> {
///         Ok(Self)
///     }
///     fn build(&self, context: BuildContext<'_>) -> Result<PerPass<Lights>> {
///         Ok(PerPass(Lights(context.stage.lights().to_vec())))
///     }
/// }
///
/// impl FrameSampler for Lights {
///     type Pass<'a> = Chosen;
///     fn begin<'a>(&'a self, frame: Frame<'a>, pass: u32) -> Chosen {
///         let count = self.0.len();
///         let place = (count > 0).then(|| frame.key.stream(pass, u32::MAX).below(count));
///         Chosen(place.map(|place| (self.0[place], count as f32)))
///     }
///     fn expected_counts(&self, _: &Receiver, counts: &mut [f32]) -> bool {
///         self.0.iter().for_each(|&light| counts[light as usize] += 1.0 / self.0.len() as f32);
///         true
///     }
///     fn heap_bytes(&self) -> usize {
///         size_of_val(&self.0[..])
///     }
/// }
///
/// impl LightSampler for Chosen {
///     type Scratch = ();
///     fn sample<T: Tally>(&self, _: &Receiver, _: &mut Draws, _: &mut (), out: &mut Picks<'_, T>) {
///         self.0.into_iter().for_each(|(light, weight)| out.push(light, weight));
///     }
///     fn expected_counts(&self, _: &Receiver, _: &mut [f32]) -> bool {
///         false
///     }
///     fn heap_bytes(&self) -> usize {
///         0
///     }
/// }
///
/// let strategy = Registry::standard().with::<OneForAll>().parse("one-for-all")?;
/// let scene = Scene::new(citylights::sources::small::sixteen())?;
/// assert!(verify(&strategy, &scene)?.iter().all(|check| check.passed));
/// # Ok::<(), Error>(())
/// ```
pub trait FrameSampler: Send + Sync {
    /// What samples in one pass.
    type Pass<'a>: LightSampler
    where
        Self: 'a;

    /// Begins a pass: draws its state.
    fn begin<'a>(&'a self, frame: Frame<'a>, pass: u32) -> Self::Pass<'a>;

    /// As [`LightSampler::expected_counts`]; the expectation runs over the state of the pass too.
    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool;

    /// As [`LightSampler::heap_bytes`].
    fn heap_bytes(&self) -> usize;
}
