//! How numbers are written in tables: three digits, and no more than the interval supports.

use crate::record::Interval;

/// What stands where there is no number.
pub(super) const NONE: &str = "–";

/// Three significant digits; an exponent outside `[0.001, 10000)`.
pub(crate) fn short(value: f64) -> String {
    digits(value, 3)
}

/// A number that stands in a head: as short as it can be said, without what computing left in its last digits.
pub(super) fn round(value: f64) -> String {
    format!("{value:.5e}").parse().map_or_else(|_| short(value), |value: f64| format!("{value}"))
}

/// `count` significant digits, 1 or more.
pub(super) fn digits(value: f64, count: usize) -> String {
    if value.is_nan() {
        return NONE.to_owned();
    }
    if value == 0.0 || value.is_infinite() {
        return if value == 0.0 { "0".to_owned() } else { format!("{value}") };
    }
    let scientific = format!("{value:.*e}", count - 1);
    // The exponent after rounding: 9.996 has that of 10.0.
    let exponent = scientific.split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    if (-3..4).contains(&exponent) {
        let decimals = (count as i32 - 1 - exponent).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        scientific
    }
}

/// A figure and what is known of how far off it is, to be shown beside or below it: `0.243` and `±9.1 %`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Estimate {
    /// The figure.
    pub(super) figure: String,
    /// Its interval; empty where there is none to be shown.
    pub(super) interval: String,
}

/// What stands behind a bound where the runs cannot tell the interval's other end.
pub(super) const HEAVY: &str = "†";

/// What stands for an interval that the runs do not give: they are too few, or some of them say "never".
pub(super) const UNKNOWN: &str = "±?";

impl From<String> for Estimate {
    fn from(text: String) -> Self {
        Self::certain(text)
    }
}

impl Estimate {
    /// Words, or a figure without doubt.
    pub(super) fn certain(text: impl Into<String>) -> Self {
        Self { figure: text.into(), interval: String::new() }
    }

    /// An error: "exact" where it is 0.
    pub(super) fn error(interval: Interval) -> Self {
        if interval.mean == 0.0 { Self::certain("exact") } else { Self::of(interval) }
    }

    /// A figure with its interval as a share of it, or as numbers of their own where it may be 0: `0.243 ±9.1 %`,
    /// `0.243 -8 +15 %`, `-0.02 ±0.31`; with one end, a bound: `>0.21 †`.
    pub(super) fn of(interval: Interval) -> Self {
        let Interval { mean, low, high } = interval;
        if mean.is_nan() {
            return Self::certain(NONE);
        }
        if let Some(unbounded) = Self::unbounded(interval, short) {
            return unbounded;
        }
        // Freed of skewness, an interval may end short of the figure itself, by rounding or little more.
        let off = [mean - low, high - mean].map(|off| off.max(0.0));
        let widest = interval.half_width();
        if widest == 0.0 {
            return Self::certain(short(mean));
        }
        let figure = digits(mean, allowed(mean, widest));
        let shares = off.map(|off| 100.0 * off / mean.abs());
        let interval = if interval.holds(0.0) {
            either_side(off.map(|off| digits(off, 2)), "")
        } else {
            let decimals = if shares[0].max(shares[1]) < 9.95 { 1 } else { 0 };
            either_side(shares.map(|share| format!("{share:.decimals$}")), " %")
        };
        Self { figure, interval }
    }

    /// A signed share in percent with its interval in the same unit, `+0.12 ±0.34`, to two digits of the interval.
    pub(super) fn signed_percent(interval: Interval) -> Self {
        let percent = interval.times(100.0);
        let Interval { mean, low, high } = percent;
        if mean.is_nan() {
            return Self::certain(NONE);
        }
        let signed = |value: f64| format!("{value:+.3}");
        if let Some(unbounded) = Self::unbounded(percent, signed) {
            return unbounded;
        }
        let widest = percent.half_width();
        let decimals = if widest > 0.0 { (1.0 - widest.log10().floor()).clamp(0.0, 4.0) as usize } else { 4 };
        // Without this, a small negative mean would be written "-0.00".
        let shown = if mean.abs() < 0.5 * 10f64.powi(-(decimals as i32)) { 0.0 } else { mean };
        let off = [mean - low, high - mean].map(|off| format!("{off:.decimals$}"));
        Self { figure: format!("{shown:+.decimals$}"), interval: either_side(off, "") }
    }

    /// Ranks that a row may have, first and last, and its letters.
    pub(super) fn rank(rank: Option<[u32; 2]>, letters: &str) -> Self {
        let figure = match rank {
            Some([first, last]) if first == last => first.to_string(),
            Some([first, last]) => format!("{first}-{last}"),
            None => NONE.to_owned(),
        };
        Self { figure, interval: letters.to_owned() }
    }

    /// With an end that the runs do not tell: the other end as a bound, or `text` of the figure where there is none.
    fn unbounded(interval: Interval, text: impl Fn(f64) -> String) -> Option<Self> {
        let Interval { mean, low, high } = interval;
        if interval.is_bounded() {
            return None;
        }
        let bound = |figure: String| Some(Self { figure, interval: HEAVY.to_owned() });
        // The logarithm of a figure from one run has the ends 0 and infinity: nothing is known.
        if low.is_finite() && low != 0.0 {
            bound(format!(">{}", digits(two_digits(low, f64::floor), 2)))
        } else if high.is_finite() && low == f64::NEG_INFINITY {
            bound(format!("<{}", digits(two_digits(high, f64::ceil), 2)))
        } else {
            Some(Self { figure: text(mean), interval: UNKNOWN.to_owned() })
        }
    }

