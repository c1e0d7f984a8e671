//! Which lights do nodes carry?
//!
//! `KHR_lights_punctual`: candela and lux as they stand, colours linear, a node's -z the direction in which it shines.

use super::document::{Cones, PunctualLight};
use super::nodes::{Placed, turned, within};
use super::reader::Reader;
use crate::base::error::Result;
use crate::scene::light::Shape;
use crate::sources::limits::{BRIGHTEST, FARTHEST, NARROWEST_CONE};
use glam::{DVec3, Vec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::fmt::Display;

/// How far a right angle may lie above itself: it is in f32, and some exporters cut digits off.
const RIGHT_ANGLE_ROUNDING: f64 = 1e-5;

/// How far an angle may lie beside another that it should reach, as a share: digits that an exporter cut off.
const ANGLE_ROUNDING: f64 = 1e-6;

/// The inner and the outer half-angle of a spot, in radians.
fn angles(cones: Option<&Cones>) -> (f64, f64) {
    let given = |angle: fn(&Cones) -> Option<f64>| cones.and_then(angle);
    (given(|cones| cones.inner_cone_angle).unwrap_or(0.0), given(|cones| cones.outer_cone_angle).unwrap_or(FRAC_PI_4))
}

/// Whether a spot is narrower than can be rendered; Blender's least angle, 1 degree in f32, is not.
pub(super) fn is_narrow(cones: Option<&Cones>) -> bool {
    angles(cones).1 < NARROWEST_CONE.to_radians() * (1.0 - ANGLE_ROUNDING)
}

/// Flux over peak intensity of a spot of these half-angles, over 2 pi: the squared linear ramp holds a third of its cone.
fn solid_angle([inner, outer]: [f64; 2]) -> f64 {
    // Differences of cosines, which lose their digits in a narrow cone.
    let ramp = 2.0 * (0.5 * (outer + inner)).sin() * (0.5 * (outer - inner)).sin();
    2.0 * (0.5 * inner).sin().powi(2) + ramp / 3.0
}

impl Reader<'_> {
    /// The light of a node, if it carries one, with its place relative to `origin` and its strength divided.
    pub(super) fn punctual(&self, node: &Placed, origin: DVec3, divided_by: f64) -> Result<Option<Shape>> {
        let id = node.id;
        let Some(light) = &self.document.nodes[id as usize].extensions.light else { return Ok(None) };
        let (lights, number) = (&self.document.extensions.punctual.lights, light.light);
        let field = || format!("nodes[{id}].extensions.KHR_lights_punctual.light");
        let light = lights.get(number as usize).ok_or_else(|| self.no_such("light", number, lights.len(), &field()))?;
        let intensity = self.intensity(number, light, divided_by)?;
        if light.kind == "directional" {
            return Ok(Some(Shape::Directional { towards: -self.axis(node)?, irradiance: intensity }));
        }
        let position = turned(node.to_world.translation) - origin;
        if !within(position, FARTHEST) {
            let text =
                format!("the light stands at {position} from the scene's middle {origin}; {FARTHEST} m is the most");
            return Err(self.wrong(format_args!("nodes[{id}]"), text));
        }
        let position = position.as_vec3();
        match light.kind.as_str() {
            "point" => Ok(Some(Shape::Point { position, intensity })),
            "spot" => {
                let ([cos_inner, cos_outer], share) = self.cones(number, light.spot.as_ref())?;
                let intensity = intensity * share;
                Ok(Some(Shape::Spot { position, axis: self.axis(node)?, intensity, cos_inner, cos_outer }))
            }
            other => {
                let text = format_args!("\"{other}\" is given; point, spot or directional is asked for");
                Err(self.wrong_light(number, "type", &text))
            }
        }
    }

    /// Intensity in cd, or irradiance in lx.
    fn intensity(&self, number: u32, light: &PunctualLight, divided_by: f64) -> Result<Vec3> {
        let (colour, intensity) = (DVec3::from_array(light.color.unwrap_or([1.0; 3])), light.intensity.unwrap_or(1.0));
        if colour.min_element() < 0.0 {
            return Err(self.wrong_light(number, "color", &format_args!("{colour} is given; 0 or more is asked for")));
        }
        let product = colour * intensity / divided_by;
        if !(intensity >= 0.0 && product.max_element() <= BRIGHTEST) {
            let text =
                format_args!("{intensity} is given; 0 or more is asked for, and at most {BRIGHTEST} with its colour");
            return Err(self.wrong_light(number, "intensity", &text));
        }
        Ok(product.as_vec3())
    }

    /// The cosines of the inner and the outer cone, and what share of its intensity a spot has left: one that is narrower
    /// than can be rendered is widened, its flux kept.
    fn cones(&self, number: u32, cones: Option<&Cones>) -> Result<([f32; 2], f32)> {
        let (inner, outer) = angles(cones);
        if !(outer > 0.0 && outer <= FRAC_PI_2 + RIGHT_ANGLE_ROUNDING) {
            let text = format_args!(
                "{outer} is given; a half-angle above 0, up to {FRAC_PI_2:.4} radians (90 degrees), is asked for"
            );
            return Err(self.wrong_light(number, "spot.outerConeAngle", &text));
        }
        if !(inner >= 0.0 && inner <= outer * (1.0 + ANGLE_ROUNDING)) {
            let text = format_args!("{inner} is given; 0 or more, and less than the outer {outer}, is asked for");
            return Err(self.wrong_light(number, "spot.innerConeAngle", &text));
        }
        let inner = inner.min(outer);
        let (inner, outer, share) = if is_narrow(cones) {
            let wider = NARROWEST_CONE.to_radians() / outer;
            let widened = [inner * wider, outer * wider];
            (widened[0], widened[1], solid_angle([inner, outer]) / solid_angle(widened))
        } else {
            (inner, outer, 1.0)
        };
        let [cos_inner, cos_outer] = [inner, outer].map(|angle| angle.cos().max(0.0) as f32);
        // Blender writes both angles alike for a hard edge: the steepest ramp that f32 has.
        Ok(([cos_inner.max(cos_outer.next_up()), cos_outer], share as f32))
    }

    /// The direction in which a node's light shines.
    fn axis(&self, node: &Placed) -> Result<Vec3> {
        let axis = turned(-node.to_world.matrix3.z_axis).try_normalize();
        let axis = axis.filter(|axis| axis.is_finite()).map(DVec3::as_vec3);
        axis.ok_or_else(|| {
            let text = "its light has no direction: the node or one above it is scaled to nothing, or to more than f64";
            self.wrong(format_args!("nodes[{}]", node.id), text)
        })
    }

    fn wrong_light(&self, number: u32, name: &str, message: &dyn Display) -> crate::base::error::Error {
        self.wrong(format_args!("extensions.KHR_lights_punctual.lights[{number}].{name}"), message)
    }
}
