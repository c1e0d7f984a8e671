//! How numbers are written in tables: three digits, and no more than the interval supports.

use crate::record::Interval;

/// What stands where there is no number.
pub(super) const NONE: &str = "–";

/// Three significant digits; an exponent outside `[0.001, 10000)`.
pub(super) fn short(value: f64) -> String {
    digits(value, 3)
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

/// An error with its interval as a share of it, `0.0123 ±4.1 %`; "exact" for an error of 0.
pub(super) fn error(interval: Interval) -> String {
    if interval.mean == 0.0 {
        return "exact".to_owned();
    }
    with_share(interval)
}

/// A number with its interval as a share of it, or as a number of its own where it is the larger one.
pub(super) fn with_share(Interval { mean, half_width }: Interval) -> String {
    let share = 100.0 * half_width / mean.abs();
    if mean.is_nan() {
        NONE.to_owned()
    } else if !share.is_finite() {
        // One run has no interval.
        format!("{} ±?", short(mean))
    } else if share > 99.5 {
        format!("{} ±{}", short(mean), digits(half_width, 2))
    } else if share >= 9.95 {
        format!("{} ±{share:.0} %", short(mean))
    } else {
        format!("{} ±{share:.1} %", short(mean))
    }
}

/// A signed share in percent with its interval in the same unit, `+0.12 ±0.34`, to two digits of the interval.
pub(super) fn signed_percent(Interval { mean, half_width }: Interval) -> String {
    let (mean, half) = (100.0 * mean, 100.0 * half_width);
    if mean.is_nan() {
        return NONE.to_owned();
    }
    if !half.is_finite() {
        return format!("{mean:+.3} ±?");
    }
    let decimals = if half > 0.0 { (1.0 - half.log10().floor()).clamp(0.0, 4.0) as usize } else { 4 };
    // Without this, a small negative mean would be written "-0.00".
    let mean = if mean.abs() < 0.5 * 10f64.powi(-(decimals as i32)) { 0.0 } else { mean };
    format!("{mean:+.decimals$} ±{half:.decimals$}")
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
pub(super) fn grouped(count: u64) -> String {
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
        let of = |mean, half_width| Interval { mean, half_width };
        assert_eq!(error(of(0.012_34, 0.000_5)), "0.0123 ±4.1 %");
        assert_eq!(error(of(0.0, 0.0)), "exact");
        assert_eq!(error(of(1.0, f64::INFINITY)), "1.00 ±?");
        assert_eq!(with_share(of(-1e-6, 1e-3)), "-1.00e-6 ±0.0010");
        assert_eq!(signed_percent(of(-0.012_34, 0.000_5)), "-1.234 ±0.050");
        assert_eq!(signed_percent(of(-1e-9, 0.03)), "+0.0 ±3.0");
    }

    #[test]
    fn sizes_are_readable() {
        assert_eq!([0, 512, 1536, 10 << 20, 3 << 30].map(bytes), ["0 B", "512 B", "1.50 KiB", "10.0 MiB", "3.00 GiB"]);
        assert_eq!([7, 1000, 1_234_567].map(grouped), ["7", "1,000", "1,234,567"]);
    }
}
