//! Which names can stand in a path, a table and a page?

/// Most characters of a name.
pub(crate) const LONGEST: usize = 64;
/// What a name may not hold, beside what is not printable: it would break a path, a table or a page.
const FORBIDDEN: [char; 9] = ['<', '>', '|', '/', '\\', '"', '\'', '`', ','];

/// Whether the name is fit as it is: whatever is not printable would be escaped.
#[cfg(feature = "recipe")]
pub(crate) fn is_fit(name: &str) -> bool {
    (1..=LONGEST).contains(&name.chars().count())
        && !name.trim().is_empty()
        && !name.contains(FORBIDDEN)
        && name.escape_debug().eq(name.chars())
}

/// The name with an underscore for each character that is not allowed, cut to the most that are; `None` if it is blank.
#[cfg(feature = "gltf")]
pub(crate) fn made_fit(name: &str) -> Option<String> {
    let allowed = |c: char| !FORBIDDEN.contains(&c) && c.escape_debug().eq([c]);
    let fit: String = name.trim().chars().take(LONGEST).map(|c| if allowed(c) { c } else { '_' }).collect();
    (!fit.is_empty()).then_some(fit)
}
