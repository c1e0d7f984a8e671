//! The whole document: its parts in order, and its bytes.

use super::extras::extras;
use super::{camera, lights, triangles};
use crate::base::error::{Error, Result};
use crate::export::files::Export;
use crate::scene::Scene;
use ::gltf::binary::{Glb, Header};
use ::gltf::json::{self, Index, Root};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use json::validation::USize64;
use std::borrow::Cow;
use std::path::Path;

/// The scene as a `.glb`, or as a `.gltf` with its buffer embedded.
pub(in crate::export) fn export(scene: &Scene, file: &Path) -> Result<Export> {
    let mut root = Root {
        asset: json::Asset {
            generator: Some(concat!("citylights ", env!("CARGO_PKG_VERSION")).to_owned()),
            ..json::Asset::default()
        },
        ..Root::default()
    };
    camera::add(scene, &mut root);
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
