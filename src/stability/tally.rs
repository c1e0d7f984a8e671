//! How far off are many results, and were any of them no numbers at all?

/// Errors of many results of one kind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    errors: Vec<f64>,
    /// Results that are NaN.
    pub nan: usize,
    /// Results that are infinite.
    pub infinite: usize,
    /// Results below 0 that may not be.
    pub negative: usize,
}

impl Tally {
    /// Counts a result of either sign, which is `error` off in whatever unit.
    pub(crate) fn add(&mut self, result: f64, error: f64) {
        self.nan += usize::from(result.is_nan());
        self.infinite += usize::from(result.is_infinite());
        // What is no number is as wrong as can be.
        self.errors.push(if result.is_finite() && !error.is_nan() { error } else { f64::INFINITY });
    }

    /// Counts a result that may not be negative.
    pub(crate) fn add_positive(&mut self, result: f64, error: f64) {
        self.negative += usize::from(result < 0.0);
        self.add(result, error);
    }

    /// How many results.
    pub(crate) fn count(&self) -> usize {
        self.errors.len()
    }

    /// The largest error; 0 of none.
    pub(crate) fn worst(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    /// The error that 99 % do not exceed; 0 of none.
    pub(crate) fn p99(&self) -> f64 {
        let mut sorted = self.errors.clone();
        sorted.sort_by(f64::total_cmp);
        // The next one up: between a number and infinity there is nothing.
        let rank = (0.99 * sorted.len() as f64).ceil() as usize;
        if rank == 0 { 0.0 } else { sorted[rank - 1] }
    }

    /// Results that are no numbers or of the wrong sign.
    pub(crate) fn bad(&self) -> usize {
        self.nan + self.infinite + self.negative
    }

    /// Whether no error exceeds `limit` and no result is bad.
    pub(crate) fn holds(&self, limit: f64) -> bool {
        self.worst() <= limit && self.bad() == 0
    }
}

/// What was found in one extreme case.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    /// Ours.
    pub ours: Tally,
    /// The textbook's in f32, where there is such a thing.
    pub textbook: Option<Tally>,
    /// The worst error that is right.
    pub limit: f64,
}

impl Finding {
    /// Whether ours is right.
    pub(crate) fn passed(&self) -> bool {
        self.ours.count() > 0 && self.ours.holds(self.limit)
    }
}

/// `|found - exact|` over `|exact|`; 0 of two zeros, infinite for a zero missed.
pub(super) fn relative(found: f64, exact: f64) -> f64 {
    if found == exact { 0.0 } else { (found - exact).abs() / exact.abs() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_counted_and_never_passes() {
        let mut tally = Tally::default();
        (0..200).for_each(|i| tally.add_positive(1.0, f64::from(i)));
        assert_eq!((tally.worst(), tally.p99(), tally.bad()), (199.0, 197.0, 0));
        assert!(tally.holds(199.0) && !tally.holds(198.0));
        tally.add_positive(-1.0, 0.0);
        tally.add_positive(f64::NAN, 0.0);
        tally.add_positive(f64::NEG_INFINITY, 0.0);
        assert_eq!((tally.nan, tally.infinite, tally.negative), (1, 1, 2));
        assert!(tally.worst().is_infinite() && !tally.holds(f64::INFINITY));
        assert!(!Finding { ours: Tally::default(), textbook: None, limit: 1.0 }.passed(), "nothing was tried");
    }

    #[test]
    fn a_zero_missed_is_infinitely_wrong() {
        assert_eq!(relative(0.0, 0.0), 0.0);
        assert_eq!(relative(-0.0, 0.0), 0.0);
        assert!(relative(1e-300, 0.0).is_infinite());
        assert!((relative(-2.0, -1.0) - 1.0).abs() < 1e-15);
    }
}
