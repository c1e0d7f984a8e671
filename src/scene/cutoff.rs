//! How far does a light reach before it falls under the display's smallest step?
//!
//! The lecture's cut-off, written on the displayed value: a light is in range where its displayed contribution, with
//! the receiver facing it and as bright as the scene's brightest material, is at least `T`; 0.5/255 for a linear
//! display. Each light that is left out is invisible alone. Their sum is not: dropping them is a bias.

use super::Scene;
use super::light::{Kind, Light, LightId};
use glam::Vec3;
use std::f32::consts::PI;

/// How displayed values become the 256 steps of a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// Steps are equal in displayed value.
    Linear,
    /// Steps follow the sRGB curve, whose slope in the dark is 12.92: a step is that much smaller.
    Srgb,
}

/// What turns a light into its influence volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutoff {
    /// `exposure * albedo / (pi * T)` per channel, in m^2/cd: squared range of a light of 1 cd.
    range2_per_candela: Vec3,
    /// No radius is longer, in m: twice the scene's diameter, so that a volume at the limit holds the whole scene.
    /// Without it a dark enough exposure or a bright enough light makes radii, and sums over them, infinite.
    longest: f32,
}

/// Radii end here in scenes beyond all measure: its square is finite in f32.
const LONGEST: f32 = 1e18;

impl Cutoff {
    /// The cut-off at `steps` display steps (the lecture's is 0.5) of a scene.
    pub fn new(scene: &Scene, steps: f32, transfer: Transfer) -> Self {
        let slope = match transfer {
            Transfer::Linear => 1.0,
            Transfer::Srgb => 12.92,
        };
        let threshold = steps / 255.0 / slope;
        let albedo = scene.materials().iter().fold(Vec3::ZERO, |most, material| most.max(material.albedo));
        Self {
            range2_per_candela: albedo * (scene.exposure() / (PI * threshold)).min(f32::MAX),
            longest: (4.0 * scene.radius()).min(LONGEST),
        }
    }

    /// The square of a radius that holds the whole scene, in m^2: longer ones change nothing.
    pub(crate) fn longest2(&self) -> f32 {
        self.longest * self.longest
    }

    /// The volumes of some lights of a scene, and the lights that have none: those in range everywhere.
    pub(crate) fn volumes(&self, scene: &Scene, lights: &[LightId]) -> (Vec<(Influence, LightId)>, Vec<LightId>) {
        let mut everywhere = Vec::new();
        let mut volumes = Vec::with_capacity(lights.len());
        for &id in lights {
            match self.volume(&scene.lights()[id as usize]) {
                Some(volume) => volumes.push((volume, id)),
                None => everywhere.push(id),
            }
        }
        (volumes, everywhere)
    }

    /// The volume in which `light` is in range; `None` for a directional light, which is in range everywhere.
    pub fn volume(&self, light: &Light) -> Option<Influence> {
        let range2 = (self.range2_per_candela * light.peak_intensity()).max_element().min(self.longest2());
        match light.kind() {
            Kind::Point => Some(Influence { centre: light.position, radius2: range2, axis: Vec3::ZERO }),
            Kind::Spot => Some(Influence { centre: light.position, radius2: range2, axis: light.a }),
            Kind::Triangle => {
                let corners = light.corners();
                let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
                let bound = corners.iter().map(|c| c.distance(centre)).fold(0.0, f32::max);
                let radius = (bound + range2.sqrt()).min(self.longest);
                Some(Influence { centre, radius2: radius * radius, axis: light.c.normalize_or_zero() })
            }
            Kind::Directional => None,
        }
    }
}

/// A light's influence volume: a ball, or the half of it on one side of a plane through its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// The ball's centre.
    pub centre: Vec3,
    /// Squared radius in m^2.
    pub radius2: f32,
    /// The side that is lit: unit direction, or zero where all sides are.
    pub axis: Vec3,
}

impl Influence {
    /// Whether a point is in range.
    #[inline]
    pub fn contains(&self, point: Vec3) -> bool {
        let to_point = point - self.centre;
        to_point.length_squared() <= self.radius2 && self.axis.dot(to_point) >= 0.0
    }

    /// Corners of the smallest axis-aligned box around the volume, but for rounding.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let radius = self.radius2.sqrt();
        // A half ball reaches `radius` on the axis' side and the rim of its flat face on the other.
        // From the other two components: 1 - x^2 has no digits left where x is nearly 1, and the box would miss 3 cm
        // of a ball of 100 m.
        let Vec3 { x, y, z } = self.axis;
        let rim = Vec3::new(y.hypot(z), z.hypot(x), x.hypot(y));
        let full = self.axis == Vec3::ZERO;
        let reach = |sign: f32| {
            let towards = self.axis * sign;
            Vec3::select(towards.cmpge(Vec3::ZERO) | glam::BVec3::splat(full), Vec3::ONE, rim) * radius
        };
        (self.centre - reach(-1.0), self.centre + reach(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    #[test]
    fn bounds_hold_the_rim_of_a_nearly_upright_half() {
        let volume = Influence { centre: Vec3::ZERO, radius2: 1e4, axis: Vec3::new(1.0, 3e-4, 0.0) };
        let rim = Vec3::new(-0.02, 99.9, 0.0);
        assert!(volume.contains(rim));
        let (low, high) = volume.bounds();
        assert!(rim.cmpge(low).all() && rim.cmple(high).all(), "{rim} outside {low}..{high}");
    }

    #[test]
    fn bounds_hold_every_point_of_the_volume() {
        let mut stream = Stream::keyed(&[21]);
        let mut signed = || stream.uniform() * 2.0 - 1.0;
        for _ in 0..200 {
            let axis = Vec3::new(signed(), signed(), signed()).normalize();
            let volume = Influence { centre: Vec3::new(signed(), signed(), signed()), radius2: 4.0, axis };
            let (low, high) = volume.bounds();
            for _ in 0..200 {
                let p = volume.centre + Vec3::new(signed(), signed(), signed()) * 2.0;
                if volume.contains(p) {
                    assert!(
                        p.cmpge(low - 1e-5).all() && p.cmple(high + 1e-5).all(),
                        "{p} outside {low}..{high}, axis {axis}"
                    );
                }
            }
        }
    }
}
