//! Parts of files as others write them.

use crate::made::File;
use citylights::scene::Scene;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use serde_json::json;

/// Points a node's light from +y straight down: -z goes to -y.
pub(crate) const DOWN: [f64; 4] = [-std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];

/// Radiance of a white texel of [`panel`].
pub(crate) const RADIANCE: f64 = 100.0;

/// The ground, and 4 m above its middle a square panel of 2 m that shines down at 100 cd/m^2; its texture coordinates run
/// from 0 to 1 along +x and +z of glTF. `change` gets the file and the number of the panel's material.
pub(crate) fn panel(change: impl FnOnce(&mut File, usize)) -> File {
    let mut file = File::ground();
    let corners = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]];
    let coordinates = coordinates(&mut file, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    let (position, indices) = (file.positions(&corners), file.indices(5123, &[0, 1, 2, 0, 2, 3]));
    let material = file.push(
        "materials",
        json!({
            "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0 },
            "emissiveFactor": [1, 1, 1],
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": RADIANCE } },
        }),
    );
    let attributes = json!({ "POSITION": position, "TEXCOORD_0": coordinates });
    let mesh = file.mesh(json!({ "attributes": attributes, "indices": indices, "material": material }));
    file.node(json!({ "name": "panel", "mesh": mesh, "translation": [0, 4, 0] }));
    change(&mut file, material);
    file
}

/// The ground with a lamp of 70 cd 2 m over its middle.
pub(crate) fn lamp() -> File {
    let mut file = File::ground();
    file.lamp(json!({ "type": "point", "intensity": 70 }), json!({ "translation": [0, 2, 0] }));
    file
}

/// Adds texture coordinates.
pub(crate) fn coordinates(file: &mut File, coordinates: [[f32; 2]; 4]) -> usize {
    let bytes: Vec<u8> = coordinates.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    file.accessor(&bytes, 5126, 4, "VEC2")
}

/// A PNG file of grey texels, row by row.
pub(crate) fn png(width: u32, texels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let colours: Vec<u8> = texels.iter().flat_map(|&code| [code; 3]).collect();
    let height = texels.len() as u32 / width;
    PngEncoder::new(&mut bytes).write_image(&colours, width, height, ExtendedColorType::Rgb8).expect("a picture");
    bytes
}

/// A JPEG file of grey texels, row by row.
pub(crate) fn jpeg(width: u32, texels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let colours: Vec<u8> = texels.iter().flat_map(|&code| [code; 3]).collect();
    let height = texels.len() as u32 / width;
    let encoder = JpegEncoder::new_with_quality(&mut bytes, 100);
    encoder.write_image(&colours, width, height, ExtendedColorType::Rgb8).expect("a picture");
    bytes
}

/// Adds a texture of an image in a buffer view; its number.
pub(crate) fn texture(file: &mut File, image: &[u8], mime: &str) -> usize {
    let view = file.view(image);
    let image = file.push("images", json!({ "bufferView": view, "mimeType": mime }));
    file.push("textures", json!({ "source": image }))
}

/// What is told of a scene beside its exposure.
pub(crate) fn told(scene: &Scene) -> Vec<String> {
    scene.notes().iter().filter(|note| !note.contains("EV100")).cloned().collect()
}

/// Asserts that one thing is told.
pub(crate) fn only_note(scene: &Scene, note: &str) {
    let told = told(scene);
    assert!(told.len() == 1 && told[0].starts_with(note), "{told:#?}\nfor: {note}");
}
