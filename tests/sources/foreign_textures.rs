//! Promise: what a texture makes of a surface is what is seen: emission as bright and where the texture says, albedo on the
//! mean.
#![cfg(feature = "cli")]

use crate::common::lambert;
use crate::foreign_made::{RADIANCE, coordinates, jpeg, only_note, panel, png, texture, told};
use crate::made::{File, irradiance, irradiance_by, near};
use base64::Engine;
use citylights::base::error::Result;
use citylights::scene::Scene;
use citylights::sources::{Overrides, open};
use glam::Vec3;
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;

/// Places on the ground.
const SPOTS: [Vec3; 3] = [Vec3::ZERO, Vec3::new(2.5, 0.3, 0.0), Vec3::new(-0.4, -3.0, 0.0)];

/// Irradiance of the part of the panel within these bounds of its coordinates, at a radiance of 1.
fn part([u0, u1]: [f32; 2], [v0, v1]: [f32; 2], at: Vec3) -> f64 {
    // x along u, our y against v.
    let corner = |u: f32, v: f32| Vec3::new(2.0 * u - 1.0, 1.0 - 2.0 * v, 4.0);
    let [a, b, c, d] = [corner(u0, v0), corner(u1, v0), corner(u1, v1), corner(u0, v1)];
    lambert([a, b, c], at, Vec3::Z) + lambert([a, c, d], at, Vec3::Z)
}

/// A texture with its mapping for the panel's emission.
fn emits(texture: Value) -> impl FnOnce(&mut File, usize) {
    move |file, material| file.json["materials"][material]["emissiveTexture"] = texture
}

/// The panel shines with the radiance of each of these parts of its coordinates.
fn shines(scene: &Scene, parts: &[([f32; 2], [f32; 2], f64)], tolerance: f64) {
    for at in SPOTS {
        let wanted: f64 = parts.iter().map(|(u, v, level)| level * RADIANCE * part(*u, *v, at)).sum();
        near(irradiance_by(scene, at, Vec3::Z, 400), wanted, tolerance);
    }
}

const WHOLE: [f32; 2] = [0.0, 1.0];
const LOW: [f32; 2] = [0.0, 0.5];
const HIGH: [f32; 2] = [0.5, 1.0];

