//! Which extensions does a file lean on, and can it be shown without?
//!
//! | an extension | here |
//! |---|---|
//! | that is read | nothing is told |
//! | that changes how surfaces look, moves things or names them, required or not | one note with all names |
//! | that adds lights, used at all | refused: the light would be another |
//! | that holds the geometry, or that is not known, required | refused |

use super::document::Document;
use super::reader::Reader;
use crate::base::error::Result;
use crate::sources::name;
use std::collections::HashSet;
use std::fmt::Display;

/// Extensions that are read, or taken as their defaults where that is no loss.
const READ: [&str; 8] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_specular",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "EXT_mesh_gpu_instancing",
];
/// What the names of extensions begin with that leave every triangle and every light where it is.
const APPEARANCE: [&str; 27] = [
    "KHR_materials_",
    "EXT_materials_",
    "ADOBE_materials_",
    "NV_materials_",
    "MSFT_packing_",
    "MSFT_texture_",
    "MSFT_lod",
    "KHR_techniques_webgl",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_xmp",
    "KHR_animation_",
    "KHR_audio",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_",
    "KHR_implicit_shapes",
    "KHR_collision_shapes",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "EXT_feature_metadata",
    "AGI_",
    "CESIUM_primitive_outline",
    "VRM",
];
/// What holds positions in a form that is not read, and what does without.
const GEOMETRY: [(&str, &str); 3] = [
    ("KHR_draco_mesh_compression", COMPRESSED),
    ("EXT_meshopt_compression", COMPRESSED),
    ("KHR_meshopt_compression", COMPRESSED),
];
const COMPRESSED: &str = "compressed meshes are not read here; export without compression, or write the file out plain: \
                          `gltf-transform copy IN.glb OUT.glb`";
/// Most extensions that are told by name.
const MOST_NAMES: usize = 12;

/// Whether an extension adds lights that are not read.
fn adds_light(name: &str) -> bool {
    name.contains("_lights_") && !READ.contains(&name)
}

fn looks_alone(name: &str) -> bool {
    APPEARANCE.iter().any(|known| name.starts_with(known))
}

impl Reader<'_> {
    /// Fails if the file cannot be shown right without an extension that is not read.
    pub(super) fn check_extensions(&self) -> Result<()> {
        let Document { extensions_used: used, extensions_required: required, .. } = self.document;
        for (i, name) in required.iter().enumerate() {
            let refuse = |text: &dyn Display| {
                let shown: String = name.chars().take(60).collect();
                Err(self.wrong(format_args!("extensionsRequired[{i}]"), format_args!("\"{shown}\": {text}")))
            };
            if let Some((_, way)) = GEOMETRY.iter().find(|(known, _)| known == name) {
                return refuse(way);
            }
            if adds_light(name) {
                return refuse(&"it is not read here, and without it the light would be another; remove it");
            }
            if !READ.contains(&name.as_str()) && !looks_alone(name) {
                return refuse(&format_args!(
                    "it is not known here, and the file says that nothing is right without it; export without it, or \
                     take it out of `extensionsRequired` if it only changes how surfaces look. Read are {}",
                    READ.join(", ")
                ));
            }
        }
        if let Some((i, name)) = used.iter().enumerate().find(|(_, name)| adds_light(name)) {
            let shown: String = name.chars().take(60).collect();
            let text = format_args!("{shown} is not read here, and without it the light would be another; remove it");
            return Err(self.wrong(format_args!("extensionsUsed[{i}]"), text));
        }
        Ok(())
    }
}

/// Which extensions of a file are not read.
pub(super) fn unread(document: &Document) -> Option<String> {
    let (used, required) = (&document.extensions_used, &document.extensions_required);
    let known: HashSet<&String> = used.iter().collect();
    let also = required.iter().filter(|name| !known.contains(name));
    let others: Vec<&String> = used.iter().chain(also).filter(|name| !READ.contains(&name.as_str())).collect();
    let names: Vec<String> = others.iter().take(MOST_NAMES).filter_map(|name| name::made_fit(name)).collect();
    let more = if others.len() > MOST_NAMES { ", ..." } else { "" };
    (!others.is_empty()).then(|| format!("extensions that are not used: {}{more}", names.join(", ")))
}
