//! What did a verb come to?

/// What a verb came to.
pub(super) enum Outcome {
    Done,
    /// A check that the user asked for has failed; the text was printed.
    CheckFailed,
}
