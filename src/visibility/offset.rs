//! Where does a shadow ray start and end, so that neither end's own surface blocks it?

use super::triangle::Triangle;
use crate::scene::Scene;
use crate::scene::light::{Kind, Light};
use crate::scene::receiver::Receiver;
use glam::{Vec3, Vec3A};

/// A shadow-ray offset policy, as numbers: every policy runs through the same code.
///
/// The origin is pushed along the normal by `push`, by `push_relative` of the place's greatest coordinate, by
/// `push_in_scene` of the scene's, and by `ulps` units in the last place of each coordinate; hits nearer than `t_min` do
/// not count; the far end is shortened by `far`, by `far_relative` of the place's greatest coordinate and of the distance,
/// and by `push_in_scene` of the scene's. In metres and shares. With `horizons`, what lies behind an end's own plane is
/// passed over as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    push: f32,
    push_relative: f32,
    push_in_scene: f32,
    ulps: f32,
    t_min: f32,
    far: f32,
    far_relative: f32,
    horizons: bool,
}

impl Offset {
    /// The historical policy of the lecture: origin pushed by 1e-4 along the normal. Does nothing from 2,048 m on,
    /// where 1e-4 is less than half a unit in the last place.
    pub const ORIGIN_PUSH: Self = Self { push: 1e-4, far: 1e-4, ..Self::NONE };

    /// The modern policy of the lecture: the origin stays, hits nearer than 1e-4 are rejected.
    pub const T_MIN: Self = Self { t_min: 1e-4, far: 1e-4, ..Self::NONE };

    /// The origin pushed by 256 units in the last place of each coordinate times the normal's: 6 cm at 2 km, 2 m at 100
    /// km. The far end is shortened by as much.
    ///
    /// Source: Waechter and Binder, Ray Tracing Gems, 2019, ch. 6.
    pub const ULPS: Self = Self { ulps: 256.0, far: 1e-4, far_relative: 3.05e-5, ..Self::NONE };

    /// The default: a push of what rounding does to the place and to the scene, and no triangle blocks a ray that lies
    /// wholly behind the plane of the receiver or of the light.
    ///
    /// A receiver is rounded by at most 0.87 units, of 2^-23 of its greatest coordinate each (half of one on each
    /// axis), and so is a pushed origin. A push of two units (2.4 mm at 10 km) therefore ends above the surface,
    /// however the coordinates round: within 3.8 units. One unit of the scene's greatest coordinate is added (0.12 mm in a
    /// city of 1 km, 20 nm on a table of 16 cm): a ray that starts near the origin still meets triangles whose corners
    /// are rounded far away from it. The rest is up to the two planes, which no true ray between the ends crosses:
    /// neither an end's own triangle blocks it, nor a coplanar neighbour, nor what is behind an edge. A scene that is
    /// scaled by a power of two gives the same rays, scaled.
    pub const SCALED: Self =
        Self { push_relative: PUSH, push_in_scene: f32::EPSILON, far_relative: PUSH, horizons: true, ..Self::NONE };

    /// None at either end: wrong on purpose, to show what offsets are for. A ray starts at the receiver's position as it was
    /// rounded, on one side of its own surface or the other by chance, and ends on the light: half of all points are dark
    /// without reason, which is called acne.
    pub(crate) const NONE: Self = Self {
        push: 0.0,
        push_relative: 0.0,
        push_in_scene: 0.0,
        ulps: 0.0,
        t_min: 0.0,
        far: 0.0,
        far_relative: 0.0,
        horizons: false,
    };

    /// The policies that are right near the origin by name, default first.
    pub const NAMED: [(&'static str, Self); 4] =
        [("scaled", Self::SCALED), ("origin-push", Self::ORIGIN_PUSH), ("t-min", Self::T_MIN), ("ulps", Self::ULPS)];

    /// All policies that a user can name: the [right ones](Self::NAMED), then the one that is wrong on purpose.
    pub(crate) fn all() -> impl Iterator<Item = (&'static str, Self)> {
        Self::NAMED.into_iter().chain([("none", Self::NONE)])
    }

    /// The same policy with the far end left where it is: the light's own surface then blocks it. For tests.
    #[cfg(test)]
    pub(crate) const fn without_far(self) -> Self {
        Self { far: 0.0, far_relative: 0.0, push_in_scene: 0.0, horizons: false, ..self }
    }

    /// The policy of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|(known, _)| *known == name).map(|(_, policy)| policy)
    }

    /// The policy in a scene.
    pub fn in_scene(self, scene: &Scene) -> RayEnds {
        let (low, high) = scene.bounds();
        self.within(low.abs().max(high.abs()).max_element())
    }

    /// The policy in a scene whose greatest coordinate is so many metres; an empty scene has none.
    pub(crate) fn within(self, size: f32) -> RayEnds {
        let of_the_scene = if size.is_finite() { self.push_in_scene * size } else { 0.0 };
        RayEnds { policy: self, push: self.push + of_the_scene, far: self.far + of_the_scene }
    }
}

/// Where shadow rays start and end in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayEnds {
    policy: Offset,
    /// What is added at every place, in metres: at the start, along the normal, and at the end, along the ray.
    push: f32,
    far: f32,
}

