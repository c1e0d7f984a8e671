//! Promise: twenty-four kinds of files that others write open with the right light; four others say why they do not, and
//! what would.
//!
//! Each is small and looks like what an exporter or a library of models writes. `CITYLIGHTS_FOREIGN_FILES` names a folder
//! that keeps them.
#![cfg(feature = "cli")]

use crate::foreign_made::{DOWN, RADIANCE, coordinates, jpeg, lamp, panel, png, texture};
use crate::made::{File, irradiance_by};
use citylights::sources::{Overrides, open};
use glam::Vec3;
use serde_json::{Value, json};
use std::fs;

/// What of a file should become: the irradiance in the middle of the ground, or a refusal that says this.
enum Right {
    Lux(f64),
    Refused(&'static str),
}
use Right::{Lux, Refused};

/// Irradiance of the whole panel and of the lamp there.
fn of_panel() -> f64 {
    // Lambert's formula for a quarter of the square, 1 m by 1 m at 4 m, four times.
    let root = 17f64.sqrt();
    4.0 * RADIANCE * (1.0 / root) * (1.0 / root).atan()
}
const OF_LAMP: f64 = 70.0 / 4.0;

fn emits(file: &mut File, material: usize, image: &[u8], mime: &str, more: Value) {
    let texture = texture(file, image, mime);
    let mut info = more;
    info["index"] = json!(texture);
    file.json["materials"][material]["emissiveTexture"] = info;
}

fn with(mut file: File, change: impl FnOnce(&mut File)) -> File {
    change(&mut file);
    file
}

fn requires(name: &'static str) -> File {
    with(lamp(), |file| file.json["extensionsRequired"] = json!([name]))
}

fn instanced(lamps: bool) -> File {
    let mut file = File::ground();
    let places = file.positions(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let extension = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    let corners = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.1]];
    file.emitter(corners, 4000.0, false, json!({ "translation": [0, 2, 0], "extensions": extension }));
    if lamps {
        let light = file.light(json!({ "type": "point", "intensity": 70 }));
        file.json["nodes"][2]["extensions"]["KHR_lights_punctual"] = json!({ "light": light });
        file.json["nodes"][2].as_object_mut().expect("an object").remove("mesh");
    }
    file.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    file
}

