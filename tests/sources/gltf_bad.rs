//! Promise: whatever a glTF document says wrong is told with its path in the document, by exit code 2, in little time and
//! memory.
#![cfg(feature = "cli")]

use crate::common::{IN_PROPORTION, times_as_long};
use crate::made::File;
use crate::refused::{check, good, refused};
use serde_json::{Value, json};

/// A good file with one value of its JSON set.
fn with(pointer: &str, value: Value) -> File {
    let mut file = good();
    set(&mut file.json, pointer, value);
    file
}

/// Sets what a JSON pointer names; its last part may be new.
fn set(json: &mut Value, pointer: &str, value: Value) {
    let (parent, name) = pointer.rsplit_once('/').expect("a pointer");
    match json.pointer_mut(parent).unwrap_or_else(|| panic!("no {parent}")) {
        Value::Array(list) => list[name.parse::<usize>().expect("a number")] = value,
        Value::Object(map) => drop(map.insert(name.to_owned(), value)),
        other => panic!("{parent} is {other}"),
    }
}

/// Positions in place of others: by the file's own indices, over its own positions.
fn sparse(count: u64, kind: u32, indices: u32) -> Value {
    json!({
        "count": count,
        "indices": { "bufferView": indices, "componentType": kind },
        "values": { "bufferView": 0 },
    })
}

#[test]
fn the_file_that_the_others_are_made_from_is_good() {
    let scene = good().scene();
    assert_eq!((scene.lights().len(), scene.surfaces().len()), (3, 2));
}

