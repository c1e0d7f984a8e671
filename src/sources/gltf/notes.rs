//! What in the file is not used?

use super::document::Document;
use crate::sources::name;

/// Extensions that are read.
pub(super) const EXTENSIONS: [&str; 3] =
    ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_specular"];
/// Extensions that add lights or decide which objects there are: not to be passed over.
pub(super) const CHANGE_THE_LIGHT: [&str; 4] =
    ["EXT_lights_image_based", "EXT_lights_ies", "EXT_mesh_gpu_instancing", "KHR_node_visibility"];
/// Most extensions that are told by name.
const MOST_NAMES: usize = 12;

/// What a reader should know was passed over, each kind of thing once.
pub(super) fn unused(document: &Document) -> Vec<String> {
    let materials = &document.materials;
    let reflecting = |m: &&super::document::Material| m.emissive_factor == [0.0; 3];
    let primitives = || document.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let counts = [
        (
            materials.iter().filter(|m| m.pbr_metallic_roughness.base_color_texture.is_some()).count(),
            "base colour textures of materials",
            "the factor alone is the albedo",
        ),
        (
            materials.iter().filter(|m| m.normal_texture.is_some() || m.occlusion_texture.is_some()).count(),
            "normal and occlusion textures of materials",
            "not used",
        ),
        (
            materials.iter().filter(reflecting).filter(|m| m.pbr_metallic_roughness.metallic_factor > 0.0).count(),
            "metallic materials, as glTF has them unless a `metallicFactor` says otherwise",
            "the base colour is a Lambertian albedo",
        ),
        (
            materials.iter().filter(|m| m.alpha_mode.as_deref().is_some_and(|mode| mode != "OPAQUE")).count(),
            "materials that blend or mask",
            "opaque here",
        ),
        (
            materials.iter().filter(|m| m.extensions.unlit.is_some()).count(),
            "unlit materials",
            "lit here as all others",
        ),
        (
            materials
                .iter()
                .filter(|m| !reflecting(m) && m.pbr_metallic_roughness.base_color_factor[..3] != [0.0; 3])
                .count(),
            "emissive materials with a base colour",
            "emitters reflect nothing here",
        ),
        (
            primitives().filter(|p| p.mode.is_some_and(|m| m < 4) || p.attributes.position.is_none()).count(),
            "primitives of points, of lines or without positions",
            "not used",
        ),
        (primitives().filter(|p| p.attributes.colour.is_some()).count(), "primitives with vertex colours", "not used"),
        (primitives().filter(|p| p.targets.is_some()).count(), "primitives with morph targets", "shown without them"),
        (
            primitives().filter(|p| p.attributes.joints.is_some()).count().max(document.skins.len()),
            "skins",
            "meshes are shown as they were bound",
        ),
        (document.animations.len(), "animations", "shown at rest"),
        (
            document.extensions.punctual.lights.iter().filter(|light| light.range.is_some()).count(),
            "lights with a `range`",
            "the inverse square goes on beyond it",
        ),
        (
            document.cameras.iter().filter(|camera| camera.perspective.is_none()).count(),
            "orthographic cameras",
            "not used",
        ),
    ];
    let mut notes: Vec<String> = counts
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, what, consequence)| format!("{what}: {count}; {consequence}"))
        .collect();
    let others: Vec<&String> =
        document.extensions_used.iter().filter(|used| !EXTENSIONS.contains(&used.as_str())).collect();
    if !others.is_empty() {
        let names: Vec<String> = others.iter().take(MOST_NAMES).filter_map(|used| name::made_fit(used)).collect();
        let more = if others.len() > MOST_NAMES { ", ..." } else { "" };
        notes.push(format!("extensions that are not used: {}{more}", names.join(", ")));
    }
    notes
}
