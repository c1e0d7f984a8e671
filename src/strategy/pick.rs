//! A chosen light, and where a sampler puts it.

use super::tally::Tally;
use crate::base::draws::Draws;
use crate::scene::light::LightId;

/// One chosen light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// Which light.
    pub light: LightId,
    /// What its contribution is multiplied with; finite and 0 or more, which `verify` checks (`weights-finite`).
    pub weight: f32,
    /// The point on it, in `[0, 1)^2`.
    pub uv: [f32; 2],
}

impl Pick {
    /// The harness draws the point.
    pub(crate) const DRAW: [f32; 2] = [-1.0, -1.0];

    /// Draws the point if that was left to the harness. `slot` is the place of the pick in its call.
    #[inline]
    pub(crate) fn settle(&mut self, slot: u32, draws: &mut Draws) {
        if self.uv == Self::DRAW {
            self.uv = draws.point(slot);
        }
    }
}

/// Where a sampler puts its picks and says what they took.
pub struct Picks<'a, T> {
    list: &'a mut Vec<Pick>,
    /// Counts the work of choosing.
    pub tally: &'a mut T,
}

impl<'a, T: Tally> Picks<'a, T> {
    /// Appends to `list`.
    pub fn new(list: &'a mut Vec<Pick>, tally: &'a mut T) -> Self {
        Self { list, tally }
    }

    /// Picks a light; the harness draws the point on it.
    #[inline]
    pub fn push(&mut self, light: LightId, weight: f32) {
        self.list.push(Pick { light, weight, uv: Pick::DRAW });
    }

    /// Picks a point of a light; `uv` in `[0, 1)^2`.
    #[inline]
    pub fn push_at(&mut self, light: LightId, weight: f32, uv: [f32; 2]) {
        self.list.push(Pick { light, weight, uv });
    }
}