#[test]
fn wrong_values_are_told_with_their_path() {
    let position = "meshes[0].primitives[0].attributes.POSITION";
    for (pointer, value, field, wanted) in [
        // Numbers that name nothing.
        ("/scene", json!(1), "scene", "no scene 1; the file has 1"),
        ("/scenes/0/nodes/0", json!(99), "scenes[0].nodes[0]", "no node 99"),
        ("/nodes/0/mesh", json!(7), "nodes[0].mesh", "no mesh 7"),
        ("/nodes/1/camera", json!(7), "nodes[1].camera", "no camera 7"),
        ("/nodes/0/children", json!([77]), "nodes[0].children", "no node 77"),
        (
            "/nodes/4/extensions/KHR_lights_punctual/light",
            json!(9),
            "nodes[4].extensions.KHR_lights_punctual.light",
            "no light 9",
        ),
        ("/meshes/0/primitives/0/material", json!(9), "meshes[0].primitives[0].material", "no material 9"),
        ("/meshes/0/primitives/0/indices", json!(9), "meshes[0].primitives[0].indices", "no accessor 9"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(9), position, "no accessor 9"),
        ("/accessors/0/bufferView", json!(9), "accessors[0].bufferView", "no buffer view 9"),
        ("/bufferViews/0/buffer", json!(9), "bufferViews[0].buffer", "no buffer 9"),
        ("/nodes/0/mesh", json!(4_294_967_296u64), "nodes[0].mesh", "expected u32"),
        ("/nodes/0/mesh", json!(-1), "nodes[0].mesh", "expected u32"),
        ("/nodes/0/mesh", json!("ground"), "nodes[0].mesh", "expected u32"),
        ("/nodes/0/mesh", json!(0.5), "nodes[0].mesh", "expected u32"),
        // Accessors.
        ("/accessors/0/count", json!(4_294_967_296u64), "accessors[0].count", "4294967296 elements every 12 bytes"),
        ("/accessors/0/count", json!(u64::MAX), "accessors[0].count", "do not fit in the 48"),
        ("/accessors/0/count", json!(5), "accessors[0].count", "do not fit"),
        ("/accessors/0/count", json!(0), "accessors[0].count", "1 or more"),
        ("/accessors/0/count", json!(-4), "accessors[0].count", "expected u64"),
        ("/accessors/0/byteOffset", json!(4), "accessors[0].count", "from byte 4 do not fit"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "accessors[0].byteOffset", "multiple of 4"),
        ("/accessors/0/byteOffset", json!(u64::MAX - 3), "accessors[0].count", "do not fit"),
        ("/accessors/0/byteOffset", json!(2), "accessors[0].byteOffset", "multiple of 4"),
        ("/accessors/1/byteOffset", json!(1), "accessors[1].byteOffset", "multiple of 2"),
        ("/accessors/0/componentType", json!(5125), "accessors[0].componentType", "`VEC3` of 5125 is given"),
        ("/accessors/0/componentType", json!(0), "accessors[0].componentType", "three floats"),
        ("/accessors/0/type", json!("VEC4"), "accessors[0].componentType", "`VEC4` of 5126"),
        ("/accessors/1/componentType", json!(5122), "accessors[1].componentType", "5121, 5123 or 5125"),
        ("/accessors/1/type", json!("VEC2"), "accessors[1].componentType", "`meshes[0].primitives[0].indices` needs"),
        ("/accessors/0/sparse", json!({ "count": 1 }), "accessors[0].sparse", "missing field `indices`"),
        ("/accessors/0/sparse", sparse(0, 5123, 1), "accessors[0].sparse.count", "1 to 4"),
        ("/accessors/0/sparse", sparse(5, 5123, 1), "accessors[0].sparse.count", "1 to 4"),
        ("/accessors/0/sparse", sparse(2, 5126, 1), "accessors[0].sparse.indices.componentType", "5121, 5123 or 5125"),
        ("/accessors/0/sparse", sparse(2, 5123, 9), "accessors[0].sparse.indices.bufferView", "no buffer view 9"),
        ("/accessors/0/sparse", sparse(4, 5125, 1), "accessors[0].sparse.indices.bufferView", "do not fit in the 12"),
        ("/accessors/0/sparse", sparse(4, 5123, 1), "accessors[0].sparse.indices", "index 3 is 0; 3 to below 4"),
        ("/accessors/0/bufferView", Value::Null, "accessors[0].bufferView", "is missing"),
        ("/bufferViews/0/byteLength", json!(0), "accessors[0].count", "do not fit in the 0"),
        ("/bufferViews/0/byteLength", json!(1 << 20), "bufferViews[0].byteLength", "of a buffer of"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "bufferViews[0].byteLength", "of a buffer of"),
        ("/bufferViews/0/byteStride", json!(-12), "bufferViews[0].byteStride", "expected u64"),
        ("/bufferViews/0/byteStride", json!(13), "bufferViews[0].byteStride", "a multiple of 4 from 12 to 252"),
        ("/bufferViews/0/byteStride", json!(8), "bufferViews[0].byteStride", "a multiple of 4 from 12 to 252"),
        ("/bufferViews/0/byteStride", json!(1u64 << 40), "bufferViews[0].byteStride", "from 12 to 252"),
        ("/accessors/1/count", json!(5), "meshes[0].primitives[0]", "5 vertices; three for each triangle"),
        ("/meshes/0/primitives/0/mode", json!(7), "meshes[0].primitives[0].mode", "4, 5 and 6"),
        // Nodes.
        ("/nodes/0/children", json!([3]), "nodes[4].children", "child of node 0 already"),
        ("/nodes/4/children", json!([3, 3]), "nodes[4].children", "child of node 4 already"),
        ("/nodes/4/children", json!([4, 3]), "nodes[4].children", "its own ancestor"),
        ("/nodes/0/children", json!([0]), "nodes[0].children", "its own ancestor"),
        ("/scenes/0/nodes", json!([0, 1, 0]), "scenes[0].nodes[2]", "named twice"),
        ("/nodes/1/rotation", json!([0, 0, 0, 0]), "nodes[1].rotation", "length 1"),
        ("/nodes/1/rotation", json!([0, 0, 0, 2]), "nodes[1].rotation", "length 1"),
        ("/nodes/1/rotation", json!([0, 0, 1]), "nodes[1].rotation", "array of length 4"),
        ("/nodes/0/matrix", json!([1, 2, 3]), "nodes[0].matrix", "array of length 16"),
        ("/nodes/0/matrix", json!(vec![1; 16]), "nodes[0].matrix", "0, 0, 0, 1"),
        ("/nodes/0/translation", json!([1e300, 0, 0]), position, "too far out"),
        ("/nodes/2/translation", json!([2e7, 0, 0]), "meshes[1].primitives[0].attributes.POSITION", "too far out"),
        ("/nodes/0/scale", json!([1e308, 1e308, 1e308]), position, "too far out"),
        ("/nodes/4/translation", json!([1e9, 0, 0]), "nodes[4]", "10000000 m is the most"),
        ("/nodes/1/translation", json!([1e9, 0, 0]), "nodes[1]", "the camera stands at"),
        ("/nodes/5/scale", json!([0, 0, 0]), "nodes[5]", "no direction"),
        ("/nodes/5/scale", json!([1, 1, 1e308]), "nodes[5]", "no direction"),
        ("/nodes/1/scale", json!([1, 1, 0]), "cameras[0]", "directions"),
        ("/nodes/0/scale", json!([0, 0, 0]), "", "no surfaces with an area"),
        // Lights.
        (
            "/extensions/KHR_lights_punctual/lights/0/type",
            json!("area"),
            "extensions.KHR_lights_punctual.lights[0].type",
            "point, spot or directional",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            json!(-1),
            "extensions.KHR_lights_punctual.lights[0].intensity",
            "0 or more",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            json!(1e30),
            "extensions.KHR_lights_punctual.lights[0].intensity",
            "at most",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/color",
            json!([1, -1, 1]),
            "extensions.KHR_lights_punctual.lights[0].color",
            "0 or more",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/1/spot",
            json!({ "outerConeAngle": 2 }),
            "extensions.KHR_lights_punctual.lights[1].spot.outerConeAngle",
            "(90 degrees)",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/1/spot",
            json!({ "outerConeAngle": 0 }),
            "extensions.KHR_lights_punctual.lights[1].spot.outerConeAngle",
            "above 0, up to",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/1/spot",
            json!({ "innerConeAngle": 1 }),
            "extensions.KHR_lights_punctual.lights[1].spot.innerConeAngle",
            "less than the outer",
        ),
        (
            "/extensions/KHR_lights_punctual/lights",
            json!({}),
            "extensions.KHR_lights_punctual.lights",
            "expected a list",
        ),
        // Materials.
        (
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            json!([2, 0, 0, 1]),
            "materials[0].pbrMetallicRoughness.baseColorFactor",
            "within 0 and 1",
        ),
        (
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            json!([1, 0, 0]),
            "materials[0].pbrMetallicRoughness.baseColorFactor",
            "length 4",
        ),
        ("/materials/1/emissiveFactor", json!([-1, 0, 0]), "materials[1].emissiveFactor", "negative"),
        (
            "/materials/1/extensions/KHR_materials_emissive_strength/emissiveStrength",
            json!(1e300),
            "materials[1].emissiveFactor",
            "above",
        ),
        (
            "/materials/1/emissiveTexture",
            json!({ "index": 0 }),
            "materials[1].emissiveTexture.index",
            "no texture 0; the file has 0",
        ),
        // Cameras.
        ("/cameras/0/perspective/yfov", json!(4), "cameras[0].perspective.yfov", "between 0 and pi"),
        ("/cameras/0/perspective/yfov", json!(0), "cameras[0].perspective.yfov", "between 0 and pi"),
        ("/cameras/0/perspective/aspectRatio", json!(0), "cameras[0].perspective.aspectRatio", "0.001 to 1000"),
        ("/cameras/0/extras", json!({ "resolution": [0, 9] }), "cameras[0]", "0 x 9"),
        ("/cameras/0/extras", json!({ "resolution": [100_000, 100_000] }), "cameras[0]", "2^24"),
        // The document.
        ("/asset/version", json!("1.0"), "asset.version", "\"1.0\" is given; glTF 2"),
        ("/asset/minVersion", json!("3.1"), "asset.minVersion", "\"3.1\" is given; glTF 2"),
        ("/asset", json!({}), "asset", "missing field `version`"),
        ("/scenes", json!([]), "scenes", "missing or empty"),
        (
            "/extensionsRequired",
            json!(["KHR_lights_punctual", "KHR_draco_mesh_compression"]),
            "extensionsRequired[1]",
            "export without compression, or write the file out plain: `gltf-transform copy",
        ),
        ("/extensionsUsed", json!(["KHR_lights_punctual", "EXT_lights_image_based"]), "extensionsUsed[1]", "remove it"),
        ("/extensionsRequired", json!(["\u{1b}]0;x\u{7}"]), "extensionsRequired[0]", "\\u{1b}]0;x\\u{7}"),
        (
            "/extensions/KHR_lights_punctual/lights/0/type",
            json!("\u{1b}[31m"),
            "extensions.KHR_lights_punctual.lights[0].type",
            "\\u{1b}",
        ),
    ] {
        println!("{pointer} = {value}");
        check("bad.glb", &with(pointer, value).glb(), field, wanted);
    }
}

