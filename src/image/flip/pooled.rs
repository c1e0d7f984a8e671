//! A map of differences as a few figures.

/// What a map of differences comes to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pooled {
    /// The mean.
    pub mean: f64,
    /// Half of the sum of all differences lies in pixels with this difference or less.
    pub weighted_median: f64,
    /// The largest.
    pub max: f64,
}

impl Pooled {
    /// Of these differences, 0 or more each; of none, all are 0.
    pub(crate) fn of(differences: &[f64]) -> Self {
        let mut sorted = differences.to_vec();
        sorted.sort_by(f64::total_cmp);
        let total: f64 = sorted.iter().sum();
        let mut below = 0.0;
        let half = sorted.iter().find(|&&difference| {
            below += difference;
            below >= 0.5 * total
        });
        Self {
            mean: total / sorted.len().max(1) as f64,
            weighted_median: half.copied().unwrap_or(0.0),
            max: sorted.last().copied().unwrap_or(0.0),
        }
    }
}