impl RayEnds {
    /// The ray from a receiver to a point of `light`, `distance` metres away in a unit `direction`; infinite for the
    /// moon.
    ///
    /// It is aimed from where it starts. Shifted as a whole instead, it would cross a light's own plane short of its
    /// end by push / cosine: a panel was dark from 57 degrees off its axis on (`tests/statistics/closed_forms.rs`). Lengths are
    /// those from the receiver, which differ from those from the origin by the push at most.
    #[inline]
    pub fn segment(&self, at: &Receiver, light: &Light, direction: Vec3, distance: f32) -> Segment {
        let Offset { t_min, far_relative, horizons, .. } = self.policy;
        let size = at.position.abs().max_element();
        let origin = self.start(at);
        let near = if horizons { at.normal } else { Vec3::ZERO };
        if distance == f32::INFINITY {
            // Infinity less a share of infinity is no number, and nothing is nearer than that.
            let (along, far, short) = (direction, Vec3::ZERO, 0.0);
            return Segment { origin, along, t_min, t_max: f32::INFINITY, near, far, short };
        }
        let far = if horizons && light.kind() == Kind::Triangle { light.c } else { Vec3::ZERO };
        let along = direction * distance - (origin - at.position);
        let shares = 1.0 / distance;
        let short = self.far + far_relative * (size + distance);
        Segment { origin, along, t_min: t_min * shares, t_max: 1.0 - short * shares, near, far, short }
    }

    /// Where a ray from a receiver starts.
    #[inline]
    pub(super) fn start(&self, at: &Receiver) -> Vec3 {
        let Offset { push_relative, ulps, .. } = self.policy;
        let size = at.position.abs().max_element();
        let origin = at.position + at.normal * (self.push + push_relative * size);
        if ulps > 0.0 { stepped(origin, at.normal * ulps) } else { origin }
    }
}

/// Two units in the last place of a coordinate, as a share of it; up to four where its mantissa is near 2.
const PUSH: f32 = 2.0 * f32::EPSILON;

/// Bound on the relative error of a dot product of rounded numbers, and of the normal in it.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// How far a height over any plane may be off in a scene of that size, in metres: of a corner and two edges, on three
/// axes; and as much again for the place where a ray met it.
pub(super) fn rounding(size: Vec3) -> f32 {
    2.0 * 3.0 * ROUNDING * size.element_sum()
}

/// Each coordinate moved by so many units in its last place. Near 0, where these vanish, `steps` of 256 stand for 2^-16
/// m.
#[inline]
fn stepped(place: Vec3, steps: Vec3) -> Vec3 {
    const SMALL: f32 = 1.0 / 32.0;
    let step = |x: f32, steps: f32| {
        if x.abs() < SMALL {
            return x + steps * (1.0 / 16_777_216.0);
        }
        // Bits of one sign are in the order of magnitudes.
        let away = if x < 0.0 { -steps } else { steps };
        f32::from_bits(x.to_bits().wrapping_add_signed(away as i32))
    };
    Vec3::new(step(place.x, steps.x), step(place.y, steps.y), step(place.z, steps.z))
}

/// A shadow ray: nothing may lie on `origin + t along` for `t` within `[t_min, t_max)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it starts, in metres.
    pub origin: Vec3,
    /// All the way to its end; a unit vector towards what is infinitely far.
    pub along: Vec3,
    /// Hits nearer than this share of the way do not count.
    pub t_min: f32,
    /// Hits from this share of the way on do not count.
    pub t_max: f32,
    /// Normal of the plane through `origin` that the whole way lies before; zero if there is none.
    near: Vec3,
    /// Normal, of any length, of the plane through its end that the whole way lies before; zero if there is none.
    far: Vec3,
    /// How far before that plane things still count as behind it, in metres.
    short: f32,
}

