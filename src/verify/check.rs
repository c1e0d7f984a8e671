//! What did one check find?

use crate::scene::light::LightId;
use std::fmt;

/// What one check found.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Its name: `weights`.
    pub name: &'static str,
    /// What was found; compared with [`limit`](Self::limit).
    pub statistic: f64,
    /// The greatest statistic that passes.
    pub limit: f64,
    /// Whether it passed.
    pub passed: bool,
    /// What the statistic is, and what it could have found.
    pub detail: String,
    /// The pixel where it was greatest, if it is of one.
    pub pixel: Option<u32>,
    /// The light of which it was greatest, if it is of one.
    pub light: Option<LightId>,
}

impl Check {
    pub(super) fn new(name: &'static str, statistic: f64, limit: f64, detail: String) -> Self {
        // Not a number is a failure.
        Self { name, statistic, limit, passed: statistic <= limit, detail, pixel: None, light: None }
    }

    /// The same with the place where the statistic was greatest.
    pub(super) fn at(self, pixel: Option<u32>, light: Option<LightId>) -> Self {
        Self { pixel, light, ..self }
    }

    /// ` at pixel 7, light 3`; empty where there is no place.
    pub fn place(&self) -> String {
        match (self.pixel, self.light) {
            (Some(pixel), Some(light)) => format!(" at pixel {pixel}, light {light}"),
            (Some(pixel), None) => format!(" at pixel {pixel}"),
            (None, Some(light)) => format!(" at light {light}"),
            (None, None) => String::new(),
        }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.passed { "pass" } else { "FAIL" };
        let Self { name, statistic, limit, detail, .. } = self;
        write!(f, "{verdict} {name:<14} {statistic:>11.4e} (limit {limit:.4e}){}  {detail}", self.place())
    }
}
