//! glTF files as a test wants them, right or wrong: the JSON is free to be changed before it is written.

use crate::common::{ALBEDO, receiver};
use citylights::base::error::Result;
use citylights::render::exact::exact;
use citylights::scene::Scene;
use citylights::sources::Overrides;
use citylights::sources::gltf::parse;
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path;

/// A file being made.
#[derive(Clone)]
pub(crate) struct File {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl File {
    /// A file with an empty scene.
    pub(crate) fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [] }],
            "nodes": [], "meshes": [], "materials": [], "cameras": [],
            "accessors": [], "bufferViews": [], "buffers": [], "textures": [], "images": [], "samplers": [],
            "extensions": { "KHR_lights_punctual": { "lights": [] } },
            "extensionsUsed": ["KHR_lights_punctual"],
        });
        Self { json, bin: Vec::new() }
    }

    /// A file that shows a square of 20 m in the plane y = 0, from 12 m to the south and 5 m up.
    pub(crate) fn ground() -> Self {
        let mut file = Self::new();
        let grey = file.push(
            "materials",
            json!({ "name": "grey", "pbrMetallicRoughness": { "baseColorFactor": [0.3, 0.3, 0.3, 1], "metallicFactor": 0 } }),
        );
        let corners = [[-10.0, 0.0, 10.0], [10.0, 0.0, 10.0], [10.0, 0.0, -10.0], [-10.0, 0.0, -10.0]];
        let (position, indices) = (file.positions(&corners), file.indices(5123, &[0, 1, 2, 0, 2, 3]));
        let mesh = file.mesh(json!({ "attributes": { "POSITION": position }, "indices": indices, "material": grey }));
        file.node(json!({ "name": "ground", "mesh": mesh }));
        let camera =
            file.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }));
        file.node(json!({ "name": "eye", "camera": camera, "translation": [0, 5, 12] }));
        file
    }

    /// Adds an entry to a list at the top level; its number.
    pub(crate) fn push(&mut self, list: &str, entry: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(entry);
        list.len() - 1
    }

    /// Adds a node to the scene.
    pub(crate) fn node(&mut self, node: Value) -> usize {
        let id = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(id));
        id
    }

    /// Adds a mesh of one primitive.
    pub(crate) fn mesh(&mut self, primitive: Value) -> usize {
        self.push("meshes", json!({ "primitives": Value::Array(vec![primitive]) }))
    }

    /// Adds a punctual light.
    pub(crate) fn light(&mut self, light: Value) -> usize {
        let lights = &mut self.json["extensions"]["KHR_lights_punctual"]["lights"];
        let lights = lights.as_array_mut().expect("a list");
        lights.push(light);
        lights.len() - 1
    }

    /// Adds a node that carries a light of its own, and what else is given.
    pub(crate) fn lamp(&mut self, light: Value, mut node: Value) -> usize {
        let light = self.light(light);
        node["extensions"] = json!({ "KHR_lights_punctual": { "light": light } });
        self.node(node)
    }

    /// Adds an emissive triangle of white radiance with its node.
    pub(crate) fn emitter(
        &mut self,
        corners: [[f32; 3]; 3],
        radiance: f64,
        double_sided: bool,
        mut node: Value,
    ) -> usize {
        let position = self.positions(&corners);
        let material = self.push(
            "materials",
            json!({
                "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1] },
                "emissiveFactor": [1, 1, 1],
                "doubleSided": double_sided,
                "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": radiance } },
            }),
        );
        node["mesh"] = json!(self.mesh(json!({ "attributes": { "POSITION": position }, "material": material })));
        self.node(node)
    }

    /// Adds positions.
    pub(crate) fn positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let bytes: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let id = self.accessor(&bytes, 5126, positions.len(), "VEC3");
        for (name, of) in [("min", f32::min as fn(f32, f32) -> f32), ("max", f32::max)] {
            let extreme = |axis: usize| positions.iter().map(|p| p[axis]).reduce(of).unwrap_or_default();
            self.json["accessors"][id][name] = json!([extreme(0), extreme(1), extreme(2)]);
        }
        id
    }

    /// Adds indices of a component type: 5121, 5123 or 5125.
    pub(crate) fn indices(&mut self, kind: u32, indices: &[u32]) -> usize {
        let size = match kind {
            5121 => 1,
            5123 => 2,
            _ => 4,
        };
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes().into_iter().take(size)).collect();
        self.accessor(&bytes, kind, indices.len(), "SCALAR")
    }

    /// Adds an accessor of these bytes.
    pub(crate) fn accessor(&mut self, bytes: &[u8], kind: u32, count: usize, shape: &str) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": kind, "count": count, "type": shape }))
    }

    /// Adds a buffer view of these bytes.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let at = self.bin.len();
        self.bin.extend(bytes);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": at, "byteLength": bytes.len() }))
    }

    /// The JSON with its buffer at `uri`; a list of buffers that was set by hand stays.
    fn text(&self, uri: Option<String>) -> String {
        let mut json = self.json.clone();
        if json["buffers"].as_array().is_some_and(Vec::is_empty) && !self.bin.is_empty() {
            let length = self.bin.len();
            json["buffers"] = match uri {
                Some(uri) => json!([{ "byteLength": length, "uri": uri }]),
                None => json!([{ "byteLength": length }]),
            };
        }
        json.to_string()
    }

    /// As a binary file.
    pub(crate) fn glb(&self) -> Vec<u8> {
        glb(self.text(None).as_bytes(), &self.bin)
    }

    /// As JSON with the buffer within.
    #[cfg(feature = "cli")]
    pub(crate) fn embedded(&self) -> String {
        use base64::Engine;
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bin);
        self.text(Some(format!("data:application/octet-stream;base64,{data}")))
    }

    /// As JSON with the buffer in a file of its own.
    #[cfg(feature = "cli")]
    pub(crate) fn beside(&self, uri: &str) -> String {
        self.text(Some(uri.to_owned()))
    }

    /// The scene.
    pub(crate) fn read(&self) -> Result<Scene> {
        self.read_with(&Overrides::default())
    }

    pub(crate) fn read_with(&self, overrides: &Overrides) -> Result<Scene> {
        parse(&self.glb(), Path::new("test.glb"), overrides)
    }

    pub(crate) fn scene(&self) -> Scene {
        self.read().unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Irradiance on the red channel, in lux; `samples` of each triangle light.
pub(crate) fn irradiance_by(scene: &Scene, position: Vec3, normal: Vec3, samples: u32) -> f64 {
    let stage = Stage::new(scene.clone(), LeaveOut::No, Offset::SCALED);
    exact(&stage, &receiver(position, normal), samples, 1).mean().x * PI / f64::from(ALBEDO)
}

/// The same with many samples.
pub(crate) fn irradiance(scene: &Scene, position: Vec3, normal: Vec3) -> f64 {
    irradiance_by(scene, position, normal, 40_000)
}

pub(crate) fn near(found: f64, wanted: f64, relative: f64) {
    assert!((found / wanted - 1.0).abs() < relative, "{found} for {wanted}, ratio {}", found / wanted);
}

/// The container of a JSON and a binary chunk.
pub(crate) fn glb(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut out = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, bytes, filler) in [(b"JSON", json, b' '), (b"BIN\0", bin, 0)] {
        let length = bytes.len().next_multiple_of(4);
        out.extend((length as u32).to_le_bytes());
        out.extend(kind);
        out.extend(bytes);
        out.resize(out.len() + length - bytes.len(), filler);
    }
    let length = out.len() as u32;
    out[8..12].copy_from_slice(&length.to_le_bytes());
    out
}
