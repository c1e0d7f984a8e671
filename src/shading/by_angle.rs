//! How does a receiver see a triangle light, and what is a point worth that is drawn by the angle it fills?
//!
//! Evaluated in f64: next to a light, or far from a thin one, f32 has no digits left.

use crate::base::triangle::{Projected, Seen, SolidAngle};
use crate::scene::light::Light;
use crate::scene::receiver::Receiver;
use glam::DVec3;

/// A point on a triangle, and what it is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Drawn {
    /// From the receiver to the point, in metres.
    pub(super) to_light: DVec3,
    /// Irradiance in lx that the point stands for, for a radiance of 1 cd/m^2.
    pub(super) irradiance: f64,
}

/// A triangle light as a receiver sees it.
#[inline]
pub(crate) fn seen(light: &Light, at: &Receiver) -> Seen {
    let first = light.position.as_dvec3() - at.position.as_dvec3();
    Seen::new([first, first + light.a.as_dvec3(), first + light.b.as_dvec3()])
}

/// The point that `uv` stands for, by solid angle or projected; `None` where nothing arrives. The receiver is in front.
#[inline(never)]
pub(super) fn by_angle(light: &Light, uv: [f32; 2], at: &Receiver, projected: bool) -> Option<Drawn> {
    let seen = seen(light, at);
    let (normal, uv) = (at.normal.as_dvec3(), uv.map(f64::from));
    let drawn = if projected {
        let map = Projected::new(&seen, normal)?;
        Drawn { to_light: seen.point(map.sample(uv)), irradiance: map.irradiance() }
    } else {
        let map = SolidAngle::new(&seen)?;
        let to_light = seen.point(map.sample(uv));
        Drawn { to_light, irradiance: map.solid_angle() * normal.dot(to_light) / to_light.length() }
    };
    // A receiver on an edge: a point that lies at the receiver has no direction.
    let distance2 = drawn.to_light.length_squared();
    (distance2 > 0.0 && distance2.is_finite()).then_some(drawn)
}