#[test]
fn positions_and_indices_are_checked_one_by_one() {
    let position = "meshes[0].primitives[0].attributes.POSITION";
    for (bits, wanted) in [(f32::NAN.to_bits(), "NaN"), (f32::INFINITY.to_bits(), "inf"), (0xff80_0000, "-inf")] {
        let mut file = good();
        file.bin[28..32].copy_from_slice(&bits.to_le_bytes());
        check("bad.glb", &file.glb(), position, &format!("position 2 is [10, {wanted}"));
    }
    let mut file = good();
    file.bin[28..32].copy_from_slice(&1e30f32.to_le_bytes());
    check("bad.glb", &file.glb(), position, "too far out");
    for index in [4u16, 65_535] {
        let mut file = good();
        file.bin[56..58].copy_from_slice(&index.to_le_bytes());
        let wanted = format!("index 4 is {index}; there are 4 positions");
        check("bad.glb", &file.glb(), "meshes[0].primitives[0].indices", &wanted);
    }
}

#[test]
fn what_overflows_to_no_number_is_refused() {
    // The child's place: 1e300 * 1e300 - 1e300 * 1e300 along x, 0 along y and z.
    let matrix = json!([1e300, 0, 0, 0, 1e300, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    for (more, field) in [
        (json!({ "mesh": 0 }), "meshes[0].primitives[0].attributes.POSITION"),
        (json!({ "camera": 0 }), "nodes[6]"),
        (json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } }), "nodes[6]"),
    ] {
        let mut file = good();
        let mut node = json!({ "translation": [1e300, -1e300, 0] });
        node.as_object_mut().expect("an object").extend(more.as_object().expect("an object").clone());
        let child = file.push("nodes", node);
        // Before all others, so that its camera is the first.
        let parent = file.push("nodes", json!({ "children": [child], "matrix": matrix }));
        file.json["scenes"][0]["nodes"].as_array_mut().expect("a list").insert(0, json!(parent));
        check("bad.glb", &file.glb(), field, "NaN");
    }
}

