//! Who watches long work, and may stop it?

use crate::base::error::{Error, Result};

/// Watches long work. All methods may be called from any thread.
pub(crate) trait Observer: Sync {
    /// A stage of `total` steps begins.
    fn begin(&self, _what: &str, _total: u64) {}
    /// Steps were finished.
    fn advance(&self, _steps: u64) {}
    /// The stage has ended.
    fn end(&self) {}
    /// Whether the user asked to stop.
    fn stopped(&self) -> bool {
        false
    }

    /// Goes on unless the user asked to stop.
    ///
    /// # Errors
    /// The user's wish to stop.
    fn check(&self) -> Result<()> {
        if self.stopped() { Err(Error::Interrupted) } else { Ok(()) }
    }
}

/// Watches nothing: for benches and tests.
pub(crate) struct Unobserved;

impl Observer for Unobserved {}
