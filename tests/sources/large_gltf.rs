//! Promise: a glTF file of a hundred thousand lights in seventy thousand materials is read in seconds and a gigabyte.
#![cfg(feature = "cli")]

use crate::made::glb;
use citylights::measure::clock::{Clock, Cpu};
use citylights::sources::{Overrides, open};
use std::fmt::Write;

const LIGHTS: usize = 100_000;
const MATERIALS: usize = 70_000;
/// As in the crowded exports that other tools have been given.
const SIZE: usize = 42_000_000;

/// Triangles in rows 3 m apart, as exporters write them: of each material a mesh with a node, an accessor and a view of
/// its own; then a ground, which the rest of the bytes are normals of.
fn file() -> Vec<u8> {
    let mut bin: Vec<u8> = Vec::new();
    let mut json = [const { String::new() }; 5];
    let mut part = |triangles: &[[[f32; 3]; 3]], material: usize, name: &str, look: &str| {
        let at = bin.len();
        bin.extend(triangles.as_flattened().as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        let (length, count) = (bin.len() - at, triangles.len() * 3);
        let comma = if material == 0 { "" } else { "," };
        let [nodes, meshes, materials, accessors, views] = &mut json;
        write!(nodes, r#"{comma}{{"name":"{name}","mesh":{material}}}"#)?;
        write!(
            meshes,
            r#"{comma}{{"name":"{name}","primitives":[{{"attributes":{{"POSITION":{material}}},"material":{material},"mode":4}}]}}"#
        )?;
        write!(materials, r#"{comma}{{"name":"material {material}",{look}}}"#)?;
        write!(accessors, r#"{comma}{{"bufferView":{material},"componentType":5126,"count":{count},"type":"VEC3"}}"#)?;
        write!(views, r#"{comma}{{"buffer":0,"byteOffset":{at},"byteLength":{length},"byteStride":12,"target":34962}}"#)
    };
    let triangle = |i: usize| {
        let (x, z) = ((i % 300) as f32 * 3.0 - 450.0, (i / 300) as f32 * 3.0 - 500.0);
        [[x, 5.0, z], [x, 6.0, z], [x + 1.0, 5.0, z]]
    };
    let mut next = 0;
    for material in 0..MATERIALS {
        let upto = LIGHTS * (material + 1) / MATERIALS;
        let triangles: Vec<_> = (next..upto).map(triangle).collect();
        next = upto;
        let strength = 20.0 + material as f64 * 1e-3;
        let look = format!(
            r#""doubleSided":false,"pbrMetallicRoughness":{{"baseColorFactor":[0,0,0,1],"metallicFactor":0,"roughnessFactor":1}},"emissiveFactor":[1,0.75,0.45],"extensions":{{"KHR_materials_emissive_strength":{{"emissiveStrength":{strength}}}}}"#
        );
        part(&triangles, material, &format!("window {material}"), &look).expect("a string takes it");
    }
    let (a, b, c) = ([-600.0, 0.0, 600.0], [600.0, 0.0, 600.0], [0.0, 0.0, -700.0]);
    let grey = r#""pbrMetallicRoughness":{"baseColorFactor":[0.2,0.2,0.2,1],"metallicFactor":0}"#;
    part(&[[a, b, c]], MATERIALS, "ground", grey).expect("a string takes it");
    let [nodes, meshes, materials, accessors, views] = &json;
    let roots: Vec<String> = (0..=MATERIALS).map(|i| i.to_string()).collect();
    let text = |length: usize| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{nodes}],"meshes":[{meshes}],"materials":[{materials}],"accessors":[{accessors}],"bufferViews":[{views}],"buffers":[{{"byteLength":{length}}}],"extensionsUsed":["KHR_materials_emissive_strength"]}}"#,
            roots.join(",")
        )
    };
    let rest = SIZE - text(SIZE).len() - 28;
    assert!(rest > bin.len(), "{} bytes of JSON leave {rest}", text(SIZE).len());
    bin.resize(rest / 4 * 4, 0);
    glb(text(bin.len()).as_bytes(), &bin)
}

#[test]
fn a_hundred_thousand_lights_in_seventy_thousand_materials_load_in_two_seconds_and_a_gigabyte() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("windows.glb");
    let bytes = file();
    assert!((bytes.len() as i64 - SIZE as i64).abs() < 100, "{} bytes", bytes.len());
    std::fs::write(&path, bytes).expect("written");
    let clock = Cpu::new();
    let begun = clock.process_s();
    let (held, scene) = crate::peak::most(|| open(&path, &Overrides::default()));
    let spent = clock.process_s() - begun;
    let scene = scene.unwrap_or_else(|error| panic!("{error}"));
    println!("{spent:.2} s of CPU, {:.0} MB at most", held as f64 * 1e-6);
    assert_eq!((scene.lights().len(), scene.surfaces().len()), (LIGHTS, 1));
    assert!(spent < 2.0 && held < 1 << 30, "{spent} s, {held} bytes");
    if let Some(kept) = std::env::var_os("CITYLIGHTS_LARGE_GLTF") {
        std::fs::copy(&path, kept).expect("copied");
    }
}
