//! Which known names come near a misspelt one, and how is a name of a file told?

/// The names in `known` that resemble `given`, nearest first and four at most; none where none does.
pub(crate) fn near<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut scored: Vec<(f64, &str)> =
        known.into_iter().map(|name| (strsim::jaro_winkler(given, name), name)).collect();
    // 0.75: "lamp" finds "lamps", while unrelated names stay below it.
    scored.retain(|(score, _)| *score > 0.75);
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.into_iter().take(4).map(|(_, name)| name.to_owned()).collect()
}

/// Most names that a message lists.
const LISTED: usize = 24;

/// What a message goes on with where `given` is none of `known`: `; near it: lamps`, else all that there are.
pub(crate) fn hint<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    told(&near(given, known.iter().copied()), &known)
}

/// The names that come near, or where there are none those that are known.
pub(super) fn told(near: &[String], known: &[impl AsRef<str>]) -> String {
    let list = |names: &[&str]| names.join(", ");
    if !near.is_empty() {
        return format!("; near it: {}", near.join(", "));
    }
    let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
    match known.len() {
        0 => String::new(),
        1..=LISTED => format!("; there are {}", list(&known)),
        all => format!("; there are {} and {} more", list(&known[..LISTED]), all - LISTED),
    }
}

/// The text with whatever would disturb a terminal escaped.
pub(crate) fn printable(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() { out.extend(c.escape_debug()) } else { out.push(c) }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_near_is_called_near() {
        let known = ["lamps", "lights", "camera"];
        assert_eq!(near("lamp", known), ["lamps"]);
        assert_eq!(hint("lamp", known), "; near it: lamps");
        assert_eq!(near("qqq", known), Vec::<String>::new());
        assert_eq!(hint("qqq", known), "; there are lamps, lights, camera");
        assert_eq!(hint("qqq", [] as [&str; 0]), "");
        let many: Vec<String> = (0..100).map(|n| format!("name{n}")).collect();
        assert!(hint("qqq", many.iter().map(String::as_str)).ends_with("name23 and 76 more"));
    }
}
