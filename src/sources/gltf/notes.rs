//! What in the file is not used?

use super::document::Document;
use super::extensions;
use super::lights::is_narrow;
use super::looks::Material;
use crate::sources::limits::NARROWEST_CONE;

/// What a reader should know was passed over, each kind of thing once.
pub(super) fn unused(document: &Document) -> Vec<String> {
    let materials = &document.materials;
    let reflecting = |m: &&Material| m.emissive_factor == [0.0; 3];
    let primitives = || document.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let counts = [
        (
            materials.iter().filter(|m| m.is_clamped()).count(),
            "base colours a hair above 1 or below 0",
            "taken as 1 and 0",
        ),
        (
            materials.iter().filter(|m| m.extensions.specular_glossiness.is_some()).count(),
            "specular-glossiness materials",
            "their diffuse colour is the albedo",
        ),
        (
            materials.iter().filter(|m| m.normal_texture.is_some() || m.occlusion_texture.is_some()).count(),
            "normal and occlusion textures of materials",
            "not used",
        ),
        (
            materials
                .iter()
                .filter(reflecting)
                .filter(|m| {
                    m.pbr_metallic_roughness.metallic_factor > 0.0 && m.extensions.specular_glossiness.is_none()
                })
                .count(),
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
            materials.iter().filter(|m| !reflecting(m) && m.base_factor() != [0.0; 3]).count(),
            "emissive materials with a base colour",
            "emitters reflect nothing here",
        ),
        (
            primitives().filter(|p| p.mode.is_some_and(|m| m < 4) || p.attributes.position.is_none()).count(),
            "primitives of points, of lines or without positions",
            "not used",
        ),
        (primitives().filter(|p| p.attributes.colour.is_some()).count(), "primitives with vertex colours", "not used"),
        (
            primitives().filter(|p| !p.targets.is_empty()).count(),
            "primitives with morph targets",
            "shown at the weights that the file gives, not those of animations",
        ),
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
    let narrow = document.extensions.punctual.lights.iter().filter(|l| l.kind == "spot" && is_narrow(l.spot.as_ref()));
    let narrow = narrow.count();
    if narrow > 0 {
        notes.push(format!(
            "spots narrower than {NARROWEST_CONE} degrees: {narrow}; widened to that with their flux kept"
        ));
    }
    notes.extend(extensions::unread(document));
    notes
}

/// What Blender's exporter is called, whatever its version.
const BLENDER: &str = "Khronos glTF Blender I/O";

/// What should be said of the lamps of a file that Blender's own exporter wrote, unless someone has divided them.
pub(super) fn blender(document: &Document, divided: bool) -> Option<String> {
    let by_blender = document.asset.generator.as_deref().is_some_and(|generator| generator.starts_with(BLENDER));
    let lamps = document.extensions.punctual.lights.len();
    (by_blender && lamps > 0 && !divided).then(|| {
        format!(
            "lamps that Blender's exporter wrote: {lamps}; unless its lighting mode was `Unitless`, as scenes/from_blender.py has it, each is 683 times as \
             bright beside emissive materials as in Blender: `--lamps-divided-by 683` mends that"
        )
    })
}
