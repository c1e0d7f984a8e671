//! Promise: files as others write them open with the right light, and with one note for each thing that is left out.
#![cfg(feature = "cli")]

use crate::foreign_made::{DOWN, lamp, only_note, panel, told};
use crate::made::{File, irradiance, near};
use assert_cmd::Command;
use base64::Engine;
use citylights::sources::gltf::parse;
use citylights::sources::{Overrides, open};
use glam::Vec3;
use predicates::str::contains;
use serde_json::{Value, json};

/// Irradiance under that lamp.
const LAMP: f64 = 70.0 / 4.0;

fn under(file: &File) -> f64 {
    irradiance(&file.scene(), Vec3::ZERO, Vec3::Z)
}

#[test]
fn required_extensions_that_change_looks_alone_are_told_once() {
    for name in [
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_transmission",
        "KHR_materials_clearcoat",
        "KHR_materials_sheen",
        "KHR_materials_ior",
        "KHR_materials_volume",
        "KHR_materials_iridescence",
        "KHR_materials_anisotropy",
        "KHR_materials_dispersion",
        "KHR_xmp_json_ld",
    ] {
        let mut file = lamp();
        file.json["extensionsUsed"] = json!(["KHR_lights_punctual", name]);
        file.json["extensionsRequired"] = json!([name]);
        near(under(&file), LAMP, 1e-6);
        only_note(&file.scene(), &format!("extensions that are not used: {name}"));
    }
    // These are read, and say nothing where nothing is theirs.
    for name in ["KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_specular"] {
        let mut file = lamp();
        file.json["extensionsRequired"] = json!([name]);
        near(under(&file), LAMP, 1e-6);
        assert!(told(&file.scene()).is_empty());
    }
}

#[test]
fn the_diffuse_colour_of_specular_glossiness_is_the_albedo() {
    let mut file = lamp();
    let name = "KHR_materials_pbrSpecularGlossiness";
    file.json["materials"][0] = json!({ "extensions": { name: { "diffuseFactor": [0.2, 0.4, 0.6, 1] } } });
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", name]);
    file.json["extensionsRequired"] = json!([name]);
    let scene = file.scene();
    assert_eq!(scene.materials()[0].albedo, Vec3::new(0.2, 0.4, 0.6));
    only_note(&scene, "specular-glossiness materials: 1; their diffuse colour is the albedo");
    near(under(&file), LAMP, 1e-6);
}

#[test]
fn a_scene_that_names_a_child_shows_it_without_its_parent() {
    let mut file = lamp();
    // The lamp's parent would lift it out of sight.
    file.push("nodes", json!({ "name": "tmpParent", "children": [2], "translation": [0, 50, 0] }));
    near(under(&file), LAMP, 1e-6);
    only_note(&file.scene(), "nodes that the scene names without their parents: 1;");
    // With its parent named too it stands below that alone.
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    near(under(&file), 70.0 / 52f64.powi(2), 1e-6);
    only_note(&file.scene(), "nodes that the scene names beside one above them: 1;");
}

#[test]
fn colours_a_hair_outside_are_clamped() {
    for (given, wanted) in [(1.000_16, 1.0), (1.0099, 1.0), (-1e-6, 0.0)] {
        let mut file = lamp();
        file.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([given, 0.5, 0.5, 1]);
        assert_eq!(file.scene().materials()[0].albedo, Vec3::new(wanted, 0.5, 0.5));
        only_note(&file.scene(), "base colours a hair above 1 or below 0: 1; taken as 1 and 0");
    }
}

#[test]
fn narrow_spots_keep_their_flux() {
    let spot = |inner: f64, outer: f64| {
        let mut file = File::ground();
        let cones = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
        file.lamp(
            json!({ "type": "spot", "intensity": 500, "spot": cones }),
            json!({ "translation": [0, 3, 0], "rotation": DOWN }),
        );
        file.scene()
    };
    // Blender's least angle, 1 degree in f32, over 2.
    let least = spot(0.0, 0.008_726_646_192_371_845);
    near(irradiance(&least, Vec3::ZERO, Vec3::Z), 500.0 / 9.0, 1e-6);
    assert!(told(&least).is_empty());
    let flux = |scene: &citylights::scene::Scene| f64::from(scene.lights()[0].flux(1.0).x);
    for outer in [0.004, 1e-4] {
        for share in [0.0, 0.5, 1.0] {
            let scene = spot(share * outer, outer);
            only_note(&scene, "spots narrower than 0.5 degrees: 1; widened to that with their flux kept");
            // 2 pi times the inner cap and a third of the ring.
            let (inner, o2) = ((share * outer).powi(2) / 2.0, outer.powi(2) / 2.0);
            let wanted = 500.0 * std::f64::consts::TAU * (inner + (o2 - inner) / 3.0);
            near(flux(&scene), wanted, 4e-3);
        }
    }
}

#[test]
fn a_broken_material_that_nothing_shows_does_not_matter() {
    let mut file = lamp();
    for broken in [
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [7, 0, 0, 1] } }),
        json!({ "emissiveFactor": [-1, 0, 0] }),
        json!({ "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 77 } }),
    ] {
        file.push("materials", broken);
    }
    near(under(&file), LAMP, 1e-6);
}

