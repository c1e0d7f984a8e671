//! Promise: a glTF file goes wherever a scene goes, in each of its containers, and what is not used in it is told.
#![cfg(feature = "cli")]

use crate::common::digest;
use crate::made::File;
use assert_cmd::Command;
use citylights::scene::Scene;
use citylights::scene::light::Kind;
use citylights::sources::{Overrides, open};
use glam::Vec3;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::path::Path;

fn citylights() -> Command {
    Command::cargo_bin("citylights").expect("the binary")
}

/// A ground with a light of each kind.
fn lit() -> File {
    let mut file = File::ground();
    file.emitter([[0.0, 3.0, 0.0], [0.0, 3.0, -1.0], [1.0, 3.0, 0.0]], 40.0, false, json!({ "name": "sign" }));
    file.lamp(json!({ "type": "point", "intensity": 90 }), json!({ "name": "Lamp.001", "translation": [1, 4, 2] }));
    file.lamp(json!({ "type": "point", "intensity": 80 }), json!({ "name": "Lamp.002", "translation": [-3, 4, 2] }));
    let down = json!({ "name": "spot", "translation": [4, 5, 0], "rotation": [-0.5f64.sqrt(), 0, 0, 0.5f64.sqrt()] });
    file.lamp(json!({ "type": "spot", "intensity": 70 }), down.clone());
    file.lamp(json!({ "type": "directional", "intensity": 0.2 }), json!({ "rotation": down["rotation"] }));
    file
}

fn notes(scene: &Scene) -> String {
    scene.notes().join("\n")
}

#[test]
fn three_containers_give_the_same_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let file = lit();
    std::fs::write(at("a.glb"), file.glb()).expect("written");
    std::fs::write(at("b.gltf"), file.embedded()).expect("written");
    std::fs::write(at("c.GLTF"), file.beside("the%20buffers/%c3%a4.bin")).expect("written");
    std::fs::create_dir(at("the buffers")).expect("made");
    std::fs::write(at("the buffers/ä.bin"), &file.bin).expect("written");
    let [a, b, c] = ["a.glb", "b.gltf", "c.GLTF"].map(|name| {
        let scene = open(&at(name), &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.lights().len(), 5);
        assert_eq!(scene.name(), &name[..1], "a file without a scene's name is called after itself");
        digest(&scene)
    });
    assert!(a == b && a == c);
}

#[test]
fn every_verb_takes_a_gltf_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("lit.glb");
    let mut file = lit();
    // The study looks at streets and facades.
    file.json["materials"][0]["extras"] = json!({ "street": true });
    let wall = file.positions(&[[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [0.0, 9.0, -9.0]]);
    let wall = file.mesh(json!({ "attributes": { "POSITION": wall } }));
    file.node(json!({ "mesh": wall }));
    std::fs::write(&path, file.glb()).expect("written");
    let run = |verb: &str, more: &[&str]| {
        let mut command = citylights();
        command.current_dir(folder.path()).arg(verb).arg(&path).args(["--resolution", "24x16"]).args(more);
        command.assert().success()
    };
    run("inspect", &[]).stdout(contains("lit (").and(contains("Lamp")).and(contains("directional")));
    run("render", &["--strategy", "all", "--spp", "1", "-o", "a.png"]);
    run("reference", &["--noise", "0.1", "-o", "a.exr"]);
    run("compare", &["--strategies", "power,all", "--repeats", "2", "--budget", "2", "--out", "out"])
        .stdout(contains("power"));
    run("verify", &["--strategies", "power", "--draws", "2000", "--places", "4", "--quiet"]);
    let mut command = citylights();
    command.current_dir(folder.path()).args(["study", "strategies", "--scene"]).arg(&path).args([
        "--strategies",
        "power",
        "--resolution",
        "8x6",
        "--receivers",
        "2",
        "--pixels",
        "2",
        "--passes",
        "1",
        "--repeats",
        "2",
        "--out",
        "study",
    ]);
    command.assert().success().stdout(contains("power"));
}

#[test]
fn what_only_a_recipe_has_is_refused_and_the_other_way_round() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("lit.glb");
    std::fs::write(&path, lit().glb()).expect("written");
    let refused = |verb: &[&str], scene: &Path, said: &str| {
        let mut command = citylights();
        command.args(verb).arg(scene);
        command.assert().code(2).stdout("").stderr(contains(said));
    };
    refused(&["inspect", "--scene-seed", "3"], &path, "lit.glb: `seed`: a glTF file generates nothing");
    refused(&["inspect", "--camera", "eye"], "scenes/lamps-only.toml".as_ref(), "`camera`: a recipe has one camera");
    refused(&["study", "scaling", "--scene"], &path, "`city`");
}

