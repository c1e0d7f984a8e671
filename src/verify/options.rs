//! How hard is a strategy looked at?

/// How hard to look.
#[derive(Clone, Copy, Debug)]
pub struct VerifyOptions {
    /// How many receivers, spread over the stage's.
    pub receivers: usize,
    /// Picks to draw at each receiver, about.
    pub draws: usize,
    /// Independent batches that the picks are drawn in: the sample size of the t tests.
    pub batches: u32,
    /// Stratified points for the triangles of a receiver, in each of 8 repetitions, on top of one a light.
    pub points: u32,
    /// Names all random numbers.
    pub seed: u64,
    /// The chance that a right strategy fails a check in one look. It fails [`Verifier::verify`] with the square of it.
    ///
    /// [`Verifier::verify`]: super::Verifier::verify
    pub level: f64,
    /// Allocations of this thread so far, where the program's allocator counts them.
    pub allocations: Option<fn() -> u64>,
}

impl Default for VerifyOptions {
    fn default() -> Self {
        Self { receivers: 32, draws: 20_000, batches: 200, points: 64, seed: 1, level: 0.01, allocations: None }
    }
}

impl VerifyOptions {
    /// A shorter look, where there is much to look at.
    #[must_use]
    pub(crate) fn fewer(self) -> Self {
        Self { receivers: self.receivers.min(8), draws: self.draws / 4, batches: 50, ..self }
    }
}
