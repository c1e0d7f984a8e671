//! Which text of an option is right?

/// Parses pixels across and down.
pub(super) fn resolution(text: &str) -> Result<(u32, u32), String> {
    let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    parsed
        .filter(|&(w, h): &(u32, u32)| w > 0 && h > 0)
        .ok_or_else(|| "two whole numbers of 1 or more are right, as 240x135".into())
}

/// Parses an exposure value.
pub(super) fn finite(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|x: &f32| x.is_finite() && x.abs() <= 60.0)
        .ok_or_else(|| "a number from -60 to 60 is right".into())
}

/// Parses a factor from radiance to displayed value: exposure values of -56 to 56.
pub(super) fn exposure(text: &str) -> Result<f32, String> {
    let right = 1e-17..=1e17;
    text.parse()
        .ok()
        .filter(|x| right.contains(x))
        .ok_or_else(|| "a number above 0, from 1e-17 to 1e17, is right".into())
}

/// Parses a factor.
pub(super) fn positive(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|x: &f32| x.is_normal() && *x > 0.0).ok_or_else(|| "a number above 0 is right".into())
}

/// Parses a number of CPU seconds.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| *x > 0.0 && *x <= 86_400.0)
        .ok_or_else(|| "a number above 0, at most 86400, is right".into())
}

/// A pixel, as `10,20`.
pub(super) fn pixel(text: &str) -> Result<(u32, u32), String> {
    let parsed = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    parsed.ok_or_else(|| "two whole numbers are right, as 10,20".into())
}
