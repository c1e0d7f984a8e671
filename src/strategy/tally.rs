//! What does choosing cost, in work rather than time? Counts carry over between machines.
//!
//! Samplers are compiled twice: with [`Counts`], which counts, and with [`Uncounted`], which is nothing at all.

use crate::base::counts::Counts;

/// Counts the work of choosing.
///
/// ```
/// use citylights::base::counts::Counts;
/// use citylights::prelude::*;
///
/// fn strongest<T: Tally>(lights: &[Light], tally: &mut T) -> Option<usize> {
///     tally.weighed(lights.len() as u64);
///     (0..lights.len()).max_by(|&a, &b| luminance(lights[a].flux(1.0)).total_cmp(&luminance(lights[b].flux(1.0))))
/// }
///
/// let scene = Scene::new(citylights::sources::small::sixteen())?;
/// let mut counted = Counts::default();
/// assert_eq!(strongest(scene.lights(), &mut counted), strongest(scene.lights(), &mut Uncounted));
/// assert_eq!((counted.weighed, Uncounted.work().weighed), (16, 0));
/// # Ok::<(), Error>(())
/// ```
pub trait Tally: Default + Send {
    /// Whether it counts at all; if not, a sampler within another need not count either.
    const COUNTS: bool;
    /// Nodes of a hierarchy visited.
    fn nodes(&mut self, count: u64);
    /// Lights or nodes weighed at a receiver.
    fn weighed(&mut self, count: u64);
    /// Candidates drawn to choose from.
    fn candidates(&mut self, count: u64);
    /// Shadow rays cast to choose, not to shade.
    fn shadow_rays(&mut self, count: u64);
    /// Adds what another tally counted.
    fn add(&mut self, work: Counts);
    /// The counts, if there are any.
    fn work(&self) -> Counts;
}

/// Counts nothing: for timed runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uncounted;

impl Tally for Uncounted {
    const COUNTS: bool = false;

    #[inline(always)]
    fn nodes(&mut self, _count: u64) {}
    #[inline(always)]
    fn weighed(&mut self, _count: u64) {}
    #[inline(always)]
    fn candidates(&mut self, _count: u64) {}
    #[inline(always)]
    fn shadow_rays(&mut self, _count: u64) {}
    #[inline(always)]
    fn add(&mut self, _work: Counts) {}
    fn work(&self) -> Counts {
        Counts::default()
    }
}

impl Tally for Counts {
    const COUNTS: bool = true;

    fn nodes(&mut self, count: u64) {
        self.nodes += count;
    }

    fn weighed(&mut self, count: u64) {
        self.weighed += count;
    }

    fn candidates(&mut self, count: u64) {
        self.candidates += count;
    }

    fn shadow_rays(&mut self, count: u64) {
        self.choosing_rays += count;
    }

    fn add(&mut self, work: Counts) {
        *self += work;
    }

    fn work(&self) -> Counts {
        *self
    }
}
