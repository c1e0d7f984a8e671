//! How are figures said in captions?

use crate::report::short;

/// A share of so many, in per cent.
pub(super) fn percent(part: u64, of: u64) -> String {
    share(part as f64 / of.max(1) as f64)
}

/// A share in per cent.
pub(super) fn share(share: f64) -> String {
    format!("{} %", short(100.0 * share))
}

/// A length in the unit that suits it.
pub(super) fn metres(length: f64) -> String {
    if length < 1.0 { format!("{} cm", rounded(100.0 * length)) } else { format!("{} m", rounded(length)) }
}

/// Three digits, without zeros at the end.
fn rounded(value: f64) -> String {
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
        assert_eq!([metres(0.05), metres(3.0), metres(1.25)], ["5 cm", "3 m", "1.25 m"]);
    }
}