#[test]
fn cycles_of_any_length_are_found() {
    for length in [1, 2, 3, 1_000] {
        let mut file = good();
        let first = file.json["nodes"].as_array().expect("a list").len();
        for i in 0..length {
            file.push("nodes", json!({ "children": [first + (i + 1) % length] }));
        }
        let (field, message) = refused("bad.glb", &file.glb());
        assert!(field.starts_with("nodes[") && message.contains("its own ancestor"), "{field}: {message}");
    }
    // Below a cycle, and beside the scene.
    let mut file = good();
    file.push("nodes", json!({ "children": [7] }));
    file.push("nodes", json!({ "children": [6, 8] }));
    file.push("nodes", json!({}));
    check("bad.glb", &file.glb(), "nodes[7].children", "node 7 is its own ancestor");
}

#[test]
fn a_hundred_thousand_nodes_deep_is_no_trouble() {
    let deep = |depth: usize| {
        let mut file = good();
        let first = file.json["nodes"].as_array().expect("a list").len();
        for i in 0..depth {
            file.push("nodes", json!({ "children": [first + i + 1], "translation": [0, 1e-4, 0] }));
        }
        file.push("nodes", json!({ "mesh": 0 }));
        file.json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(first));
        file
    };
    let [shallow, deep] = [10_000, 100_000].map(deep);
    assert!((deep.scene().surfaces()[2].corners[0].z - 10.0).abs() < 1e-5);
    let ratio = times_as_long(|| drop(deep.scene()), || drop(shallow.scene()));
    assert!(ratio < IN_PROPORTION, "{ratio} times as long for ten times the depth");
}

#[test]
fn instances_beyond_what_memory_holds_are_refused_before_they_are_made() {
    // A thousand nodes show a mesh of ten thousand primitives, each the whole ground.
    let mut file = good();
    let primitive = file.json["meshes"][0]["primitives"][0].clone();
    file.json["meshes"][0]["primitives"] = json!(vec![primitive; 10_000]);
    for _ in 0..1_000 {
        file.node(json!({ "mesh": 0 }));
    }
    let (field, message) = refused("bad.glb", &file.glb());
    assert!(field.starts_with("nodes[") && message.contains("more than 16777216 triangles"), "{field}: {message}");
    // And one whose primitives have no triangles.
    file.json["meshes"][0]["primitives"] = json!(vec![json!({ "attributes": {} }); 20_000]);
    let (_, message) = refused("bad.glb", &file.glb());
    assert!(message.contains("more than 16777216 triangles"), "{message}");
}
