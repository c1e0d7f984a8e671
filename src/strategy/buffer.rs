//! Picks of several receivers in several passes.

use super::pick::Pick;

/// Picks of several receivers in several passes.
#[derive(Default)]
pub struct PickBuffer {
    pub(super) picks: Vec<Pick>,
    pub(super) ends: Vec<u32>,
}

impl PickBuffer {
    /// Forgets all picks and keeps the storage.
    pub fn clear(&mut self) {
        self.picks.clear();
        self.ends.clear();
    }

    /// The number of picks.
    pub fn len(&self) -> usize {
        self.picks.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.picks.is_empty()
    }

    /// The picks of each (receiver, pass) in the order they were filled.
    pub fn calls(&self) -> impl Iterator<Item = &[Pick]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let call = &self.picks[start..end as usize];
            start = end as usize;
            call
        })
    }
}
