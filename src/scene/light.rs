//! What a light is: its shape, its units, its flux, its peak.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::f32::consts::PI;

/// A light's place in the scene's table.
pub type LightId = u32;

/// The kinds of light, as stored in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Kind {
    /// Radiates alike in all directions from a point.
    Point = 0,
    /// A point with a cone.
    Spot = 1,
    /// So far away that its direction is the same everywhere: the moon.
    Directional = 2,
    /// A one-sided Lambertian emitter.
    Triangle = 3,
}

impl Kind {
    /// All kinds, in table order.
    pub const ALL: [Self; 4] = [Self::Point, Self::Spot, Self::Directional, Self::Triangle];

    /// The bit that stands for this kind in a set of kinds.
    pub const fn bit(self) -> u8 {
        1 << self as u32
    }

    /// The field's name for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Spot => "spot",
            Self::Directional => "directional",
            Self::Triangle => "triangle",
        }
    }
}

/// A light as people think of it. Lengths in metres, colours linear Rec. 709.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A point light.
    Point {
        /// Where it is.
        position: Vec3,
        /// Intensity in cd.
        intensity: Vec3,
    },
    /// A point light with the cone of `KHR_lights_punctual`: full intensity within the inner cone, the squared linear
    /// ramp in the cosine between the cones, nothing outside.
    Spot {
        /// Where it is.
        position: Vec3,
        /// Unit vector along which it shines.
        axis: Vec3,
        /// Peak intensity in cd.
        intensity: Vec3,
        /// Cosine of the inner half-angle; greater than `cos_outer`.
        cos_inner: f32,
        /// Cosine of the outer half-angle; 0 or more (at most a hemisphere).
        cos_outer: f32,
    },
    /// A directional light.
    Directional {
        /// Unit vector towards the light.
        towards: Vec3,
        /// Irradiance on a surface that faces it, in lx.
        irradiance: Vec3,
    },
    /// A triangle that emits from its front, the side from which its corners run counter-clockwise.
    Triangle {
        /// The corners.
        corners: [Vec3; 3],
        /// Radiance in cd/m^2.
        radiance: Vec3,
    },
}

/// A light in the table: one cache line of 64 bytes.
///
/// | kind | `colour` | `position` | `a` | `b` | `c` |
/// |---|---|---|---|---|---|
/// | point | cd | where | | | |
/// | spot | cd at the peak | where | unit axis | (scale, offset, cos outer) of the cone | (cos inner, 0, 0) |
/// | directional | lx | unit vector towards it | | | |
/// | triangle | cd/m^2 | first corner | edge to the second | edge to the third | `a x b`: front normal, twice the area long |
#[derive(Clone, Copy, Debug, Pod, Zeroable, PartialEq)]
#[repr(C, align(64))]
pub struct Light {
    pub(crate) colour: Vec3,
    kind: u32,
    pub(crate) position: Vec3,
    pub(crate) a: Vec3,
    pub(crate) b: Vec3,
    pub(crate) c: Vec3,
}

impl From<Shape> for Light {
    fn from(shape: Shape) -> Self {
        let blank = Self { kind: 0, ..Self::zeroed() };
        match shape {
            Shape::Point { position, intensity } => {
                Self { colour: intensity, kind: Kind::Point as u32, position, ..blank }
            }
            Shape::Spot { position, axis, intensity, cos_inner, cos_outer } => {
                // A checked scene has cones at least one step of f32 apart, which this leaves alone. The extension's
                // own guard of 1e-3 would dim each cone narrower than 2.6 degrees.
                let scale = 1.0 / (cos_inner - cos_outer).max(0.5 * f32::EPSILON);
                Self {
                    colour: intensity,
                    kind: Kind::Spot as u32,
                    position,
                    a: axis,
                    b: Vec3::new(scale, -cos_outer * scale, cos_outer),
                    c: Vec3::new(cos_inner, 0.0, 0.0),
                }
            }
            Shape::Directional { towards, irradiance } => {
                Self { colour: irradiance, kind: Kind::Directional as u32, position: towards, ..blank }
            }
            Shape::Triangle { corners: [p, q, r], radiance } => {
                let (a, b) = (q - p, r - p);
                Self { colour: radiance, kind: Kind::Triangle as u32, position: p, a, b, c: a.cross(b) }
            }
        }
    }
}