#[test]
fn containers_with_what_others_add_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut file = lamp();
    // A length that wants padding.
    file.bin.push(0);
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("mark.gltf"), format!("\u{feff}{}", file.embedded())).expect("written");
    let unpadded = file.embedded();
    let data = base64::engine::general_purpose::STANDARD.encode(&file.bin);
    assert!(data.ends_with('='), "padding to leave out");
    std::fs::write(at("unpadded.gltf"), unpadded.replace(&data, data.trim_end_matches('='))).expect("written");
    std::fs::write(at("trailing.glb"), [&file.glb()[..], b"\0\0\0"].concat()).expect("written");
    for (name, note) in [
        ("mark.gltf", None),
        ("unpadded.gltf", None),
        ("trailing.glb", Some("bytes after the end that the file announces: 3")),
    ] {
        let scene = open(&at(name), &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        near(irradiance(&scene, Vec3::ZERO, Vec3::Z), LAMP, 1e-6);
        note.map_or_else(|| assert!(told(&scene).is_empty()), |note| only_note(&scene, note));
    }
}

#[test]
fn what_blender_writes_too_bright_is_told_and_divided() {
    let mut file = lamp();
    file.json["asset"]["generator"] = json!("Khronos glTF Blender I/O v4.2.57");
    only_note(&file.scene(), "lamps that Blender's exporter wrote: 1; unless its lighting mode was `Unitless`");
    let divided = Overrides { lamps_divided_by: Some(683.0), ..Overrides::default() };
    let scene = file.read_with(&divided).expect("a scene");
    near(irradiance(&scene, Vec3::ZERO, Vec3::Z), LAMP / 683.0, 1e-6);
    assert!(told(&scene).is_empty());
    // Emitters stay as they are.
    let lit = panel(|_, _| ());
    let [as_it_is, divided] = [Overrides::default(), divided].map(|o| lit.read_with(&o).expect("a scene"));
    let of = |scene| irradiance(scene, Vec3::ZERO, Vec3::Z);
    near(of(&divided), of(&as_it_is), 1e-9);

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("lamp.glb");
    std::fs::write(&path, file.glb()).expect("written");
    let run = |more: &[&str]| {
        let mut command = Command::cargo_bin("citylights").expect("the binary");
        command.arg("inspect").arg(&path).args(more).assert()
    };
    run(&[]).success().stderr(contains("--lamps-divided-by 683"));
    run(&["--lamps-divided-by", "683"]).success();
    run(&["--lamps-divided-by", "0"]).code(2);
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.args(["inspect", "scenes/lamps-only.toml", "--lamps-divided-by", "683"]);
    command.assert().code(2).stderr(contains("only those of a glTF file can be divided"));
}

#[test]
fn what_the_cameras_planes_cut_away_is_told() {
    let with = |near: f64, far: Value| {
        let mut file = lamp();
        file.json["cameras"][0]["perspective"]["znear"] = json!(near);
        file.json["cameras"][0]["perspective"]["zfar"] = far;
        let scene = file.scene();
        crate::made::near(irradiance(&scene, Vec3::ZERO, Vec3::Z), LAMP, 1e-6);
        told(&scene)
    };
    // The ground lies from 2 m on below the camera's place; its edge in the picture about 9 m away.
    assert!(with(0.1, json!(100)).is_empty());
    assert!(with(0.1, Value::Null).is_empty());
    let said = with(15.0, json!(100));
    assert!(said.len() == 1 && said[0].contains("2 before its `znear` of 15 m"), "{said:?}");
    let said = with(0.1, json!(12));
    assert!(said.len() == 1 && said[0].contains("2 beyond its `zfar` of 12 m"), "{said:?}");
    // A wall behind the camera is cut by nobody's plane.
    let mut file = lamp();
    let wall = file.positions(&[[-1.0, 4.0, 12.2], [1.0, 4.0, 12.2], [0.0, 6.0, 12.2]]);
    let wall = file.mesh(json!({ "attributes": { "POSITION": wall }, "material": 0 }));
    file.node(json!({ "mesh": wall }));
    file.json["cameras"][0]["perspective"]["znear"] = json!(1);
    assert!(told(&file.scene()).is_empty());
}

#[test]
fn hidden_nodes_are_left_out() {
    let mut file = lamp();
    let child = file.push("nodes", json!({ "mesh": 0, "translation": [0, 1, 0] }));
    file.node(json!({ "children": [child], "extensions": { "KHR_node_visibility": { "visible": false } } }));
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_node_visibility"]);
    near(under(&file), LAMP, 1e-6);
    only_note(&file.scene(), "nodes that the file hides: 1; left out with all below them");
}

#[test]
fn what_stays_refused_tells_why_and_a_way_round() {
    for (used, name, said) in [
        ("extensionsRequired", "KHR_draco_mesh_compression", "export without compression"),
        ("extensionsRequired", "EXT_meshopt_compression", "`gltf-transform copy IN.glb OUT.glb`"),
        ("extensionsRequired", "EXT_of_tomorrow", "take it out of `extensionsRequired`"),
        ("extensionsUsed", "EXT_lights_image_based", "remove it"),
        ("extensionsUsed", "EXT_lights_ies", "remove it"),
    ] {
        let mut file = lamp();
        file.json[used] = json!([name]);
        // Nothing is at hand that the extension would have put there.
        file.json["buffers"] = json!([{ "byteLength": file.bin.len() }, { "byteLength": 9 }]);
        let error = file.read().expect_err("refused").to_string();
        assert!(error.contains(&format!("`{used}[0]`")) && error.contains(said), "{error}");
    }
    // Compressed without saying so.
    let mut file = lamp();
    file.json["accessors"][0]["bufferView"].take();
    let error = parse(&file.glb(), "a.glb".as_ref(), &Overrides::default()).expect_err("refused").to_string();
    assert!(error.contains("must be written without compression"), "{error}");
}
