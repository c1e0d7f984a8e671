//! Where light is to be measured: a point that the camera sees.

use glam::Vec3;

/// A visible point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Where it is, in metres.
    pub position: Vec3,
    /// Unit geometric normal on the viewer's side.
    pub normal: Vec3,
    /// Unit direction towards the viewer.
    pub view: Vec3,
    /// Share of light that is reflected, per channel.
    pub albedo: Vec3,
    /// The pixel that sees it: `y * width + x`.
    pub pixel: u32,
    /// The surface it lies on.
    pub surface: u32,
}