fn camera(name: &str, x: f64, extra: &Value) -> (Value, Value) {
    let mut camera = json!({ "type": "perspective", "name": name, "perspective": { "yfov": 0.8, "znear": 0.1 } });
    camera.as_object_mut().expect("an object").extend(extra.as_object().expect("an object").clone());
    (camera, json!({ "name": format!("node of {name}"), "translation": [x, 5, 12] }))
}

#[test]
fn cameras_are_chosen_by_name() {
    let mut file = File::ground();
    for (name, x) in [("left", -3.0), ("right", 3.0)] {
        let (camera, mut node) = camera(name, x, &json!({}));
        node["camera"] = json!(file.push("cameras", camera));
        file.node(node);
    }
    let of = |name: Option<&str>| file.read_with(&Overrides { camera: name.map(Into::into), ..Overrides::default() });
    let first = of(None).expect("the first");
    assert_eq!(first.camera().position(), Vec3::new(0.0, -12.0, 5.0));
    assert!((first.camera().forward().as_vec3() - Vec3::Y).length() < 1e-7, "-z is our +y");
    assert!((first.camera().up().as_vec3() - Vec3::Z).length() < 1e-7);
    assert!((first.camera().fov() - 1f64.to_degrees()).abs() < 1e-5);
    assert!(notes(&first).contains("of 3 cameras the first is used, eye"), "{}", notes(&first));
    for name in ["right", "node of right"] {
        let scene = of(Some(name)).expect("a camera");
        assert_eq!(scene.camera().position(), Vec3::new(3.0, -12.0, 5.0), "{name}");
        assert!(!notes(&scene).contains("camera"), "{}", notes(&scene));
    }
    let error = of(Some("Right")).expect_err("names are taken as they are").to_string();
    assert!(error.contains("`Right`") && error.contains("`eye`, `node of left`, `node of right`"), "{error}");
}

#[test]
fn a_name_that_two_cameras_bear_is_the_first_ones() {
    let mut file = File::ground();
    let (camera, mut node) = camera("eye", 7.0, &json!({}));
    node["camera"] = json!(file.push("cameras", camera));
    node["name"] = json!("eye");
    file.node(node);
    let scene = file.read_with(&Overrides { camera: Some("eye".into()), ..Overrides::default() }).expect("a camera");
    assert_eq!(scene.camera().position().x, 0.0);
    assert!(notes(&scene).contains("2 cameras are called eye"), "{}", notes(&scene));
}

#[test]
fn the_film_is_the_options_the_exports_or_of_the_cameras_proportions() {
    let film = |perspective: Value, extras: Value, option: Option<(u32, u32)>| {
        let mut file = File::ground();
        let (camera, mut node) = camera("a", 0.0, &json!({ "perspective": perspective, "extras": extras }));
        node["camera"] = json!(file.push("cameras", camera));
        file.node(node);
        let overrides = Overrides { camera: Some("a".into()), resolution: option, ..Overrides::default() };
        file.read_with(&overrides).expect("a scene").camera().resolution()
    };
    let wide = json!({ "yfov": 1, "aspectRatio": 2.25, "znear": 1 });
    assert_eq!(film(wide.clone(), json!({}), None), (270, 120));
    assert_eq!(film(json!({ "yfov": 1, "znear": 1 }), json!({}), None), (240, 135));
    assert_eq!(film(wide.clone(), json!({ "resolution": [31, 17] }), None), (31, 17));
    assert_eq!(film(wide.clone(), json!({ "resolution": [31, 17] }), Some((8, 9))), (8, 9));
    for others in [json!({ "resolution": "high" }), json!({ "resolution": [1.5, 2, 3] }), json!([1]), json!("x")] {
        assert_eq!(film(wide.clone(), others, None), (270, 120), "what others keep there is passed over");
    }
}

