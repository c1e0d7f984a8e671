//! Promise: a glTF file of a hundred thousand lights in seventy thousand materials is read in a gigabyte, and in a time
//! that grows as its size.
#![cfg(feature = "cli")]

use crate::common::{IN_PROPORTION, times_as_long};
use crate::made::glb;
use citylights::sources::{Overrides, open};
use std::fmt::Write;
use std::path::Path;

const LIGHTS: usize = 100_000;
const MATERIALS: usize = 70_000;
/// As in the crowded exports that other tools have been given.
const SIZE: usize = 42_000_000;

/// Triangles in rows 3 m apart, as exporters write them: of each material a mesh with a node, an accessor and a view of
/// its own; then a ground, which the rest of the bytes are normals of. All of that over `part`.
fn file(part: usize) -> Vec<u8> {
    let [lights, materials, size] = [LIGHTS, MATERIALS, SIZE].map(|all| all / part);
    let mut bin: Vec<u8> = Vec::new();
    let mut json = [const { String::new() }; 5];
    let mut add = |triangles: &[[[f32; 3]; 3]], material: usize, name: &str, look: &str| {
        let at = bin.len();
        bin.extend(triangles.as_flattened().as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        let (length, count) = (bin.len() - at, triangles.len() * 3);
        let comma = if material == 0 { "" } else { "," };
        let [nodes, meshes, looks, accessors, views] = &mut json;
        write!(nodes, r#"{comma}{{"name":"{name}","mesh":{material}}}"#)?;
        write!(
            meshes,
            r#"{comma}{{"name":"{name}","primitives":[{{"attributes":{{"POSITION":{material}}},"material":{material},"mode":4}}]}}"#
        )?;
        write!(looks, r#"{comma}{{"name":"material {material}",{look}}}"#)?;
        write!(accessors, r#"{comma}{{"bufferView":{material},"componentType":5126,"count":{count},"type":"VEC3"}}"#)?;
        write!(views, r#"{comma}{{"buffer":0,"byteOffset":{at},"byteLength":{length},"byteStride":12,"target":34962}}"#)
    };
    let triangle = |i: usize| {
        let (x, z) = ((i % 300) as f32 * 3.0 - 450.0, (i / 300) as f32 * 3.0 - 500.0);
        [[x, 5.0, z], [x, 6.0, z], [x + 1.0, 5.0, z]]
    };
    let mut next = 0;
    for material in 0..materials {
        let upto = lights * (material + 1) / materials;
        let triangles: Vec<_> = (next..upto).map(triangle).collect();
        next = upto;
        let strength = 20.0 + material as f64 * 1e-3;
        let look = format!(
            r#""doubleSided":false,"pbrMetallicRoughness":{{"baseColorFactor":[0,0,0,1],"metallicFactor":0,"roughnessFactor":1}},"emissiveFactor":[1,0.75,0.45],"extensions":{{"KHR_materials_emissive_strength":{{"emissiveStrength":{strength}}}}}"#
        );
        add(&triangles, material, &format!("window {material}"), &look).expect("a string takes it");
    }
    let (a, b, c) = ([-600.0, 0.0, 600.0], [600.0, 0.0, 600.0], [0.0, 0.0, -700.0]);
    let grey = r#""pbrMetallicRoughness":{"baseColorFactor":[0.2,0.2,0.2,1],"metallicFactor":0}"#;
    add(&[[a, b, c]], materials, "ground", grey).expect("a string takes it");
    let [nodes, meshes, looks, accessors, views] = &json;
    let roots: Vec<String> = (0..=materials).map(|i| i.to_string()).collect();
    let text = |length: usize| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{nodes}],"meshes":[{meshes}],"materials":[{looks}],"accessors":[{accessors}],"bufferViews":[{views}],"buffers":[{{"byteLength":{length}}}],"extensionsUsed":["KHR_materials_emissive_strength"]}}"#,
            roots.join(",")
        )
    };
    let rest = size - text(size).len() - 28;
    assert!(rest > bin.len(), "{} bytes of JSON leave {rest}", text(size).len());
    bin.resize(rest / 4 * 4, 0);
    glb(text(bin.len()).as_bytes(), &bin)
}

#[test]
fn a_hundred_thousand_lights_in_seventy_thousand_materials_load_in_proportion_and_in_a_gigabyte() {
    let folder = tempfile::tempdir().expect("a folder");
    let [whole, tenth] = [1, 10].map(|part| {
        let path = folder.path().join(format!("windows-{part}.glb"));
        let bytes = file(part);
        assert!((bytes.len() as i64 - (SIZE / part) as i64).abs() < 100, "{} bytes", bytes.len());
        std::fs::write(&path, bytes).expect("written");
        path
    });
    let read = |path: &Path| open(path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let (held, scene) = crate::peak::most(|| read(&whole));
    println!("{:.0} MB at most", held as f64 * 1e-6);
    assert_eq!((scene.lights().len(), scene.surfaces().len()), (LIGHTS, 1));
    assert!(held < 1 << 30, "{held} bytes");
    let ratio = times_as_long(|| drop(read(&whole)), || drop(read(&tenth)));
    assert!(ratio < IN_PROPORTION, "{ratio} times as long for ten times as many");
    if let Some(kept) = std::env::var_os("CITYLIGHTS_LARGE_GLTF") {
        std::fs::copy(&whole, kept).expect("copied");
    }
}
