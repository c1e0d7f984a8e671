//! Lights without extent: `KHR_lights_punctual`.
//!
//! Each is a node that bears the name of its group. Equal lights share one entry, whatever their place.

use super::factored::factored;
use super::place::{place, rotation, turned};
use crate::base::error::Result;
use crate::export::meshes::groups;
use crate::scene::Scene;
use crate::scene::light::Shape;
use ::gltf::json::extensions::root::{KhrLightsPunctual as Entries, Root as RootExtensions};
use ::gltf::json::extensions::scene::Node as NodeExtensions;
use ::gltf::json::extensions::scene::khr_lights_punctual::{KhrLightsPunctual, Light, Spot, Type};
use ::gltf::json::{self, Index, Root, validation::Checked};
use glam::{DQuat, DVec3, Vec3};
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// Adds the nodes of all lights that have a place or a direction alone.
pub(super) fn add(scene: &Scene, root: &mut Root) -> Result<()> {
    let mut lights = Vec::new();
    let mut known = HashMap::new();
    for (light, group) in scene.lights().iter().zip(groups(scene)) {
        let (position, axis, entry) = match light.shape() {
            Shape::Point { position, intensity } => (position, None, entry(Type::Point, intensity, None)?),
            Shape::Spot { position, axis, intensity, cos_inner, cos_outer } => {
                (position, Some(axis), entry(Type::Spot, intensity, Some(cone(cos_inner, cos_outer)))?)
            }
            Shape::Directional { towards, irradiance } => {
                (Vec3::ZERO, Some(-towards), entry(Type::Directional, irradiance, None)?)
            }
            Shape::Triangle { .. } => continue,
        };
        let light = *known.entry(key(&entry)).or_insert_with(|| {
            lights.push(entry);
            Index::new(lights.len() as u32 - 1)
        });
        root.nodes.push(json::Node {
            name: Some(group.to_owned()),
            translation: (position != Vec3::ZERO).then(|| place(position)),
            rotation: axis
                .map(|axis| rotation(DQuat::from_rotation_arc(DVec3::NEG_Z, turned(axis.as_dvec3()).normalize()))),
            extensions: Some(NodeExtensions {
                khr_lights_punctual: Some(KhrLightsPunctual { light }),
                ..NodeExtensions::default()
            }),
            ..json::Node::default()
        });
    }
    if !lights.is_empty() {
        root.extensions =
            Some(RootExtensions { khr_lights_punctual: Some(Entries { lights }), ..RootExtensions::default() });
    }
    Ok(())
}

fn entry(kind: Type, colour: Vec3, spot: Option<Spot>) -> Result<Light> {
    let (color, intensity) = factored(colour)?;
    Ok(Light {
        color,
        intensity,
        spot,
        type_: Checked::Valid(kind),
        extensions: None,
        extras: None,
        name: None,
        range: None,
    })
}

/// The half-angles of a cone in radians, apart and at most a quarter turn after rounding.
fn cone(cos_inner: f32, cos_outer: f32) -> Spot {
    let angle = |cos: f32| f64::from(cos).clamp(0.0, 1.0).acos() as f32;
    let mut outer = angle(cos_outer);
    if f64::from(outer) > FRAC_PI_2 {
        outer = outer.next_down();
    }
    let inner = angle(cos_inner).min(outer.next_down());
    Spot { inner_cone_angle: inner, outer_cone_angle: outer }
}

/// What makes two entries equal.
fn key(light: &Light) -> [u32; 7] {
    let kind = match light.type_ {
        Checked::Valid(kind) => kind as u32,
        Checked::Invalid => 0,
    };
    let [r, g, b] = light.color.map(f32::to_bits);
    let (inner, outer) =
        light.spot.as_ref().map_or((0, 0), |s| (s.inner_cone_angle.to_bits(), s.outer_cone_angle.to_bits()));
    [kind, r, g, b, light.intensity.to_bits(), inner, outer]
}
