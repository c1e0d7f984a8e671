//! Lights chosen at one receiver, for any pass.

use super::pick::Picks;
use super::tally::Tally;
use crate::base::draws::Draws;
use crate::scene::receiver::Receiver;

/// Lights chosen for one scene: the query phase. No allocation once the scratch is warm, no locks.
///
/// An example stands with [`Strategy`](super::Strategy).
pub trait LightSampler: Send + Sync {
    /// Storage of one worker, reused from call to call.
    type Scratch: Default + Send + 'static;

    /// Called when the harness comes to a receiver, before the passes that it samples there.
    fn arrive<T: Tally>(&self, _at: &Receiver, _scratch: &mut Self::Scratch, _tally: &mut T) {}

    /// Chooses lights for one pass at the receiver that was arrived at.
    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut Self::Scratch, out: &mut Picks<'_, T>);

    /// Adds to `counts` (one a light of the scene) how often each light is expected to be pushed in a call of
    /// [`sample`](Self::sample): the probability for one pick, k times it for k, 1 for a light that is listed. False if
    /// that cannot be told (resampling), never to mean zero.
    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool;

    /// Bytes on the heap, without those that the stage owns.
    fn heap_bytes(&self) -> usize;
}

impl<L: LightSampler> LightSampler for &L {
    type Scratch = L::Scratch;

    fn arrive<T: Tally>(&self, at: &Receiver, scratch: &mut L::Scratch, tally: &mut T) {
        L::arrive(self, at, scratch, tally);
    }

    fn sample<T: Tally>(&self, at: &Receiver, draws: &mut Draws, scratch: &mut L::Scratch, out: &mut Picks<'_, T>) {
        L::sample(self, at, draws, scratch, out);
    }

    fn expected_counts(&self, at: &Receiver, counts: &mut [f32]) -> bool {
        L::expected_counts(self, at, counts)
    }

    fn heap_bytes(&self) -> usize {
        L::heap_bytes(self)
    }
}
