//! How far, how bright, how narrow may things be, whatever the format?

/// Coordinates lie within this distance of the origin, in m: f32 has a metre there.
pub(super) const FARTHEST: f64 = 1e7;
/// The origin lies within this distance of the world's, in m: f64 has 0.1 mm there.
pub(super) const FARTHEST_ORIGIN: f64 = 1e12;
/// Greatest value of any photometric quantity: above that f32 would overflow on the way to a pixel.
pub(super) const BRIGHTEST: f64 = 1e15;
/// Least outer half-angle of a spot, in degrees: the cosines of its cone are 640 steps of f32.
pub(super) const NARROWEST_CONE: f64 = 0.5;
