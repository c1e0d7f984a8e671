//! The camera and its node.

use super::extras::extras;
use super::place::{place, rotation, turned};
use crate::scene::Scene;
use ::gltf::json::{self, Root, validation::Checked};
use glam::{DMat3, DQuat};

/// Adds the camera, whose pixel grid stands in `extras`, and its node.
pub(super) fn add(scene: &Scene, root: &mut Root) {
    let camera = scene.camera();
    let (width, height) = camera.resolution();
    let lens = json::camera::Perspective {
        aspect_ratio: Some((f64::from(width) / f64::from(height)) as f32),
        yfov: camera.fov().to_radians() as f32,
        zfar: None,
        znear: 0.01,
        extensions: None,
        extras: None,
    };
    let index = root.push(json::Camera {
        name: Some("camera".to_owned()),
        orthographic: None,
        perspective: Some(lens),
        type_: Checked::Valid(json::camera::Type::Perspective),
        extensions: None,
        extras: Some(extras(&format!("{{\"resolution\":[{width},{height}]}}"))),
    });
    // It looks along its own -z, +y up.
    let [right, up, back] = [camera.right(), camera.up(), -camera.forward()].map(turned);
    root.push(json::Node {
        camera: Some(index),
        name: Some("camera".to_owned()),
        translation: Some(place(camera.position())),
        rotation: Some(rotation(DQuat::from_mat3(&DMat3::from_cols(right, up, back)))),
        ..json::Node::default()
    });
}
