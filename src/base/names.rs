//! Which known names come near a misspelt one.

/// The names in `known` that resemble `given`, nearest first; all of them (up to twelve) when none does.
pub(crate) fn near<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut scored: Vec<(f64, &str)> =
        known.into_iter().map(|name| (strsim::jaro_winkler(given, name), name)).collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    // 0.75: "lamp" finds "lamps", while unrelated names stay below it.
    let close = scored.iter().filter(|(score, _)| *score > 0.75).count();
    let keep = if close > 0 { close.min(4) } else { scored.len().min(12) };
    scored[..keep].iter().map(|(_, name)| (*name).to_owned()).collect()
}