/// What an sRGB code stands for (IEC 61966-2-1).
fn linear(code: u8) -> f64 {
    let x = f64::from(code) / 255.0;
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

#[test]
fn a_white_texel_is_the_factor_alone_whether_or_not_there_are_coordinates() {
    let plain = panel(|_, _| ()).scene();
    for without in [false, true] {
        let mut file = panel(|file, material| {
            let data = base64::engine::general_purpose::STANDARD.encode(png(1, &[255]));
            let image = file.push("images", json!({ "uri": format!("data:image/png;base64,{data}") }));
            let texture = file.push("textures", json!({ "source": image }));
            emits(json!({ "index": texture }))(file, material);
        });
        if without {
            let attributes = &mut file.json["meshes"][1]["primitives"][0]["attributes"];
            attributes.as_object_mut().expect("an object").remove("TEXCOORD_0");
        }
        let scene = file.scene();
        assert_eq!(scene.lights().len(), 2, "nothing to cut");
        assert!(scene.lights().iter().zip(plain.lights()).all(|(a, b)| a.shape() == b.shape()));
        let said = told(&scene).join("\n");
        assert!(said.contains("emissive textures: their triangles shine in 2 pieces"), "{said}");
        assert_eq!(
            said.contains("primitives without the texture coordinates that their material asks for: 1"),
            without
        );
    }
}

#[test]
fn texels_shine_where_they_lie() {
    // The left half dark, the right half bright above and less so below.
    let file = panel(|file, material| {
        let texture = texture(file, &png(2, &[0, 255, 0, 128]), "image/png");
        emits(json!({ "index": texture }))(file, material);
    });
    let scene = file.scene();
    shines(&scene, &[(HIGH, LOW, 1.0), (HIGH, HIGH, linear(128))], 5e-3);
    only_note(&scene, "emissive textures: their triangles shine in ");
    assert!(told(&scene)[0].contains("(0.00 % of the light)"), "what is dark is black");
    // The dark half is a surface, black here, of half the panel's area.
    let dark = scene.surfaces()[2..].iter().map(|s| (s.corners[1] - s.corners[0]).cross(s.corners[2] - s.corners[0]));
    near(dark.map(|normal| f64::from(normal.length()) / 2.0).sum(), 2.0, 1e-6);
}

#[test]
fn a_picture_finer_than_the_pieces_keeps_its_light() {
    // 300 x 200 texels, no power of two: a bright disc, a ramp, noise; over 2 triangles.
    let texels: Vec<u8> = (0..200)
        .flat_map(|y| (0..300).map(move |x| (x, y)))
        .map(|(x, y): (i32, i32)| match (x - 80).pow(2) + (y - 90).pow(2) {
            0..1600 => 255,
            _ if x > 200 => (x - 100) as u8,
            _ => (x * 7919 + y * 104_729) as u8 % 64,
        })
        .collect();
    let file = panel(|file, material| {
        let texture = texture(file, &png(300, &texels), "image/png");
        emits(json!({ "index": texture }))(file, material);
    });
    let scene = file.scene();
    assert!((100..=2048).contains(&scene.lights().len()), "{} pieces", scene.lights().len());
    // Each texel as an emitter of its own at its middle.
    let size = 4.0 / (300.0 * 200.0);
    for at in SPOTS {
        let wanted: f64 = texels
            .iter()
            .enumerate()
            .map(|(i, &code)| {
                let (u, v) = ((i % 300) as f64 / 300.0 + 0.5 / 300.0, (i / 300) as f64 / 200.0 + 0.5 / 200.0);
                let away = glam::DVec3::new(2.0 * u - 1.0, 1.0 - 2.0 * v, 4.0) - at.as_dvec3();
                RADIANCE * linear(code) * size * away.z.powi(2) / away.length_squared().powi(2)
            })
            .sum();
        near(irradiance_by(&scene, at, Vec3::Z, 64), wanted, 5e-3);
    }
}

#[test]
fn jpeg_and_files_beside_are_read() {
    let row = [[255u8; 8], [96; 8]].concat();
    let texels = row.repeat(16);
    let within = panel(|file, material| {
        let texture = texture(file, &jpeg(16, &texels), "image/jpeg");
        emits(json!({ "index": texture }))(file, material);
    });
    let wanted = [(LOW, WHOLE, 1.0), (HIGH, WHOLE, linear(96))];
    shines(&within.scene(), &wanted, 1e-2);
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("text ures")).expect("made");
    std::fs::write(folder.path().join("text ures/a.jpg"), jpeg(16, &texels)).expect("written");
    std::fs::write(folder.path().join("b.png"), png(16, &texels)).expect("written");
    for uri in ["text%20ures/a.jpg", "./b.png"] {
        let file = panel(|file, material| {
            let image = file.push("images", json!({ "uri": uri }));
            let texture = file.push("textures", json!({ "source": image }));
            emits(json!({ "index": texture }))(file, material);
        });
        let path = folder.path().join("panel.glb");
        std::fs::write(&path, file.glb()).expect("written");
        shines(&open(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}")), &wanted, 1e-2);
    }
}

/// The panel with the four levels 255, 188, 128 and 0 from the upper left along the rows, mapped somehow.
fn mapped(info: Value, sampler: Option<Value>, change: impl FnOnce(&mut File)) -> Scene {
    let mut file = panel(|file, material| {
        let texture = texture(file, &png(2, &[255, 188, 128, 0]), "image/png");
        if let Some(sampler) = sampler {
            let sampler = file.push("samplers", sampler);
            file.json["textures"][texture]["sampler"] = json!(sampler);
        }
        let mut info = info;
        info["index"] = json!(texture);
        emits(info)(file, material);
    });
    change(&mut file);
    file.scene()
}

#[test]
fn texture_transforms_place_the_image() {
    let transform = |transform: Value| {
        mapped(json!({ "extensions": { "KHR_texture_transform": transform } }), None, |file| {
            file.json["extensionsRequired"] = json!(["KHR_texture_transform"]);
        })
    };
    // The extension's own examples: the lower left quarter, turned, is all of one level here; then upside down.
    let quarter = transform(json!({ "offset": [0, 1], "rotation": FRAC_PI_2, "scale": [0.5, 0.5] }));
    shines(&quarter, &[(WHOLE, WHOLE, linear(128))], 5e-3);
    let turned = transform(json!({ "offset": [0, 1], "scale": [1, -1] }));
    shines(&turned, &[(LOW, LOW, linear(128)), (LOW, HIGH, 1.0), (HIGH, HIGH, linear(188))], 5e-3);
    // A quarter turn: (u, v) goes to (v, 1 - u).
    let turned = transform(json!({ "offset": [0, 1], "rotation": FRAC_PI_2 }));
    shines(&turned, &[(LOW, LOW, linear(128)), (HIGH, LOW, 1.0), (HIGH, HIGH, linear(188))], 5e-3);
    // Another set of coordinates, the right half, by the texture or by its transform.
    for info in [
        json!({ "texCoord": 1 }),
        json!({ "texCoord": 0, "extensions": { "KHR_texture_transform": { "texCoord": 1 } } }),
    ] {
        let scene = mapped(info, None, |file| {
            let right = coordinates(file, [[0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0]]);
            file.json["meshes"][1]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(right);
        });
        shines(&scene, &[(WHOLE, LOW, linear(188))], 5e-3);
    }
    // Coordinates of bytes.
    let scene = mapped(json!({}), None, |file| {
        let quarter = file.accessor(&[0, 0, 128, 0, 128, 128, 0, 128], 5121, 4, "VEC2");
        file.json["accessors"][quarter]["normalized"] = json!(true);
        file.json["meshes"][1]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(quarter);
    });
    shines(&scene, &[(WHOLE, WHOLE, 1.0)], 2e-2);
}

#[test]
fn textures_wrap_as_their_samplers_say() {
    // Coordinates from 1 to 2 along u, from -1 to 0 along v: the image next to the first, above it.
    let beside = json!({ "extensions": { "KHR_texture_transform": { "offset": [1, -1] } } });
    let [a, b, c] = [1.0, linear(188), linear(128)];
    for (wraps, parts) in [
        ([None, Some(10497)], vec![(LOW, LOW, a), (HIGH, LOW, b), (LOW, HIGH, c)]),
        ([Some(33648), None], vec![(LOW, LOW, b), (HIGH, LOW, a), (HIGH, HIGH, c)]),
        ([None, Some(33648)], vec![(LOW, LOW, c), (LOW, HIGH, a), (HIGH, HIGH, b)]),
        ([Some(33648), Some(33648)], vec![(HIGH, LOW, c), (LOW, HIGH, b), (HIGH, HIGH, a)]),
        ([Some(33071), None], vec![(WHOLE, LOW, b)]),
        ([None, Some(33071)], vec![(LOW, WHOLE, a), (HIGH, WHOLE, b)]),
        ([Some(33071), Some(33071)], vec![(WHOLE, WHOLE, b)]),
    ] {
        let mut sampler = json!({});
        for (name, wrap) in ["wrapS", "wrapT"].into_iter().zip(wraps) {
            if let Some(wrap) = wrap {
                sampler[name] = json!(wrap);
            }
        }
        shines(&mapped(beside.clone(), Some(sampler), |_| ()), &parts, 5e-3);
    }
    // A thousand images on the panel shine with their mean.
    let many = json!({ "extensions": { "KHR_texture_transform": { "scale": [1000, 1000] } } });
    shines(&mapped(many, None, |_| ()), &[(WHOLE, WHOLE, (a + b + c) / 4.0)], 1e-3);
    // All corners in one texel of a palette.
    let point = json!({ "extensions": { "KHR_texture_transform": { "scale": [0, 0], "offset": [0.75, 0.25] } } });
    let scene = mapped(point, None, |_| ());
    assert_eq!(scene.lights().len(), 2);
    shines(&scene, &[(WHOLE, WHOLE, b)], 5e-3);
}

#[test]
fn base_colour_textures_are_their_means_over_each_primitive() {
    let mut file = File::ground();
    let texture = texture(&mut file, &png(2, &[255, 188, 128, 0]), "image/png");
    let corners = [[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
    let look = json!({
        "name": "poster",
        "pbrMetallicRoughness": { "baseColorTexture": { "index": texture }, "baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0 },
    });
    let material = file.push("materials", look);
    let position = file.positions(&corners);
    let indices = file.indices(5121, &[0, 1, 2, 0, 2, 3]);
    let mut primitive = |low: f32, high: f32| {
        let coordinates = coordinates(&mut file, [[low, 0.0], [high, 0.0], [high, 0.5], [low, 0.5]]);
        json!({
            "attributes": { "POSITION": position, "TEXCOORD_0": coordinates }, "indices": indices, "material": material,
        })
    };
    let primitives = json!([primitive(0.0, 1.0), primitive(0.5, 1.0)]);
    let mesh = file.push("meshes", json!({ "primitives": primitives }));
    file.node(json!({ "mesh": mesh }));
    file.lamp(json!({ "type": "point", "intensity": 70 }), json!({ "translation": [5, 2, 0] }));
    let scene = file.scene();
    let albedos: Vec<Vec3> =
        [2, 4].map(|i| scene.materials()[scene.surfaces()[i].material as usize].albedo).into_iter().collect();
    for (found, mean) in albedos.into_iter().zip([(1.0 + linear(188)) / 2.0, linear(188)]) {
        let wanted = mean as f32 * Vec3::new(1.0, 0.5, 0.25);
        assert!((found - wanted).abs().max_element() < 1e-4, "{found} for {wanted}");
    }
    near(irradiance(&scene, Vec3::X * 5.0, Vec3::Z), 70.0 / 4.0, 1e-6);
    only_note(&scene, "base colour textures of materials: 1; their mean over each primitive");
    // One that cannot be read decides nothing.
    file.json["images"][0] = json!({ "uri": "nowhere.png" });
    assert_eq!(file.scene().materials()[1].albedo, Vec3::new(1.0, 0.5, 0.25));
    only_note(
        &file.scene(),
        "base colour textures of materials that cannot be read: 1; the factor alone is the albedo",
    );
}

/// What is said of a panel whose image is this.
fn refused(image: Value, bytes: &[u8]) -> String {
    let file = panel(|file, material| {
        let mut image = image;
        if image == json!({}) {
            image["bufferView"] = json!(file.view(bytes));
        }
        let image = file.push("images", image);
        let texture = file.push("textures", json!({ "source": image }));
        emits(json!({ "index": texture }))(file, material);
    });
    let result: Result<Scene> = file.read();
    result.expect_err("refused").to_string()
}

#[test]
fn emission_that_cannot_be_read_is_refused_with_a_way_round() {
    for (image, bytes, said) in [
        (json!({ "uri": "nowhere.png" }), &b""[..], "`images[0].uri`: there is no file nowhere.png"),
        (json!({ "uri": "../a.png" }), b"", "the name of a file in the scene's folder is asked for"),
        (json!({ "uri": "http://example.org/a.png" }), b"", "the name of a file in the scene's folder is asked for"),
        (
            json!({}),
            b"\xabKTX 20\xbb\r\n\x1a\n",
            "PNG and JPEG are read here; `gltf-transform png`, or `ktxdecompress`, makes PNG",
        ),
        (
            json!({}),
            b"RIFF\x10\0\0\0WEBPVP8 ",
            "PNG and JPEG are read here; `gltf-transform png`, or `ktxdecompress`, makes PNG",
        ),
        (json!({}), &png(1, &[255])[..40], "this picture cannot be read"),
        (json!({}), &jpeg(16, &[200; 256])[..200], "this picture cannot be read"),
    ] {
        let error = refused(image, bytes);
        assert!(error.contains(said), "{error}\nlacks: {said}");
    }
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_not_followed() {
    let outside = tempfile::tempdir().expect("a folder");
    std::fs::write(outside.path().join("secret.png"), png(1, &[255])).expect("written");
    let folder = tempfile::tempdir().expect("a folder");
    std::os::unix::fs::symlink(outside.path().join("secret.png"), folder.path().join("a.png")).expect("linked");
    std::os::unix::fs::symlink(outside.path(), folder.path().join("b")).expect("linked");
    for uri in ["a.png", "b/secret.png"] {
        let file = panel(|file, material| {
            let image = file.push("images", json!({ "uri": uri }));
            let texture = file.push("textures", json!({ "source": image }));
            emits(json!({ "index": texture }))(file, material);
        });
        let path = folder.path().join("panel.glb");
        std::fs::write(&path, file.glb()).expect("written");
        let error = open(&path, &Overrides::default()).expect_err("refused").to_string();
        assert!(error.contains("a link out of the scene's folder; copy the file there"), "{error}");
    }
}

#[test]
fn a_small_file_does_not_unfold_into_gigabytes() {
    // 20,000 x 20,000 grey texels of one colour in 400 kB: the head of the file says so.
    let mut bomb = png(1, &[0]);
    bomb[16..24].copy_from_slice(&[0, 0, 0x4e, 0x20, 0, 0, 0x4e, 0x20]);
    let sum = crc(&bomb[12..29]);
    bomb[29..33].copy_from_slice(&sum.to_be_bytes());
    bomb.resize(65_000, 0);
    let (held, error) = crate::peak::most(|| refused(json!({}), &bomb));
    assert!(
        error.contains("20000 x 20000 texels in 65000 bytes are given") && error.contains("scale it down"),
        "{error}"
    );
    assert!(held < 64 << 20, "{held} bytes");
    // Honest black at 400 texels a byte and more is read.
    let black = png(2048, &vec![0; 2048 * 2048]);
    let file = panel(|file, material| {
        let texture = texture(file, &black, "image/png");
        emits(json!({ "index": texture }))(file, material);
        file.lamp(json!({ "type": "point", "intensity": 70 }), json!({ "translation": [0, 2, 0] }));
    });
    let (held, scene) = crate::peak::most(|| file.scene());
    println!("{} bytes of PNG, {held} bytes held", black.len());
    assert_eq!((scene.lights().len(), scene.surfaces().len()), (1, 4));
    assert!(held < 128 << 20, "{held} bytes");
    // And again and again: each image decoded for itself, as far as a file of this size may.
    let many = |count: usize| {
        let mut file = file.clone();
        for _ in 1..count {
            let image = file.json["images"][0].clone();
            let image = file.push("images", image);
            let texture = file.push("textures", json!({ "source": image }));
            let mut material = file.json["materials"][1].clone();
            material["emissiveTexture"]["index"] = json!(texture);
            let mut primitive = file.json["meshes"][1]["primitives"][0].clone();
            primitive["material"] = json!(file.push("materials", material));
            let mesh = file.mesh(primitive);
            file.node(json!({ "mesh": mesh }));
        }
        file
    };
    let (held, scene) = crate::peak::most(|| many(10).scene());
    assert_eq!(scene.surfaces().len(), 2 + 10 * 2);
    assert!(held < 256 << 20, "{held} bytes");
    let (held, error) = crate::peak::most(|| many(30).read().expect_err("refused").to_string());
    assert!(error.contains("scale it down") || error.contains("scale them down"), "{error}");
    assert!(held < 256 << 20, "{held} bytes");
}

/// PNG's check of a chunk (ISO 3309).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 })
    })
}