/// Every kind: its name, a file's bytes and what is right.
fn kinds() -> Vec<(&'static str, Vec<u8>, Right)> {
    let p = of_panel();
    let grey = |code: u8| ((f64::from(code) / 255.0 + 0.055) / 1.055).powf(2.4);
    let halves = [[255u8; 8], [0; 8]].concat().repeat(16);
    let looks = [
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_materials_ior",
    ];
    let spot = |outer: f64| {
        let mut file = File::ground();
        let light = json!({ "type": "spot", "intensity": 500, "spot": { "outerConeAngle": outer } });
        file.lamp(light, json!({ "translation": [0, 3, 0], "rotation": DOWN }));
        file
    };
    let textured = |image: Vec<u8>, mime: &'static str, more: Value| {
        panel(|file, material| emits(file, material, &image, mime, more)).glb()
    };
    let transform = json!({ "extensions": { "KHR_texture_transform": { "offset": [0.5, 0], "scale": [0.5, 1] } } });
    let half = 0.5 * p;
    let quantized = with(panel(|_, _| ()), |file| {
        let shorts: Vec<u8> = [[-1i16, 0, -1, 0], [1, 0, -1, 0], [1, 0, 1, 0], [-1, 0, 1, 0]]
            .as_flattened()
            .iter()
            .flat_map(|x| (x * 32767).to_le_bytes())
            .collect();
        let id = file.accessor(&shorts, 5122, 4, "VEC3");
        let view = file.json["accessors"][id]["bufferView"].as_u64().expect("a number") as usize;
        file.json["accessors"][id]["normalized"] = json!(true);
        file.json["bufferViews"][view]["byteStride"] = json!(8);
        file.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] = json!(id);
        file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    });
    let sparse = with(panel(|_, _| ()), |file| {
        let id = file.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"].as_u64().expect("one") as usize;
        let values = file.json["accessors"][id]["bufferView"].clone();
        let indices = file.view(&[0, 1, 2, 3]);
        let of = json!({ "count": 4, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values } });
        file.json["accessors"][id] = json!({ "componentType": 5126, "count": 4, "type": "VEC3", "sparse": of });
    });
    let morphed = with(panel(|_, _| ()), |file| {
        let target = file.positions(&[[0.0, 8.0, 0.0]; 4]);
        file.json["meshes"][1]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
        file.json["meshes"][1]["weights"] = json!([0.5]);
        file.json["nodes"][2]["translation"] = json!([0, 0, 0]);
    });
    let based = with(lamp(), |file| {
        let texture = texture(file, &jpeg(16, &halves), "image/jpeg");
        file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
        let set = coordinates(file, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(set);
    });
    let glossy = with(lamp(), |file| {
        let name = "KHR_materials_pbrSpecularGlossiness";
        file.json["materials"][0]["extensions"] = json!({ name: { "diffuseFactor": [0.3, 0.3, 0.3, 1] } });
        file.json["extensionsRequired"] = json!([name]);
    });
    let child = with(lamp(), |file| {
        file.push("nodes", json!({ "name": "tmpParent", "children": [2], "translation": [0, 50, 0] }));
    });
    let unused = with(lamp(), |file| {
        file.push("materials", json!({ "emissiveFactor": [-1, 0, 0] }));
    });
    let over = with(lamp(), |file| {
        file.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.00016, 0.3, 0.3, 1]);
    });
    let near = with(lamp(), |file| file.json["cameras"][0]["perspective"]["znear"] = json!(20));
    let blender = with(lamp(), |file| file.json["asset"]["generator"] = json!("Khronos glTF Blender I/O v4.2.57"));
    let hidden = with(lamp(), |file| {
        let roof = json!({ "mesh": 0, "translation": [0, 1, 0] });
        let roof = file.node(roof);
        file.json["nodes"][roof]["extensions"] = json!({ "KHR_node_visibility": { "visible": false } });
        file.json["extensionsRequired"] = json!(["KHR_node_visibility"]);
    });
    let narrow: f64 = 0.002;
    let widened = 500.0 / 9.0 * (narrow / 0.5f64.to_radians()).powi(2);
    let unpadded = with(lamp(), |file| {
        // A length that wants padding.
        file.bin.push(0);
        let data = file.embedded();
        assert!(data.contains("==\""));
        file.json = serde_json::from_str(&data.replace("==\"", "\"")).expect("JSON");
    });
    // A small triangle 2 m up, a third of 0.1 m beside x: its intensity, the cosines, the square.
    let emitter = |x: f64| {
        let (x, y) = (x + 0.1 / 3.0, 0.1 / 3.0);
        4000.0 * 0.005 * 4.0 / (4.0 + x * x + y * y).powi(2)
    };
    vec![
        ("emissive texture, PNG of one white texel", textured(png(1, &[255]), "image/png", json!({})), Lux(p)),
        ("emissive texture, PNG with a dark half", textured(png(2, &[255, 0]), "image/png", json!({})), Lux(half)),
        ("emissive texture, JPEG with a dark half", textured(jpeg(16, &halves), "image/jpeg", json!({})), Lux(half)),
        (
            "emissive texture, required transform",
            textured(png(2, &[255, 128]), "image/png", transform),
            Lux(grey(128) * p),
        ),
        ("base colour texture, JPEG", based.glb(), Lux(OF_LAMP)),
        (
            "required extensions of looks",
            with(lamp(), |file| file.json["extensionsRequired"] = json!(looks)).glb(),
            Lux(OF_LAMP),
        ),
        ("required KHR_texture_transform", requires("KHR_texture_transform").glb(), Lux(OF_LAMP)),
        ("specular-glossiness", glossy.glb(), Lux(OF_LAMP)),
        ("instanced emitters", instanced(false).glb(), Lux(emitter(0.0) + emitter(1.0))),
        ("instanced lamps", instanced(true).glb(), Lux(OF_LAMP + 140.0 / 5f64.powf(1.5))),
        ("quantized positions", quantized.glb(), Lux(p)),
        ("sparse positions", sparse.glb(), Lux(p)),
        ("morph targets", morphed.glb(), Lux(p)),
        ("scene that names a child", child.glb(), Lux(OF_LAMP)),
        ("base colour a hair above 1", over.glb(), Lux(OF_LAMP)),
        ("Blender's narrowest spot", spot(0.008_726_646_192_371_845).glb(), Lux(500.0 / 9.0)),
        ("spot narrower than rendered", spot(narrow).glb(), Lux(widened)),
        ("broken material that nothing shows", unused.glb(), Lux(OF_LAMP)),
        ("byte order mark", format!("\u{feff}{}", lamp().embedded()).into_bytes(), Lux(OF_LAMP)),
        ("base64 without padding", unpadded.json.to_string().into_bytes(), Lux(OF_LAMP)),
        ("bytes after the end", [lamp().glb(), vec![0; 5]].concat(), Lux(OF_LAMP)),
        ("hidden nodes", hidden.glb(), Lux(OF_LAMP)),
        ("near plane beyond the ground", near.glb(), Lux(OF_LAMP)),
        ("lamps of Blender's exporter", blender.glb(), Lux(OF_LAMP)),
        ("Draco", requires("KHR_draco_mesh_compression").glb(), Refused("export without compression")),
        ("meshopt", requires("EXT_meshopt_compression").glb(), Refused("gltf-transform copy")),
        (
            "emissive texture, KTX2",
            textured(b"\xabKTX 20\xbb\r\n\x1a\n".to_vec(), "image/ktx2", json!({})),
            Refused("ktxdecompress"),
        ),
        ("light of an environment", requires("EXT_lights_image_based").glb(), Refused("remove it")),
    ]
}