impl Light {
    /// The kind.
    #[inline]
    pub fn kind(&self) -> Kind {
        match self.kind {
            0 => Kind::Point,
            1 => Kind::Spot,
            2 => Kind::Directional,
            _ => Kind::Triangle,
        }
    }

    /// The light in words.
    pub fn shape(&self) -> Shape {
        match self.kind() {
            Kind::Point => Shape::Point { position: self.position, intensity: self.colour },
            Kind::Spot => Shape::Spot {
                position: self.position,
                axis: self.a,
                intensity: self.colour,
                cos_inner: self.c.x,
                cos_outer: self.b.z,
            },
            Kind::Directional => Shape::Directional { towards: self.position, irradiance: self.colour },
            Kind::Triangle => Shape::Triangle { corners: self.corners(), radiance: self.colour },
        }
    }

    /// Cone attenuation of a spot towards the unit direction `from_light`; 1 within the inner cone, 0 outside the
    /// outer.
    #[inline]
    pub(crate) fn cone(&self, from_light: Vec3) -> f32 {
        let ramp = (self.a.dot(from_light) * self.b.x + self.b.y).clamp(0.0, 1.0);
        ramp * ramp
    }

    /// The corners of a triangle; meaningless for other kinds.
    #[inline]
    pub(crate) fn corners(&self) -> [Vec3; 3] {
        [self.position, self.position + self.a, self.position + self.b]
    }

    /// Area of a triangle in m^2; 0 for other kinds.
    pub fn area(&self) -> f32 {
        if self.kind() == Kind::Triangle { 0.5 * self.c.length() } else { 0.0 }
    }

    /// Greatest intensity in any direction, in cd per channel: `I`, or `L A` of a triangle; 0 for a directional light.
    pub fn peak_intensity(&self) -> Vec3 {
        match self.kind() {
            Kind::Point | Kind::Spot => self.colour,
            Kind::Triangle => self.colour * self.area(),
            Kind::Directional => Vec3::ZERO,
        }
    }

    /// Luminous flux in lm per channel. A directional light has one only for a scene of a given radius (in metres):
    /// irradiance times the area of the disc that the scene shows it.
    pub fn flux(&self, scene_radius: f32) -> Vec3 {
        match self.kind() {
            Kind::Point => self.colour * (4.0 * PI),
            Kind::Spot => self.colour * cone_flux(self.c.x, self.b.z),
            Kind::Directional => self.colour * (PI * scene_radius * scene_radius),
            Kind::Triangle => self.colour * (PI * self.area()),
        }
    }
}

/// Flux in lm of a spot whose peak is 1 cd, in sr: the cone's profile integrated over directions.
///
/// `2 pi ((1 - cos_inner) + (cos_inner - cos_outer) / 3)`: the ramp is linear in the cosine and squared.
pub(crate) fn cone_flux(cos_inner: f32, cos_outer: f32) -> f32 {
    2.0 * PI * ((1.0 - cos_inner) + (cos_inner - cos_outer) / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_is_one_cache_line() {
        assert_eq!(size_of::<Light>(), 64);
        assert_eq!(align_of::<Light>(), 64);
    }

    #[test]
    fn shapes_survive_the_table() {
        let shapes = [
            Shape::Point { position: Vec3::new(1.0, 2.0, 3.0), intensity: Vec3::new(4.0, 5.0, 6.0) },
            Shape::Spot { position: Vec3::X, axis: Vec3::NEG_Z, intensity: Vec3::ONE, cos_inner: 0.9, cos_outer: 0.25 },
            Shape::Directional { towards: Vec3::Z, irradiance: Vec3::splat(0.25) },
            Shape::Triangle { corners: [Vec3::ZERO, Vec3::X, Vec3::Y], radiance: Vec3::splat(50.0) },
        ];
        for shape in shapes {
            assert_eq!(Light::from(shape).shape(), shape);
        }
    }

    #[test]
    fn triangle_flux_is_pi_l_a() {
        let light = Light::from(Shape::Triangle { corners: [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y], radiance: Vec3::ONE });
        assert!((light.flux(1.0).x - PI).abs() < 1e-6);
        assert!((light.peak_intensity().x - 1.0).abs() < 1e-6);
    }
}
