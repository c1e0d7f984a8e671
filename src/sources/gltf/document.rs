//! What does the JSON say?
//!
//! Types of those parts of a glTF document that are read, or whose presence is told. Own ones, because those of the
//! `gltf-json` crate cut an index of 2^32 down to 0 and ask for fields that may be left out. What is not named here is
//! skipped without being stored, so that a document takes memory in proportion to its length only.

use super::looks::{Image, Material, Sampler, Texture};
use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use serde_json::value::RawValue;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

/// Most entries of a list at the top level of a document: 2^21 nodes take about half a gigabyte.
const LONGEST_LIST: usize = 1 << 21;

/// The document.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document<'a> {
    pub(super) asset: Asset,
    #[serde(default)]
    pub(super) extensions_used: List<String>,
    #[serde(default)]
    pub(super) extensions_required: List<String>,
    pub(super) scene: Option<u32>,
    #[serde(default, borrow)]
    pub(super) scenes: List<SceneEntry<'a>>,
    #[serde(default)]
    pub(super) nodes: List<Node>,
    #[serde(default)]
    pub(super) meshes: List<Mesh>,
    #[serde(default, borrow)]
    pub(super) materials: List<Material<'a>>,
    #[serde(default, borrow)]
    pub(super) cameras: List<CameraEntry<'a>>,
    #[serde(default)]
    pub(super) accessors: List<Accessor>,
    #[serde(default)]
    pub(super) buffer_views: List<BufferView>,
    #[serde(default)]
    pub(super) buffers: List<Buffer>,
    #[serde(default)]
    pub(super) animations: List<IgnoredAny>,
    #[serde(default)]
    pub(super) skins: List<IgnoredAny>,
    #[serde(default)]
    pub(super) textures: List<Texture>,
    #[serde(default)]
    pub(super) images: List<Image>,
    #[serde(default)]
    pub(super) samplers: List<Sampler>,
    #[serde(default)]
    pub(super) extensions: Extensions,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Asset {
    pub(super) version: String,
    pub(super) min_version: Option<String>,
    pub(super) generator: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct SceneEntry<'a> {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) nodes: Vec<u32>,
    #[serde(default, borrow)]
    pub(super) extras: Option<&'a RawValue>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) children: Vec<u32>,
    pub(super) mesh: Option<u32>,
    pub(super) camera: Option<u32>,
    /// Column by column.
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    /// Of the morph targets of its mesh, instead of the mesh's own.
    pub(super) weights: Option<Vec<f64>>,
    #[serde(default)]
    pub(super) extensions: NodeExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) light: Option<LightOfNode>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(super) instancing: Option<Instancing>,
    #[serde(rename = "KHR_node_visibility")]
    pub(super) visibility: Option<Visibility>,
}

#[derive(Deserialize)]
pub(super) struct Instancing {
    pub(super) attributes: InstanceAttributes,
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) struct InstanceAttributes {
    pub(super) translation: Option<u32>,
    pub(super) rotation: Option<u32>,
    pub(super) scale: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct Visibility {
    pub(super) visible: Option<bool>,
}

#[derive(Deserialize)]
pub(super) struct LightOfNode {
    pub(super) light: u32,
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    pub(super) primitives: Vec<Primitive>,
    /// Of the morph targets of all its primitives.
    pub(super) weights: Option<Vec<f64>>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<u32>,
    pub(super) material: Option<u32>,
    pub(super) mode: Option<u32>,
    #[serde(default)]
    pub(super) targets: Vec<Target>,
}

/// What a morph target adds.
#[derive(Deserialize)]
pub(super) struct Target {
    #[serde(rename = "POSITION")]
    pub(super) position: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) position: Option<u32>,
    #[serde(rename = "COLOR_0")]
    pub(super) colour: Option<IgnoredAny>,
    #[serde(rename = "JOINTS_0")]
    pub(super) joints: Option<IgnoredAny>,
    #[serde(rename = "TEXCOORD_0")]
    pub(super) coordinates_0: Option<u32>,
    #[serde(rename = "TEXCOORD_1")]
    pub(super) coordinates_1: Option<u32>,
    #[serde(rename = "TEXCOORD_2")]
    pub(super) coordinates_2: Option<u32>,
    #[serde(rename = "TEXCOORD_3")]
    pub(super) coordinates_3: Option<u32>,
}

impl Attributes {
    /// The accessor of a set of texture coordinates; exporters write four sets at most.
    pub(super) fn coordinates(&self, set: u32) -> Option<u32> {
        let sets = [self.coordinates_0, self.coordinates_1, self.coordinates_2, self.coordinates_3];
        sets.get(set as usize).copied().flatten()
    }
}

#[derive(Deserialize)]
pub(super) struct CameraEntry<'a> {
    pub(super) name: Option<String>,
    pub(super) perspective: Option<Perspective>,
    #[serde(default, borrow)]
    pub(super) extras: Option<&'a RawValue>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Perspective {
    pub(super) yfov: f64,
    pub(super) aspect_ratio: Option<f64>,
    #[serde(default)]
    pub(super) znear: f64,
    pub(super) zfar: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<u32>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) shape: String,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) sparse: Option<Box<Sparse>>,
}

/// Elements that differ from those of an accessor's view, or from zero.
#[derive(Deserialize)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: SparsePart,
    pub(super) values: SparsePart,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparsePart {
    pub(super) buffer_view: u32,
    #[serde(default)]
    pub(super) byte_offset: u64,
    /// Of indices; values have that of their accessor.
    pub(super) component_type: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: u32,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: u64,
}

#[derive(Deserialize, Default)]
pub(super) struct Extensions {
    #[serde(default, rename = "KHR_lights_punctual")]
    pub(super) punctual: Punctual,
}

#[derive(Deserialize, Default)]
pub(super) struct Punctual {
    #[serde(default)]
    pub(super) lights: List<PunctualLight>,
}

#[derive(Deserialize)]
pub(super) struct PunctualLight {
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) color: Option<[f64; 3]>,
    pub(super) intensity: Option<f64>,
    pub(super) range: Option<IgnoredAny>,
    pub(super) spot: Option<Cones>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Cones {
    pub(super) inner_cone_angle: Option<f64>,
    pub(super) outer_cone_angle: Option<f64>,
}

/// A list at the top level.
pub(super) struct List<T>(Vec<T>);

impl<T> Default for List<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Deref for List<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for List<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = List<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a list")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<List<T>, A::Error> {
                let mut list = Vec::new();
                while let Some(entry) = entries.next_element()? {
                    if list.len() == LONGEST_LIST {
                        return Err(A::Error::custom(format_args!("more than {LONGEST_LIST} entries")));
                    }
                    list.push(entry);
                }
                Ok(List(list))
            }
        }
        deserializer.deserialize_seq(Entries(PhantomData))
    }
}
