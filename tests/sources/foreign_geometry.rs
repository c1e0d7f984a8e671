//! Promise: meshes as others write them stand where they say: instanced, quantized, sparse or morphed.
#![cfg(feature = "cli")]

use crate::foreign_made::{only_note, panel, told};
use crate::made::{File, irradiance, near};
use citylights::scene::light::{Light, Shape};
use glam::Vec3;
use serde_json::{Value, json};

/// Adds the attributes of three instances: along x, turned and scaled.
fn three(file: &mut File, rotations: (u32, &[u8])) -> Value {
    let [translation, scale] =
        [[[-3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, 0.0, 2.0]], [[1.0; 3], [2.0, 1.0, 1.0], [1.0; 3]]]
            .map(|vectors| file.positions(&vectors));
    let rotation = file.accessor(rotations.1, rotations.0, 3, "VEC4");
    file.json["accessors"][rotation]["normalized"] = json!(rotations.0 != 5126);
    let attributes = json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale });
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "EXT_mesh_gpu_instancing"]);
    file.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    json!({ "attributes": attributes })
}

/// No turn, no turn, a quarter about +y.
fn turns() -> Vec<u8> {
    let half = 0.5f32.sqrt();
    let floats = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [0.0, half, 0.0, half]];
    floats.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[test]
fn instanced_emitters_stand_where_nodes_would() {
    let corners = [[0.25, 4.0, 0.1], [0.5, 4.0, -1.0], [1.0, 4.0, -0.3]];
    let shorts: Vec<u8> = [[0i16, 0, 0, 32767], [0, 0, 0, 32767], [0, 23170, 0, 23170]]
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let half = 0.5f64.sqrt();
    let mut by_nodes = File::ground();
    let material = by_nodes.emitter(corners, 50.0, false, json!({ "translation": [-3, 0, 0] }));
    let mesh = by_nodes.json["nodes"][material]["mesh"].clone();
    by_nodes.node(json!({ "mesh": mesh, "translation": [0, 1, 0], "scale": [2, 1, 1] }));
    by_nodes.node(json!({ "mesh": mesh, "translation": [3, 0, 2], "rotation": [0, half, 0, half] }));
    for (rotations, digits) in [((5126, turns()), 1e-6), ((5122, shorts), 1e-3)] {
        let mut file = File::ground();
        let instancing = three(&mut file, (rotations.0, &rotations.1));
        // The node's own place comes after that of its instances.
        let node = json!({ "extensions": { "EXT_mesh_gpu_instancing": instancing }, "translation": [0, 0, 0.5] });
        file.emitter(corners, 50.0, false, node);
        let scene = file.scene();
        assert_eq!(scene.lights().len(), 3);
        for (found, wanted) in scene.lights().iter().zip(by_nodes.scene().lights()) {
            let (Shape::Triangle { corners: a, .. }, Shape::Triangle { corners: b, .. }) =
                (found.shape(), wanted.shape())
            else {
                panic!("triangles")
            };
            for (a, b) in a.into_iter().zip(b) {
                assert!((a - b - Vec3::new(0.0, -0.5, 0.0)).length() < digits, "{a} and {b}");
            }
        }
        assert!(told(&scene).is_empty(), "{:?}", told(&scene));
    }
}

#[test]
fn instanced_lamps_are_as_many() {
    for below in [false, true] {
        let mut file = File::ground();
        let instancing = three(&mut file, (5126, &turns()));
        let light = file.light(json!({ "type": "point", "intensity": 90 }));
        let mut node = json!({ "translation": [0, 2, 0], "extensions": { "EXT_mesh_gpu_instancing": instancing } });
        let light = json!({ "light": light });
        if below {
            let lamp = json!({ "translation": [0.5, 0, 0], "extensions": { "KHR_lights_punctual": light } });
            node["children"] = json!([file.push("nodes", lamp)]);
        } else {
            node["extensions"]["KHR_lights_punctual"] = light;
        }
        file.node(node);
        let scene = file.scene();
        let x = if below { [0.5f32, 1.0, 0.0] } else { [0.0; 3] };
        // The last one's child is turned away from x.
        let y = if below { 0.5 } else { 0.0 };
        let wanted = [[x[0] - 3.0, 0.0, 2.0], [x[1], 0.0, 3.0], [3.0, y - 2.0, 2.0]].map(Vec3::from_array);
        let at = |light: &Light| match light.shape() {
            Shape::Point { position, .. } => position,
            other => panic!("{other:?}"),
        };
        for (found, wanted) in scene.lights().iter().map(at).zip(wanted) {
            assert!((found - wanted).length() < 1e-6, "{found} for {wanted}");
        }
        let sum: f64 = wanted.iter().map(|p| 90.0 * f64::from(p.z) / f64::from(p.length()).powi(3)).sum();
        near(irradiance(&scene, Vec3::ZERO, Vec3::Z), sum, 1e-5);
        only_note(&scene, "instanced nodes with lights or children: 1;");
    }
}

