//! A scene as glTF 2.0.
//!
//! glTF is +y up: our `(x, y, z)` is its `(x, z, -y)`, in the coordinates themselves, and there is no root that turns.
//! Candela, lux and radiance are carried unchanged. Colours are a factor within 0 and 1 times a power of two, so that
//! the product has every bit of ours. What glTF has no word for stands in `extras`: the camera's `resolution`, the
//! scene's `ev100`, a material's `street`.
//!
//! Source: Khronos, glTF 2.0.1; `KHR_lights_punctual`, `KHR_materials_emissive_strength`, `KHR_materials_specular`.

mod lights;
mod materials;
mod triangles;

use super::Export;
use crate::base::error::{Error, Result};
use crate::scene::Scene;
use ::gltf::binary::{Glb, Header};
use ::gltf::json::{self, Index, Root, validation::Checked};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DMat3, DQuat, DVec3, Vec3};
use json::scene::UnitQuaternion;
use json::validation::USize64;
use serde_json::value::RawValue;
use std::borrow::Cow;
use std::path::Path;

/// The scene as a `.glb`, or as a `.gltf` with its buffer embedded.
pub(super) fn export(scene: &Scene, file: &Path) -> Result<Export> {
    let mut root = Root {
        asset: json::Asset {
            generator: Some(concat!("citylights ", env!("CARGO_PKG_VERSION")).to_owned()),
            ..json::Asset::default()
        },
        ..Root::default()
    };
    camera(scene, &mut root);
    let buffer = triangles::add(scene, &mut root)?;
    lights::add(scene, &mut root)?;
    let nodes = (0..root.nodes.len() as u32).map(Index::new).collect();
    let extras = scene.ev100().map(|ev100| extras(&format!("{{\"ev100\":{ev100}}}")));
    root.scenes.push(json::Scene { extensions: None, extras, name: Some(scene.name().to_owned()), nodes });
    root.scene = Some(Index::new(0));
    root.extensions_used = extensions(&root);

    let embedded = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gltf"));
    root.buffers.push(json::Buffer {
        byte_length: USize64::from(buffer.len()),
        name: None,
        uri: embedded.then(|| format!("data:application/octet-stream;base64,{}", STANDARD.encode(&buffer))),
        extensions: None,
        extras: None,
    });
    let text = root.to_vec().map_err(|error| Error::Invalid(format!("cannot write the scene as JSON: {error}")))?;
    let bytes = if embedded { text } else { binary(text, buffer)? };
    Ok(Export { files: vec![(file.to_owned(), bytes)], notes: Vec::new() })
}

/// The bytes of a `.glb`.
fn binary(text: Vec<u8>, buffer: Vec<u8>) -> Result<Vec<u8>> {
    let too_large = || Error::Invalid("the scene is larger than the 4 GiB that a .glb file holds".to_owned());
    if text.len() as u64 + buffer.len() as u64 + 64 > u64::from(u32::MAX) {
        return Err(too_large());
    }
    let header = Header { magic: *b"glTF", version: 2, length: 0 };
    Glb { header, json: Cow::Owned(text), bin: Some(Cow::Owned(buffer)) }.to_vec().map_err(|_| too_large())
}

fn camera(scene: &Scene, root: &mut Root) {
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

/// The extensions that are used, by name.
fn extensions(root: &Root) -> Vec<String> {
    let materials = || root.materials.iter().filter_map(|material| material.extensions.as_ref());
    let used = [
        ("KHR_lights_punctual", root.extensions.is_some()),
        ("KHR_materials_emissive_strength", materials().any(|e| e.emissive_strength.is_some())),
        ("KHR_materials_specular", materials().any(|e| e.specular.is_some())),
    ];
    used.into_iter().filter(|(_, used)| *used).map(|(name, _)| name.to_owned()).collect()
}

/// A point of ours in glTF's axes, exactly.
fn place(p: Vec3) -> [f32; 3] {
    // 0 - y: an exact negation that makes no -0.
    [p.x, p.z, 0.0 - p.y]
}

/// A direction of ours in glTF's axes.
fn turned(d: DVec3) -> DVec3 {
    DVec3::new(d.x, d.z, -d.y)
}

fn rotation(turn: DQuat) -> UnitQuaternion {
    UnitQuaternion(turn.normalize().as_quat().to_array())
}

/// JSON for an `extras` field.
fn extras(text: &str) -> Box<RawValue> {
    RawValue::from_string(text.to_owned()).expect("the text is JSON")
}

/// A colour as a factor within 0 and 1 and a power of two, whose product it is exactly.
fn factored(colour: Vec3) -> Result<([f32; 3], f32)> {
    let most = colour.max_element();
    if most == 0.0 {
        return Ok(([0.0; 3], 1.0));
    }
    // The least power of two that is not below the largest channel, from its exponent; subnormal ones have that of 2^-126.
    let exponent = (most.to_bits() >> 23).max(1) + u32::from(most.to_bits() << 9 != 0);
    if exponent > 254 {
        return Err(Error::Invalid(format!("glTF has no word for a light of {colour}: 2^127 is the most")));
    }
    let power = f32::from_bits(exponent << 23);
    Ok(((colour / power).to_array(), power))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_give_every_bit_back() {
        let colours = [[1.0, 0.5, 0.25], [3.7, 1e-3, 0.0], [1e-30, 2e-31, 0.0], [1.6e38, 1.0, 3e5], [1e-42, 0.0, 0.0]];
        for colour in colours.map(Vec3::from_array) {
            let (factor, power) = factored(colour).expect("a colour");
            assert!(factor.iter().all(|f| (0.0..=1.0).contains(f)), "{colour}: {factor:?}");
            assert_eq!(Vec3::from_array(factor) * power, colour);
            assert_eq!(power.to_bits() << 9, 0, "{power} is no power of two");
        }
        assert_eq!(factored(Vec3::splat(4.0)).expect("a colour"), ([1.0; 3], 4.0));
        assert!(factored(Vec3::splat(2e38)).is_err());
    }
}
