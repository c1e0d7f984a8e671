//! How are figures said in captions?

use crate::report::short;

/// A share of so many, in per cent.
pub(super) fn percent(part: u64, of: u64) -> String {
    share(part as f64 / of.max(1) as f64)
}

/// A share in per cent.
pub(super) fn share(share: f64) -> String {
    format!("{} %", rounded(100.0 * share))
}

/// A length in the unit that suits it.
pub(super) fn metres(length: f64) -> String {
    match length {
        ..0.01 => format!("{} mm", rounded(1e3 * length)),
        ..1.0 => format!("{} cm", rounded(100.0 * length)),
        ..1e4 => format!("{} m", rounded(length)),
        _ => format!("{} km", rounded(1e-3 * length)),
    }
}

/// An error over a mean: in per cent, or as a multiple of it.
pub(super) fn of_the_mean(error: f64) -> String {
    if error < 2.0 { format!("{} of the mean", share(error)) } else { format!("{} times the mean", rounded(error)) }
}

/// Three digits, without zeros at the end.
pub(super) fn rounded(value: f64) -> String {
    let text = short(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_lengths_read_well() {
        assert_eq!(percent(1, 3), "33.3 %");
        assert_eq!(percent(0, 0), "0 %");
        assert_eq!([0.000_1, 0.05, 3.0, 1.25, 2e4].map(metres), ["0.1 mm", "5 cm", "3 m", "1.25 m", "20 km"]);
        assert_eq!([0.5, 13.5].map(of_the_mean), ["50 % of the mean", "13.5 times the mean"]);
    }
}