#[test]
fn files_as_others_write_them_open_with_the_right_light_or_say_what_would() {
    let folder = tempfile::tempdir().expect("a folder");
    let kept = std::env::var_os("CITYLIGHTS_FOREIGN_FILES");
    let mut opened = 0;
    for (i, (kind, bytes, right)) in kinds().into_iter().enumerate() {
        let name = format!("{i:02}.{}", if bytes.starts_with(b"glTF") { "glb" } else { "gltf" });
        let path = folder.path().join(&name);
        fs::write(&path, &bytes).expect("written");
        if let Some(kept) = &kept {
            fs::create_dir_all(kept)
                .and_then(|()| fs::write(std::path::Path::new(kept).join(&name), &bytes))
                .expect("kept");
        }
        match (open(&path, &Overrides::default()), right) {
            (Ok(scene), Lux(wanted)) => {
                let found = irradiance_by(&scene, Vec3::ZERO, Vec3::Z, 1_000);
                println!("{name} | {kind} | {wanted:.5} lx | {found:.5} lx | {}", scene.notes().join("; "));
                assert!((found / wanted - 1.0).abs() < 1e-2, "{kind}: {found} for {wanted}");
                assert!(scene.notes().len() <= 2, "{kind}: {:?}", scene.notes());
                opened += 1;
            }
            (Err(error), Refused(said)) => {
                println!("{name} | {kind} | refused | {error}");
                assert!(error.to_string().contains(said), "{kind}: {error}");
            }
            (Ok(_), Refused(_)) => panic!("{kind} opens"),
            (Err(error), Lux(_)) => panic!("{kind}: {error}"),
        }
    }
    assert_eq!(opened, 24);
}
