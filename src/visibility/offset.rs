//! Where does a shadow ray start and end, so that neither end's own surface blocks it?

use crate::scene::receiver::Receiver;
use glam::Vec3;

/// A shadow-ray offset policy, as numbers: every policy runs through the same code.
///
/// The origin is pushed along the normal by `push + push_relative * max|coordinate|`; hits nearer than `t_min` do not
/// count; the far end is shortened by `far + far_relative * (max|coordinate| + distance)`. All in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    push: f32,
    push_relative: f32,
    t_min: f32,
    far: f32,
    far_relative: f32,
}

impl Offset {
    /// The historical policy of the lecture: origin pushed by 1e-4 along the normal. Does nothing from 2,048 m on,
    /// where 1e-4 is less than half a unit in the last place.
    pub const ORIGIN_PUSH: Self = Self { push: 1e-4, push_relative: 0.0, t_min: 0.0, far: 1e-4, far_relative: 0.0 };

    /// The modern policy of the lecture: the origin stays, hits nearer than 1e-4 are rejected.
    pub const T_MIN: Self = Self { push: 0.0, push_relative: 0.0, t_min: 1e-4, far: 1e-4, far_relative: 0.0 };

    /// The default: the lecture's push, grown with the coordinate. A receiver is rounded by half a unit in the last
    /// place, 2^-24 of its coordinate; the push is 16 times that (1 cm at 10 km). The far end is shortened by 64 times
    /// that (4 cm at 10 km): at grazing incidence the hit's distance is less certain than its place.
    pub const SCALED: Self = Self { push: 1e-4, push_relative: 9.54e-7, t_min: 0.0, far: 1e-4, far_relative: 3.81e-6 };

    /// The policies by name, default first.
    pub const NAMED: [(&'static str, Self); 3] =
        [("scaled", Self::SCALED), ("origin-push", Self::ORIGIN_PUSH), ("t-min", Self::T_MIN)];

    /// The same policy with the far end left where it is: the light's own surface then blocks it. For tests.
    pub const fn without_far(self) -> Self {
        Self { far: 0.0, far_relative: 0.0, ..self }
    }

    /// The policy of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMED.iter().find(|(known, _)| *known == name).map(|(_, policy)| *policy)
    }

    /// The ray from a receiver to something `distance` metres away in a unit `direction`; infinite for the moon.
    ///
    /// It is aimed from where it starts. Shifted as a whole instead, it would cross a light's own plane short of its
    /// end by push / cosine: a panel was dark from 57 degrees off its axis on (`tests/closed_forms.rs`).
    #[inline]
    pub fn segment(&self, at: &Receiver, direction: Vec3, distance: f32) -> Segment {
        let size = at.position.abs().max_element();
        let origin = at.position + at.normal * (self.push + self.push_relative * size);
        if distance == f32::INFINITY {
            // Infinity less a share of infinity is no number, and nothing is nearer than that.
            return Segment { origin, direction, t_min: self.t_min, t_max: f32::INFINITY };
        }
        let to_end = direction * distance - (origin - at.position);
        let distance = to_end.length();
        let t_max = distance - (self.far + self.far_relative * (size + distance));
        Segment { origin, direction: to_end / distance, t_min: self.t_min, t_max }
    }
}

/// A shadow ray: nothing may lie on it within `[t_min, t_max)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit vector along it.
    pub direction: Vec3,
    /// Hits nearer than this do not count, in metres.
    pub t_min: f32,
    /// Hits from here on do not count, in metres.
    pub t_max: f32,
}