impl Segment {
    /// A segment that everything on it blocks.
    pub fn bare(origin: Vec3, along: Vec3, t_min: f32, t_max: f32) -> Self {
        Self { origin, along, t_min, t_max, near: Vec3::ZERO, far: Vec3::ZERO, short: 0.0 }
    }

    /// Whether a triangle that was met at `t` lies wholly behind the plane of an end, so that no true ray meets it
    /// before that end. Heights of the whole scene are off by at most `rounding` m: above that, the meeting place alone
    /// says no.
    #[inline]
    pub(super) fn passes_over(&self, triangle: &Triangle, t: f32, rounding: f32) -> bool {
        let corners = || triangle.corners().map(|corner| corner - Vec3A::from(self.origin));
        let over_near = t * self.near.dot(self.along);
        let over_far = (t - 1.0) * self.far.dot(self.along);
        over_near < rounding && is_behind(self.near, 0.0, corners())
            || over_far < (self.short + rounding) * self.far.abs().element_sum()
                && is_behind(self.far, self.short, corners().map(|corner| corner - Vec3A::from(self.along)))
    }
}

/// Whether a triangle, its corners given from a point of a plane, lies nowhere `margin` or more metres before the plane,
/// but for rounding; false without a plane.
///
/// Rounding grows with what goes into the heights: with the parts along the normal, so that a level ground has almost
/// none.
#[inline]
fn is_behind(normal: Vec3, margin: f32, [a, b, c]: [Vec3A; 3]) -> bool {
    let normal = Vec3A::from(normal);
    let highest = normal.dot(a).max(normal.dot(b)).max(normal.dot(c));
    let parts = a.abs() + (a - b).abs() + (c - a).abs();
    highest < margin * normal.length() + ROUNDING * normal.abs().dot(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_256_are_as_large_as_their_authors_say() {
        let up = |x: f32| stepped(Vec3::splat(x), Vec3::Z * 256.0).z - x;
        assert_eq!(up(2_048.0), 0.0625, "6 cm at 2 km");
        assert_eq!(up(100_000.0), 2.0, "2 m at 100 km");
        assert_eq!(up(-100_000.0), 2.0, "along the normal on the other side of 0 too");
        assert_eq!(up(0.0), 1.0 / 65_536.0);
        assert_eq!(stepped(Vec3::splat(2_048.0), Vec3::Z * 256.0).x, 2_048.0);
    }

    #[test]
    fn no_offset_starts_at_the_rounded_point_and_ends_on_the_light() {
        let position = Vec3::new(1_234.5, -6.7, 0.1);
        let at = Receiver { position, normal: Vec3::Z, view: Vec3::Z, albedo: Vec3::ONE, pixel: 0, surface: 0 };
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let light = Light::from(crate::scene::light::Shape::Triangle { corners, radiance: Vec3::ONE });
        let none = Offset::named("none").expect("a name");
        assert_eq!(
            none.within(2e3).segment(&at, &light, Vec3::Z, 2.0),
            Segment::bare(position, Vec3::Z * 2.0, 0.0, 1.0)
        );
        assert!(Offset::NAMED.iter().all(|(_, offset)| *offset != none), "what is right near the origin is not this");
    }

    #[test]
    fn a_push_of_two_units_ends_above_the_surface_however_it_rounds() {
        use crate::base::random::Stream;
        let mut stream = Stream::keyed(&[1]);
        let mut signed = |half: f64| (stream.uniform64() * 2.0 - 1.0) * half;
        for i in 0..100_000 {
            let place = glam::DVec3::new(signed(1.0), signed(1.0), signed(1.0)) * 10f64.powi(i % 7);
            let normal = glam::DVec3::new(signed(1.0), signed(1.0), signed(1.0)).normalize();
            let at = Receiver {
                position: place.as_vec3(),
                normal: normal.as_vec3(),
                view: Vec3::Z,
                albedo: Vec3::ONE,
                pixel: 0,
                surface: 0,
            };
            let light = Light::from(crate::scene::light::Shape::Point { position: Vec3::ZERO, intensity: Vec3::ONE });
            let size = 10f32.powi(i % 7);
            let origin = Offset::SCALED.within(size).segment(&at, &light, Vec3::Z, 1.0).origin.as_dvec3();
            let height = (origin - place).dot(normal);
            let [unit, most] = [place.abs().max_element(), f64::from(size)].map(|x| x * f64::from(f32::EPSILON));
            assert!(height > 0.0 && (origin - place).length() < most + 4.0 * unit, "{place}: {height}, unit {unit}");
        }
    }
}