    /// Something in front of the figure.
    pub(super) fn after(self, mark: &str) -> Self {
        Self { figure: format!("{mark}{}", self.figure), ..self }
    }

    /// Both on one line.
    pub(super) fn line(&self) -> String {
        format!("{} {}", self.figure, self.interval).trim_end().to_owned()
    }
}
/// How many digits of a figure its interval leaves a meaning: no more than two of the uncertainty, and three at most.
fn allowed(mean: f64, widest: f64) -> usize {
    (mean.abs().log10().floor() - widest.log10().floor() + 2.0).clamp(1.0, 3.0) as usize
}

/// How far it is to either side, once where both say the same.
fn either_side([below, above]: [String; 2], unit: &str) -> String {
    if below == above { format!("±{below}{unit}") } else { format!("-{below} +{above}{unit}") }
}

/// A bound in two digits, rounded by `round` so that it still is one.
fn two_digits(bound: f64, round: fn(f64) -> f64) -> f64 {
    let unit = 10f64.powf(bound.abs().log10().floor() - 1.0);
    if bound == 0.0 { 0.0 } else { round(bound / unit) * unit }
}

/// `part` of `whole` in percent, one decimal.
pub(super) fn percent(part: f64, whole: f64) -> String {
    let share = 100.0 * part / whole;
    if share.is_finite() { format!("{share:.1}") } else { NONE.to_owned() }
}

/// Bytes in the largest binary unit that leaves a number of 1 or more.
pub(super) fn bytes(count: u64) -> String {
    let mut value = count as f64;
    for unit in ["B", "KiB", "MiB"] {
        if value < 1024.0 {
            return format!("{} {unit}", digits(value, if value < 1000.0 { 3 } else { 4 }).trim_end_matches(".00"));
        }
        value /= 1024.0;
    }
    format!("{} GiB", short(value))
}

/// A whole number with commas between thousands.
pub(crate) fn grouped(count: u64) -> String {
    let plain = count.to_string();
    let mut text = String::new();
    for (at, digit) in plain.chars().enumerate() {
        if at > 0 && (plain.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_digits() {
        let cases = [(0.0, "0"), (0.001_234, "0.00123"), (9.996, "10.0"), (1234.0, "1234"), (12_345.0, "1.23e4")];
        for (value, text) in cases.into_iter().chain([(1.5e-9, "1.50e-9"), (-0.25, "-0.250"), (f64::NAN, NONE)]) {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn intervals_say_no_more_than_they_know() {
        let of = |mean, low, high| Estimate::of(Interval { mean, low, high }).line();
        assert_eq!(of(0.012_34, 0.011_84, 0.012_84), "0.0123 ±4.1 %");
        assert_eq!(of(0.243, 0.223_56, 0.279_45), "0.243 -8 +15 %");
        assert_eq!(of(0.243, 0.113, 0.373), "0.24 ±53 %");
        assert_eq!(of(243.0, 100.0, 763.0), "243 -59 +214 %");
        assert_eq!(of(-1e-6, -1e-3 - 1e-6, 1e-3 - 1e-6), "-1e-6 ±0.0010");
        assert_eq!(of(1.0, 1.0, 1.0), "1.00");
        assert_eq!(of(f64::NAN, f64::NAN, f64::NAN), NONE);
        assert_eq!(Estimate::error(Interval::certain(0.0)).line(), "exact");
    }

    #[test]
    fn an_end_that_is_not_known_leaves_a_bound() {
        let (of, inf) = (|mean, low, high| Estimate::of(Interval { mean, low, high }).line(), f64::INFINITY);
        assert_eq!(of(0.3, 0.2199, inf), ">0.21 †");
        assert_eq!(of(0.3, -inf, 0.4111), "<0.42 †");
        assert_eq!(of(0.3, -0.2111, inf), ">-0.22 †");
        assert_eq!([of(0.3, -inf, inf), of(0.3, 0.0, inf), of(0.3, f64::NAN, f64::NAN)], ["0.300 ±?"; 3]);
    }

    #[test]
    fn shares_are_signed() {
        let of = |mean, low, high| Estimate::signed_percent(Interval { mean, low, high }).line();
        assert_eq!(of(-0.012_34, -0.012_84, -0.011_84), "-1.234 ±0.050");
        assert_eq!(of(-1e-9, -0.03, 0.03), "+0.0 ±3.0");
        assert_eq!(of(0.001, -0.001, 0.004), "+0.10 -0.20 +0.30");
        assert_eq!(of(0.001, 0.000_5, f64::INFINITY), ">0.050 †");
        assert_eq!(of(0.001, f64::NEG_INFINITY, f64::INFINITY), "+0.100 ±?");
    }

    #[test]
    fn sizes_are_readable() {
        assert_eq!([0, 512, 1536, 10 << 20, 3 << 30].map(bytes), ["0 B", "512 B", "1.50 KiB", "10.0 MiB", "3.00 GiB"]);
        assert_eq!([7, 1000, 1_234_567].map(grouped), ["7", "1,000", "1,234,567"]);
    }
}
