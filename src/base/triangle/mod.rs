//! Triangles: what one receiver sees of them, and points on them.
//!
//! A triangle is [`Seen`] from a receiver at the origin. What it is, is evaluated in closed form:
//! [`Seen::solid_angle`], [`Seen::irradiance`]. Points on it are drawn uniformly over its area ([`uniform_point`]),
//! over its solid angle ([`SolidAngle`]) or over its irradiance ([`Projected`]); all give
//! barycentric weights `(b1, b2)` of the second and third corner, so that a point never leaves the triangle however far
//! away it is. The density of a sampler is one over the closed form, exactly: nothing else has to be evaluated, and
//! nothing can disagree.
//!
//! All runs in f64. Corners are relative to the receiver, in any unit; those that are differences of f32 numbers keep
//! all their digits.

mod angles;
mod area;
mod irradiance;
mod nearest;
mod projected;
mod seen;
mod solid_angle;

pub(crate) use area::{CENTROID, uniform_point};
pub(crate) use nearest::nearest_squared;
pub(crate) use projected::Projected;
pub(crate) use seen::Seen;
pub(crate) use solid_angle::SolidAngle;
