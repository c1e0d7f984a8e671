//! Promise: whatever bytes stand in a scene file or a picture, it is read or refused: no panic, no hang, no memory out of proportion.
//!
//! Whole files are broken in many ways: bytes flipped, cut out, doubled and swapped, numbers replaced, values of the JSON
//! exchanged. `CITYLIGHTS_MUTATIONS` is how many of each format are tried; `cargo test` tries few.
#![cfg(feature = "cli")]

use crate::broken::{NUMBERS, below, broken};
use crate::foreign_made::{coordinates, jpeg, panel, png, texture};
use crate::made::{File, glb};
use citylights::base::error::{Error, Result};
use citylights::base::random::Stream;
use citylights::image::{self, Picture};
use citylights::sources::{Overrides, gltf, recipe};
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Most bytes while reading a mutant of a scene, of a few kilobytes.
const MOST_BYTES: usize = 64 << 20;
/// And of a picture: 2^23 pixels of 12 bytes, which a small file may have, and half as much again.
const MOST_OF_A_PICTURE: usize = (12 << 23) * 3 / 2;
/// How many times as long as the whole file a mutant may take, generous to a machine that does other things.
const LONGEST: u32 = 10_000;

/// How many mutants of each format.
fn wanted() -> u64 {
    std::env::var("CITYLIGHTS_MUTATIONS").map_or(3_000, |text| text.parse().expect("a number of mutants"))
}

/// Every value below a JSON value, as pointers.
fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match value {
        Value::Array(list) => list.iter().enumerate().for_each(|(i, v)| pointers(v, &format!("{at}/{i}"), found)),
        Value::Object(map) => map.iter().for_each(|(name, v)| pointers(v, &format!("{at}/{name}"), found)),
        _ => {}
    }
}

/// Exchanges one to three values of a document.
fn exchanged(stream: &mut Stream, mut json: Value) -> Value {
    for _ in 0..=below(stream, 3) {
        let mut all = Vec::new();
        pointers(&json, "", &mut all);
        let other = json.pointer(&all[below(stream, all.len())]).cloned().expect("a value");
        let target = json.pointer_mut(&all[below(stream, all.len())]).expect("a value");
        *target = match below(stream, 8) {
            0 => other,
            1 => Value::Null,
            2 => json!([]),
            3 => json!({}),
            4 => json!("\u{1b}[2Jtext"),
            5 if target.is_array() => {
                let list = target.as_array().expect("a list");
                json!(list.iter().chain(list).collect::<Vec<_>>())
            }
            _ => serde_json::from_str(NUMBERS[below(stream, NUMBERS.len())]).unwrap_or(json!(-3)),
        };
    }
    json
}