#[test]
fn without_a_camera_in_perspective_the_whole_scene_is_seen() {
    let mut file = File::ground();
    file.json["cameras"][0] = json!({ "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1 } });
    let scene = file.scene();
    let text = notes(&scene);
    assert!(text.contains("no perspective camera") && text.contains("orthographic cameras: 1; not used"), "{text}");
    let camera = scene.camera();
    for surface in scene.surfaces() {
        for corner in surface.corners {
            let away = (corner - camera.position()).as_dvec3().normalize();
            let (forward, up) = (away.dot(camera.forward()), away.dot(camera.up()));
            assert!(up.abs() / forward <= 30f64.to_radians().tan(), "{corner} is out of the picture");
        }
    }
    let error = file.read_with(&Overrides { camera: Some("eye".into()), ..Overrides::default() });
    assert!(error.expect_err("it is orthographic").to_string().contains("none in perspective"));
}

#[test]
fn our_extras_are_read() {
    let mut file = File::ground();
    file.json["scenes"][0] = json!({ "name": "a street", "nodes": [0, 1], "extras": { "ev100": 3.5, "more": [1] } });
    file.json["materials"][0]["extras"] = json!({ "street": true });
    let scene = file.scene();
    assert_eq!((scene.name(), scene.ev100(), scene.materials()[0].street), ("a street", Some(3.5), true));
    let scene = file.read_with(&Overrides { ev100: Some(9.0), ..Overrides::default() }).expect("a scene");
    assert_eq!(scene.ev100(), Some(9.0));
    file.json["scenes"][0]["extras"] = json!({ "ev100": "bright" });
    assert_eq!(file.scene().ev100(), None);
    file.json["scenes"][0]["extras"] = json!({ "ev100": 1e300 });
    assert_eq!(file.scene().ev100(), None, "its exposure would be 0");
}

#[test]
fn lights_are_grouped_by_the_names_of_their_nodes() {
    let scene = lit().scene();
    let groups: Vec<_> = scene.groups().iter().map(|group| (group.name.as_str(), group.range.clone())).collect();
    assert_eq!(groups, [("sign", 0..1), ("Lamp", 1..3), ("spot", 3..4), ("lights without a name", 4..5)]);
    // Lights of one group stand together, wherever their nodes do.
    let mut file = lit();
    file.lamp(json!({ "type": "point", "intensity": 60 }), json!({ "name": "sign", "translation": [-3, 4, 2] }));
    let scene = file.scene();
    assert_eq!(scene.groups()[0].range, 0..2);
    assert_eq!((scene.lights()[0].kind(), scene.lights()[1].kind()), (Kind::Triangle, Kind::Point));
    // Names that differ are too many to read.
    for letter in 'a'..='z' {
        file.lamp(json!({ "type": "point" }), json!({ "name": format!("lamp {letter}"), "translation": [0, 9, 0] }));
    }
    let scene = file.scene();
    let names: Vec<_> = scene.groups().iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["point lights", "spot lights", "directional lights", "triangle lights"]);
}

#[test]
fn names_that_would_break_a_table_are_made_fit() {
    let mut file = lit();
    let nasty = "\u{1b}[31m|</td>\n,`\u{202e}\"'\\/ ".repeat(20);
    file.json["scenes"][0]["name"] = json!(nasty);
    file.json["nodes"][2]["name"] = json!(nasty);
    file.json["materials"][0]["name"] = json!(nasty);
    let scene = file.scene();
    let names = [scene.name(), &scene.groups()[0].name, &scene.materials()[0].name];
    for name in names {
        assert!(name.chars().count() <= 64 && name.starts_with("_[31m__"), "{name:?}");
        assert!(!name.contains(|c: char| c.is_control() || "<>|/\\\"'`,\u{202e}".contains(c)), "{name:?}");
    }
    for blank in ["", " \n\t", "Scene"] {
        file.json["scenes"][0]["name"] = json!(blank);
        assert_eq!(file.scene().name(), "test");
    }
}

#[test]
fn what_is_not_used_is_told_once() {
    let mut file = lit();
    let texture = json!({ "index": 0 });
    for material in file.json["materials"].as_array_mut().expect("a list") {
        material["pbrMetallicRoughness"] = json!({ "baseColorTexture": texture, "baseColorFactor": [1, 1, 1, 1] });
        material["normalTexture"] = texture.clone();
        material["alphaMode"] = json!("MASK");
        material["extensions"]["KHR_materials_unlit"] = json!({});
    }
    // An image that is not there decides no albedo.
    for list in ["animations", "skins", "textures", "images", "samplers"] {
        file.json[list] = json!([{}]);
    }
    let primitive = &mut file.json["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{}]);
    primitive["attributes"]["COLOR_0"] = json!(0);
    file.mesh(json!({ "attributes": { "POSITION": 0 }, "mode": 1 }));
    file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["range"] = json!(10);
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_unlit", "KHR_materials_clearcoat"]);
    let scene = file.scene();
    for said in [
        "base colour textures of materials that cannot be read: 1; the factor alone is the albedo (test.glb: `textures[0].source`: is missing",
        "normal and occlusion textures of materials: 2;",
        "metallic materials, as glTF has them unless a `metallicFactor` says otherwise: 1;",
        "materials that blend or mask: 2;",
        "unlit materials: 2;",
        "emissive materials with a base colour: 1;",
        "primitives of points, of lines or without positions: 1;",
        "primitives with vertex colours: 1;",
        "primitives with morph targets: 1;",
        "skins: 1;",
        "animations: 1;",
        "lights with a `range`: 1;",
        "extensions that are not used: KHR_materials_unlit, KHR_materials_clearcoat",
    ] {
        assert_eq!(notes(&scene).matches(said).count(), 1, "{said} in\n{}", notes(&scene));
    }
    assert_eq!(lit().scene().notes(), ["no EV100 is given: exposure is 1"], "nothing else to tell");
}
