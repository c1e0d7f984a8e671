//! Strings of bulbs over a rectangle.

use super::toml_table::Table;
use crate::base::error::Result;
use crate::scene::light::Shape;
use crate::sources::city::Bulbs;
use crate::sources::limits::FARTHEST;
use glam::{DVec2, DVec3};

/// Most bulbs in all of a recipe's strings.
const MOST_BULBS: f64 = 1e7;

/// Strings of bulbs over a rectangle.
pub(super) struct Strings {
    plan: Bulbs,
    centre: DVec2,
    size: DVec2,
    ground: f64,
}

impl Strings {
    /// The bulbs; `shift` is where the scene's origin lies.
    pub(super) fn bulbs(&self, shift: DVec3) -> Vec<Shape> {
        let low = self.centre - 0.5 * self.size - shift.truncate();
        self.plan.over(low, low + self.size, self.ground - shift.z)
    }
}

/// Reads all of a recipe.
pub(super) fn read(top: &Table) -> Result<Vec<Strings>> {
    let mut all = 0.0;
    let mut out = Vec::new();
    for table in top.tables("bulbs")? {
        let mut plan = Bulbs::default();
        table.fill_with(&mut plan, &["size", "centre", "ground"])?;
        let far = -FARTHEST..=FARTHEST;
        let strings = Strings {
            centre: table.pair("centre", far.clone(), "metres")?.unwrap_or_default(),
            size: table.needed_pair("size", 1.0..=1e5, "metres")?,
            ground: table.number("ground", far, "metres")?.unwrap_or(0.0),
            plan,
        };
        all += strings.plan.most(strings.size.x, strings.size.y);
        if all > MOST_BULBS {
            let text = format!("there would be about {all:.0} bulbs; at most {MOST_BULBS} are allowed in all strings");
            return Err(table.wrong("size", text));
        }
        out.push(strings);
    }
    Ok(out)
}