/// A glTF file with some of everything that is read.
fn scene() -> File {
    let mut file = File::ground();
    file.emitter([[0.0, 3.0, 0.0], [0.0, 3.0, -1.0], [1.0, 3.0, 0.0]], 40.0, true, json!({ "scale": [-1, 1, 2] }));
    let (positions, indices) =
        (file.positions(&[[0.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 1.0, 1.0]]), file.indices(5121, &[0, 1, 2]));
    let strip = json!({ "attributes": { "POSITION": positions }, "indices": indices, "mode": 5 });
    let mesh = file.mesh(strip);
    let child = file.push("nodes", json!({ "mesh": mesh, "name": "child", "translation": [1, 2, 3] }));
    let point = json!({ "type": "point", "intensity": 90, "color": [1, 0.5, 0] });
    file.lamp(point, json!({ "name": "lamp 1", "translation": [1, 4, 2], "children": [child] }));
    let spot = json!({ "type": "spot", "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.6 }, "range": 10 });
    file.lamp(spot, json!({ "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1] }));
    file.lamp(json!({ "type": "directional" }), json!({ "rotation": [0.6, 0, 0, 0.8] }));
    file.json["scenes"][0]["extras"] = json!({ "ev100": 3 });
    file.json["cameras"][0]["extras"] = json!({ "resolution": [16, 9] });
    file
}

/// A glTF file with textures, instances, quantized and sparse positions, and morph targets.
fn foreign() -> File {
    let mut file = panel(|file, material| {
        let emissive = texture(file, &png(4, &[255, 0, 9, 188, 128, 64, 3, 200]), "image/png");
        let sampler = file.push("samplers", json!({ "wrapS": 33648, "wrapT": 33071 }));
        file.json["textures"][emissive]["sampler"] = json!(sampler);
        let transform = json!({ "offset": [0.1, 0.2], "rotation": 0.3, "scale": [1.5, 2] });
        file.json["materials"][material]["emissiveTexture"] =
            json!({ "index": emissive, "extensions": { "KHR_texture_transform": transform } });
        let base = texture(file, &jpeg(8, &[90; 64]), "image/jpeg");
        file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": base, "texCoord": 1 });
        let set = coordinates(file, [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]]);
        file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(set);
    });
    let moved = file.view(&[0, 0, 128, 63, 0, 0, 128, 64, 0, 0, 0, 0]);
    let which = file.view(&[2]);
    let sparse = json!({
        "count": 1, "indices": { "bufferView": which, "componentType": 5121 }, "values": { "bufferView": moved },
    });
    let target = file.push("accessors", json!({ "componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse }));
    file.json["meshes"][1]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    file.json["meshes"][1]["weights"] = json!([0.25]);
    let corners = file.accessor(&[0, 0, 0, 0, 127, 0, 0, 0, 0, 0, 129, 0], 5120, 3, "VEC3");
    let view = file.json["accessors"][corners]["bufferView"].as_u64().expect("a number") as usize;
    file.json["bufferViews"][view]["byteStride"] = json!(4);
    file.json["accessors"][corners]["normalized"] = json!(true);
    let mesh = file.mesh(json!({ "attributes": { "POSITION": corners } }));
    let places = file.positions(&[[-3.0, 1.0, 0.0], [0.0, 1.0, 3.0], [3.0, 1.0, 2.0]]);
    let turns = file.accessor(&[0, 0, 0, 127, 0, 90, 0, 90, 0, 0, 90, 90], 5120, 3, "VEC4");
    file.json["accessors"][turns]["normalized"] = json!(true);
    let instancing = json!({ "attributes": { "TRANSLATION": places, "ROTATION": turns, "SCALE": places } });
    let lamp = json!({ "light": file.light(json!({ "type": "point", "intensity": 90 })) });
    let child = file.push("nodes", json!({ "extensions": { "KHR_lights_punctual": lamp } }));
    file.node(json!({ "mesh": mesh, "children": [child], "extensions": { "EXT_mesh_gpu_instancing": instancing } }));
    file
}

/// A recipe with some of everything that is placed by hand.
const RECIPE: &str = r#"name = "corner"
seed = 5
version = 1
ev100 = 4
origin = [100, 2e3, 0]
camera = { position = [1, -60, 2], target = [0, 40, 8], fov = 50, resolution = [32, 18] }
ground = { size = [900, 800], height = -0.25, centre = [1, 2], material = "lawn" }
[materials.lawn]
albedo = [0.05, 0.1, 0.04]
street = true
[[box]]
low = [-2, 300, 0]
high = [2, 304, 3]
material = "brick"
[[quad]]
corners = [[0, 310, 0], [4, 310, 0], [4, 310, 4], [0, 310, 4]]
material = "plaster"
[[triangle]]
corners = [[0, 320, 0], [4, 320, 0], [4, 320, 4]]
material = "lawn"
[[light]]
kind = "point"
position = [0, 0, 6]
intensity = 100
colour = [1, 0.5, 0.25]
[[light]]
kind = "spot"
position = [0, 0, 6]
target = [1, 2, 0]
inner = 10
outer = 40
flux = 900
kelvin = 3000
[[light]]
kind = "directional"
towards = [0, 1, 2]
irradiance = 0.25
[[light]]
kind = "triangle"
corners = [[0, 310, 0], [4, 310, 0], [4, 310, 4]]
radiance = 30
[[bulbs]]
size = [20, 20]
centre = [0, 340]
"#;

/// A recipe of a city with every part; its number of lights is set from outside, so that no mutant asks for a million.
const CITY: &str = r#"name = "city"
version = 1
camera = { position = [1, -60, 2], target = [0, 40, 8] }
[city]
lights = 700
density = 10600
squares = 0.2
street = [14, 20]
block = [80, 120]
pavement = 3.5
[city.buildings]
height = 20
spread = 0.5
lot = 28
gaps = 0.1
tallest = 100
[city.lamps]
spacing = 25
kind = "spot"
[city.windows]
radiance = [5, 50]
[city.shops]
[city.signs]
[city.traffic]
[city.beacons]
[city.floodlights]
[city.bulbs]
[city.moon]
"#;

/// Reads `wanted` mutants of a whole file, each named by its number; how many were read and how many refused.
fn run<T>(
    format: &str,
    most: usize,
    whole: &[u8],
    mutant: impl Fn(&mut Stream) -> Vec<u8>,
    read: impl Fn(&[u8]) -> Result<T> + Sync,
) {
    let (mut read_in, mut refused, begun) = (0, 0, Instant::now());
    // Memory is watched on one thread: nothing is done on another.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let (mut most_bytes, mut longest) = (0, Duration::ZERO);
    let timed = || {
        let start = Instant::now();
        pool.install(|| read(whole).map(drop)).unwrap_or_else(|error| panic!("{error}"));
        start.elapsed()
    };
    let limit = LONGEST * timed().min(timed());
    assert!(crate::peak::most(|| drop(vec![1u8; most])).0 >= most, "the watch on memory is asleep");
    for number in 0..wanted() {
        let bytes = mutant(&mut Stream::keyed(&[1, number]));
        let start = Instant::now();
        let (held, result) =
            pool.install(|| crate::peak::most(|| catch_unwind(AssertUnwindSafe(|| read(&bytes).map(drop)))));
        let took = start.elapsed();
        let text = String::from_utf8_lossy(&bytes);
        match result {
            Ok(Ok(())) => read_in += 1,
            Ok(Err(error)) => {
                assert!(matches!(error, Error::Input { .. }), "{format} mutant {number}: {error:?}\n{text}");
                let message = error.to_string();
                assert!(!message.contains(char::is_control), "{format} mutant {number}: {message:?}");
                assert!(message.len() < 1_000, "{format} mutant {number}: {message}");
                refused += 1;
            }
            Err(_) => panic!("{format} mutant {number} panics\n{text}"),
        }
        assert!(held < most && took < limit, "{format} mutant {number}: {held} bytes, {took:?}\n{text}");
        (most_bytes, longest) = (held.max(most_bytes), took.max(longest));
    }
    println!(
        "{format}: {read_in} read, {refused} refused, at most {most_bytes} bytes and {longest:?} each, {:?} in all",
        begun.elapsed()
    );
    assert!(read_in > 0 && refused > 0, "{format}: {read_in} read, {refused} refused");
}

#[test]
fn mutated_gltf_files_are_read_or_refused() {
    assert_eq!(scene().scene().lights().len(), 5);
    mutate("glTF", &scene());
}

#[test]
fn mutated_gltf_files_with_textures_and_instances_are_read_or_refused() {
    let lights = foreign().scene().lights().len();
    assert!((100..2_000).contains(&lights), "{lights}");
    mutate("glTF with textures", &foreign());
}

fn mutate(format: &str, file: &File) {
    let whole = file.glb();
    let length = 20 + u32::from_le_bytes([whole[12], whole[13], whole[14], whole[15]]) as usize;
    let json: Value = serde_json::from_slice(&whole[20..length]).expect("JSON");
    let mutant = |stream: &mut Stream| match below(stream, 8) {
        0 => broken(stream, whole.clone()),
        1 => broken(stream, file.embedded().into_bytes()),
        // The container stays whole, so that what is within is read.
        2 => glb(whole[20..length].trim_ascii(), &broken(stream, file.bin.clone())),
        3 | 4 => glb(&broken(stream, whole[20..length].to_vec()), &file.bin),
        _ => glb(exchanged(stream, json.clone()).to_string().as_bytes(), &file.bin),
    };
    // A folder that is not there: no mutant finds a buffer.
    run(format, MOST_BYTES, &whole, mutant, |bytes| {
        gltf::parse(bytes, "nowhere/mutant.gltf".as_ref(), &Overrides::default())
    });
}

#[test]
fn mutated_recipes_are_read_or_refused() {
    let good = recipe::parse(RECIPE, "good.toml".as_ref(), &Overrides::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(good.lights().len(), 4 + 10, "four lights and a square of bulbs");
    run(
        "recipe",
        MOST_BYTES,
        RECIPE.as_bytes(),
        |stream| broken(stream, RECIPE.into()),
        |bytes| recipe::parse(&String::from_utf8_lossy(bytes), "mutant.toml".as_ref(), &Overrides::default()),
    );
}

#[test]
fn mutated_cities_are_read_or_refused() {
    let few = Overrides { lights: Some(120), ..Overrides::default() };
    recipe::parse(CITY, "good.toml".as_ref(), &few).unwrap_or_else(|e| panic!("{e}"));
    run(
        "city",
        MOST_BYTES,
        CITY.as_bytes(),
        |stream| broken(stream, CITY.into()),
        |bytes| recipe::parse(&String::from_utf8_lossy(bytes), "mutant.toml".as_ref(), &few),
    );
}

#[test]
fn mutated_pictures_are_read_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let pixels = (0..24 * 10).map(|i| [i as f32 * 0.01, 1.0, 0.25]).collect();
    let picture = Picture { width: 24, height: 10, pixels };
    for (format, name) in [("EXR", "picture.exr"), ("PNG", "picture.png")] {
        let path = folder.path().join(name);
        image::write(&path, &picture, 1.0).expect("written");
        let whole = std::fs::read(&path).expect("a file");
        run(
            format,
            MOST_OF_A_PICTURE,
            &whole,
            |stream| broken(stream, whole.clone()),
            |bytes| {
                std::fs::write(&path, bytes).expect("written");
                image::read(&path)
            },
        );
    }
}