#[test]
fn quantized_positions_are_the_same_panel() {
    let whole = panel(|_, _| ());
    let wanted = irradiance(&whole.scene(), Vec3::ZERO, Vec3::Z);
    let corners = [[-1i8, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]];
    let bytes = |unit: i16| -> [Vec<u8>; 2] {
        let padded = corners.map(|[x, y, z]| [x, y, z, 0]);
        let words = padded.as_flattened().iter().flat_map(|x| (i16::from(*x) * unit).to_le_bytes()).collect();
        [padded.as_flattened().iter().map(|x| (x * unit.min(127) as i8) as u8).collect(), words]
    };
    for normalized in [false, true] {
        for (i, kind) in [5120, 5122].into_iter().enumerate() {
            let unit = if !normalized { 1 } else { [127, 32767][i] };
            let mut file = panel(|_, _| ());
            let data = &bytes(unit)[i];
            let accessor = file.accessor(data, kind, 4, "VEC3");
            file.json["accessors"][accessor]["normalized"] = json!(normalized);
            let view = file.json["accessors"][accessor]["bufferView"].as_u64().expect("a number") as usize;
            file.json["bufferViews"][view]["byteStride"] = json!(data.len() / 4);
            file.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] = json!(accessor);
            file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
            near(irradiance(&file.scene(), Vec3::ZERO, Vec3::Z), wanted, 1e-6);
            assert!(told(&file.scene()).is_empty());
        }
    }
}

#[test]
fn sparse_positions_lie_over_their_base_or_over_zeros() {
    let wanted = irradiance(&panel(|_, _| ()).scene(), Vec3::ZERO, Vec3::Z);
    for base in [true, false] {
        let mut file = panel(|_, _| ());
        let id = file.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"].as_u64().expect("a number") as usize;
        // All but the first corner if there is a base, whose last three lie elsewhere.
        let corners = [[-1.0f32, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]];
        let from = usize::from(base);
        let values: Vec<u8> = corners[from..].as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let indices: Vec<u8> = (from as u8..4).collect();
        let (values, indices) = (file.view(&values), file.view(&indices));
        let mut accessor = json!({
            "componentType": 5126, "count": 4, "type": "VEC3",
            "sparse": {
                "count": 4 - from,
                "indices": { "bufferView": indices, "componentType": 5121 },
                "values": { "bufferView": values },
            },
        });
        if base {
            let wrong = file.positions(&[corners[0], [9.0; 3], [9.0; 3], [9.0; 3]]);
            accessor["bufferView"] = file.json["accessors"][wrong]["bufferView"].clone();
        }
        file.json["accessors"][id] = accessor;
        near(irradiance(&file.scene(), Vec3::ZERO, Vec3::Z), wanted, 1e-6);
        assert!(told(&file.scene()).is_empty());
    }
}

#[test]
fn morph_targets_are_shown_at_the_files_weights() {
    let mut file = panel(|_, _| ());
    let wanted = irradiance(&file.scene(), Vec3::ZERO, Vec3::Z);
    // Two targets lift the panel by 4 m and by 8 m; it hangs 4 m lower.
    let targets: Vec<Value> =
        [4.0, 8.0].map(|y| json!({ "POSITION": file.positions(&[[0.0, y, 0.0]; 4]) })).into_iter().collect();
    file.json["meshes"][1]["primitives"][0]["targets"] = json!(targets);
    file.json["nodes"][2]["translation"] = json!([0, 0, 0]);
    for (of_mesh, of_node) in [(json!([1.0, 0.0]), None), (json!([0.5, 0.25]), None), (json!([9, 9]), Some([0.0, 0.5]))]
    {
        file.json["meshes"][1]["weights"] = of_mesh;
        if let Some(weights) = of_node {
            file.json["nodes"][2]["weights"] = json!(weights);
        }
        near(irradiance(&file.scene(), Vec3::ZERO, Vec3::Z), wanted, 1e-6);
        only_note(&file.scene(), "primitives with morph targets: 1; shown at the weights that the file gives");
    }
}
