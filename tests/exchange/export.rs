//! Promise: an exported scene says what ours says, to the last bit where the format can, in files that are whole.
#![cfg(all(feature = "gltf", feature = "recipe"))]

use crate::promises::common::{ground, sixteen};
use citylights::export::{Renderer, export};
use citylights::scene::camera::Camera;
use citylights::scene::light::{Light, Shape};
use citylights::scene::{Parts, Scene};
use citylights::sources::Overrides;
use citylights::sources::recipe::load;
use glam::{DMat4, DQuat, DVec3, Vec3};
use gltf::khr_lights_punctual::Kind;
use std::collections::HashMap;
use std::path::Path;

/// A shipped scene.
fn shipped(name: &str) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.toml"));
    load(&file, &Overrides::default()).expect("a shipped scene")
}

/// Sixteen lights of all kinds; the camera is rolled, on a film that is higher than wide.
fn rolled() -> Scene {
    let parts = sixteen();
    let camera = Camera::new(Vec3::new(0.3, -18.0, 14.0), Vec3::new(0.0, 1.0, 0.0), 60.0, 30, 40).expect("a camera");
    let camera = camera.turned(camera.position(), DQuat::from_axis_angle(camera.forward(), 0.4));
    Scene::new(Parts { camera, ev100: Some(2.5), ..parts }).expect("a scene")
}

/// The bytes of the main file.
fn bytes(scene: &Scene, target: Renderer, name: &str) -> Vec<u8> {
    export(scene, target, Path::new(name)).expect("an export").files.pop().expect("a file").1
}

fn text(scene: &Scene, target: Renderer, name: &str) -> String {
    String::from_utf8(bytes(scene, target, name)).expect("text")
}

fn bits(v: Vec3) -> [u32; 3] {
    // + 0: a zero has one sign.
    (v + 0.0).to_array().map(f32::to_bits)
}

/// A point of glTF's in our axes.
fn ours([x, y, z]: [f32; 3]) -> Vec3 {
    Vec3::new(x, -z, y)
}

/// What decides a light, exactly: its kind, its colour and its places; for directions and angles see elsewhere.
type Key = (u8, [u32; 3], Vec<[u32; 3]>);

fn key(shape: &Shape) -> Key {
    match *shape {
        Shape::Point { position, intensity } => (0, bits(intensity), vec![bits(position)]),
        Shape::Spot { position, intensity, .. } => (1, bits(intensity), vec![bits(position)]),
        Shape::Directional { irradiance, .. } => (2, bits(irradiance), Vec::new()),
        Shape::Triangle { corners, radiance } => (3, bits(radiance), corners.map(bits).to_vec()),
    }
}

fn sorted<T: Ord>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.into_iter().collect();
    items.sort();
    items
}

fn keys(scene: &Scene) -> Vec<Key> {
    sorted(scene.lights().iter().map(|light| key(&light.shape())))
}

/// Surfaces as their albedo and corners, exactly.
fn surfaces(scene: &Scene) -> Vec<([u32; 3], [[u32; 3]; 3])> {
    let albedo = |material: u32| scene.materials()[material as usize].albedo;
    sorted(scene.surfaces().iter().map(|s| (bits(albedo(s.material)), s.corners.map(bits))))
}

/// Directions through pixels of a camera that stands as its renderer's file says.
fn agrees(camera: &Camera, forward: DVec3, up: DVec3, fov: f64, what: &str) {
    let forward = forward.normalize();
    let right = forward.cross(up).normalize();
    let up = right.cross(forward);
    let (width, height) = camera.resolution();
    let half = (0.5 * fov).to_radians().tan();
    for (x, y) in [(0, 0), (width - 1, 0), (0, height - 1), (width / 2, height / 3)] {
        let across = ((f64::from(x) + 0.5) * 2.0 - f64::from(width)) / f64::from(height);
        let along = 1.0 - (f64::from(y) + 0.5) * 2.0 / f64::from(height);
        let direction = (forward + (right * across + up * along) * half).normalize();
        let off = (direction - camera.direction(x, y)).length();
        assert!(off < 1e-6, "{what}, pixel {x},{y}: off by {off}");
    }
}

/// A glTF scene read by the `gltf` crate: lights, surfaces.
struct Read {
    lights: Vec<Shape>,
    surfaces: Vec<([u32; 3], [[u32; 3]; 3])>,
    groups: HashMap<String, usize>,
}

fn read(file: &[u8]) -> Read {
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(file).expect("valid glTF");
    let blob = blob.or_else(|| match document.buffers().next().expect("a buffer").source() {
        gltf::buffer::Source::Uri(uri) => {
            use base64::Engine;
            let data = uri.strip_prefix("data:application/octet-stream;base64,").expect("an embedded buffer");
            Some(base64::engine::general_purpose::STANDARD.decode(data).expect("base64"))
        }
        gltf::buffer::Source::Bin => None,
    });
    let blob = blob.expect("a buffer");
    let mut read = Read { lights: Vec::new(), surfaces: Vec::new(), groups: HashMap::new() };
    for node in document.default_scene().expect("a scene").nodes() {
        let world = DMat4::from_cols_array_2d(&node.transform().matrix().map(|c| c.map(f64::from)));
        let axis = {
            let d = world.transform_vector3(DVec3::NEG_Z);
            DVec3::new(d.x, -d.z, d.y).as_vec3()
        };
        let before = read.lights.len();
        if let Some(light) = node.light() {
            let colour = Vec3::from_array(light.color()) * light.intensity();
            let position = ours(node.transform().decomposed().0);
            read.lights.push(match light.kind() {
                Kind::Point => Shape::Point { position, intensity: colour },
                Kind::Directional => Shape::Directional { towards: -axis, irradiance: colour },
                Kind::Spot { inner_cone_angle: inner, outer_cone_angle: outer } => {
                    assert!(inner >= 0.0 && inner < outer && f64::from(outer) <= std::f64::consts::FRAC_PI_2);
                    let [cos_inner, cos_outer] = [inner, outer].map(|a| f64::from(a).cos() as f32);
                    Shape::Spot { position, axis, intensity: colour, cos_inner, cos_outer }
                }
            });
        }
        for primitive in node.mesh().into_iter().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()) {
            let material = primitive.material();
            let reader = primitive.reader(|_| Some(&blob));
            let positions: Vec<Vec3> = reader.read_positions().expect("positions").map(ours).collect();
            let normals: Vec<Vec3> = reader.read_normals().expect("normals").map(ours).collect();
            assert!(reader.read_indices().is_none() && positions.len() == normals.len());
            assert_eq!(material.specular().expect("a specular factor").specular_factor(), 0.0);
            let pbr = material.pbr_metallic_roughness();
            assert_eq!([pbr.metallic_factor(), pbr.roughness_factor()], [0.0, 1.0]);
            let [r, g, b, _] = pbr.base_color_factor();
            let radiance = Vec3::from_array(material.emissive_factor()) * material.emissive_strength().unwrap_or(1.0);
            assert_eq!(material.double_sided(), radiance == Vec3::ZERO);
            for (corners, normals) in positions.chunks_exact(3).zip(normals.chunks_exact(3)) {
                let corners = [corners[0], corners[1], corners[2]];
                let front = (corners[1] - corners[0]).as_dvec3().cross((corners[2] - corners[0]).as_dvec3());
                for normal in normals {
                    let cos = front.normalize().dot(normal.as_dvec3());
                    assert!(cos > 0.999_99, "the normal {normal} is {cos} off the winding of {corners:?}");
                }
                if radiance == Vec3::ZERO {
                    read.surfaces.push((bits(Vec3::new(r, g, b)), corners.map(bits)));
                } else {
                    assert_eq!([r, g, b], [0.0; 3], "an emitter reflects");
                    read.lights.push(Shape::Triangle { corners, radiance });
                }
            }
        }
        if let (Some(name), true) = (node.name(), read.lights.len() > before) {
            *read.groups.entry(name.to_owned()).or_default() += read.lights.len() - before;
        }
    }
    read.surfaces.sort();
    read
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let scene = shipped("first-night");
    for (target, name) in [
        (Renderer::Gltf, "a.glb"),
        (Renderer::Gltf, "a.gltf"),
        (Renderer::Pbrt, "a.pbrt"),
        (Renderer::Mitsuba, "a.xml"),
    ] {
        let once = export(&scene, target, Path::new(name)).expect("an export");
        let again = export(&shipped("first-night"), target, Path::new(name)).expect("an export");
        assert!(once.files == again.files && !once.files.is_empty(), "{name}");
    }
}

#[test]
fn gltf_carries_every_bit_of_lights_and_surfaces() {
    for scene in [rolled(), shipped("first-night"), shipped("moonlit"), shipped("extreme/orders-of-magnitude")] {
        for name in ["a.glb", "a.gltf"] {
            let read = read(&bytes(&scene, Renderer::Gltf, name));
            assert_eq!(sorted(read.lights.iter().map(key)), keys(&scene), "{}", scene.name());
            assert_eq!(read.surfaces, surfaces(&scene), "{}", scene.name());
            for group in scene.groups() {
                assert_eq!(read.groups.get(&group.name), Some(&group.range.len()), "{}", group.name);
            }
        }
    }
}

#[test]
fn gltf_lights_that_differ_in_one_number_are_not_one() {
    let point = |colour: [f32; 3]| Shape::Point { position: Vec3::Z, intensity: Vec3::from_array(colour) };
    let spot = |cos_inner: f32, cos_outer: f32| Shape::Spot {
        position: Vec3::Z,
        axis: Vec3::NEG_Z,
        intensity: Vec3::new(4.0, 3.0, 2.0),
        cos_inner,
        cos_outer,
    };
    let lights = vec![
        point([4.0, 3.0, 2.0]),
        point([4.0, 3.5, 2.0]),
        point([3.0, 3.0, 2.0]),
        point([4.0, 3.0, 2.5]),
        point([8.0, 6.0, 4.0]),
        point([4.0, 3.0, 2.0]),
        spot(0.9, 0.5),
        spot(0.8, 0.5),
        spot(0.9, 0.4),
    ];
    let scene = Scene::new(ground(5.0, lights)).expect("a scene");
    let file = bytes(&scene, Renderer::Gltf, "a.glb");
    assert_eq!(sorted(read(&file).lights.iter().map(key)), keys(&scene));
    let document = gltf::Gltf::from_slice(&file).expect("glTF").document;
    assert_eq!(document.lights().expect("lights").count(), 8, "equal lights share an entry, others do not");
}

#[test]
fn gltf_turns_spots_and_moons_to_within_rounding() {
    for scene in [rolled(), shipped("moonlit"), shipped("plaza")] {
        let read = read(&bytes(&scene, Renderer::Gltf, "a.glb"));
        let axes = |lights: &mut dyn Iterator<Item = Shape>| {
            let mut found: Vec<(Key, Vec3, [f32; 2])> = lights
                .filter_map(|shape| match shape {
                    Shape::Spot { axis, cos_inner, cos_outer, .. } => Some((key(&shape), axis, [cos_inner, cos_outer])),
                    Shape::Directional { towards, .. } => Some((key(&shape), towards, [0.0; 2])),
                    _ => None,
                })
                .collect();
            found.sort_by(|a, b| a.0.cmp(&b.0));
            found
        };
        let (there, here) =
            (axes(&mut read.lights.iter().copied()), axes(&mut scene.lights().iter().map(Light::shape)));
        assert!(!here.is_empty() && there.len() == here.len());
        for ((_, axis, cones), (_, want, want_cones)) in there.iter().zip(&here) {
            assert!((*axis - *want).length() < 3e-7, "{axis} for {want}");
            assert!(cones.iter().zip(want_cones).all(|(a, b)| (a - b).abs() < 2e-7), "{cones:?} for {want_cones:?}");
        }
    }
}

#[test]
fn gltf_cones_stay_within_what_the_extension_allows() {
    let spot = |cos_inner, cos_outer| Shape::Spot {
        position: Vec3::Z,
        axis: Vec3::NEG_Z,
        intensity: Vec3::ONE,
        cos_inner,
        cos_outer,
    };
    // The reader above asserts it for each: the widest, those that round to one angle, the narrowest.
    let lights = vec![spot(1.0, 0.0), spot(f32::MIN_POSITIVE, 0.0), spot(1e-9, 5e-10), spot(1.0, 1.0f32.next_down())];
    let scene = Scene::new(ground(5.0, lights)).expect("a scene");
    assert_eq!(read(&bytes(&scene, Renderer::Gltf, "a.glb")).lights.len(), 4);
}

#[test]
fn gltf_says_resolution_exposure_and_streets() {
    let scene = rolled();
    let document = gltf::Gltf::from_slice(&bytes(&scene, Renderer::Gltf, "a.glb")).expect("glTF").document;
    let value = |raw: &gltf::json::Extras| -> serde_json::Value {
        serde_json::from_str(raw.as_ref().expect("extras").get()).expect("JSON")
    };
    let camera = document.cameras().next().expect("a camera");
    assert_eq!(value(camera.extras())["resolution"], serde_json::json!([30, 40]));
    let exported = document.default_scene().expect("a scene");
    assert_eq!(exported.name(), Some(scene.name()));
    assert_eq!(value(exported.extras())["ev100"], 2.5);
    assert_eq!(value(document.materials().next().expect("a material").extras())["street"], true);
    assert!(document.as_json().asset.generator.as_deref().expect("a generator").starts_with("citylights "));

    let plain = Scene::new(Parts { ev100: None, ..scene.parts() }).expect("a scene");
    let document = gltf::Gltf::from_slice(&bytes(&plain, Renderer::Gltf, "a.glb")).expect("glTF").document;
    assert!(document.default_scene().expect("a scene").extras().is_none());
}

#[test]
fn gltf_is_cut_into_meshes_of_a_building_or_so_and_not_too_many() {
    for (name, widest) in [("first-night", 40.0), ("downtown", 72.0), ("metropolis", 272.0)] {
        let file = bytes(&shipped(name), Renderer::Gltf, "a.glb");
        let document = gltf::Gltf::from_slice(&file).expect("glTF").document;
        assert!((100..=2048).contains(&document.meshes().len()), "{name}: {} meshes", document.meshes().len());
        // The ground's triangles reach farther than their cells; windows do not.
        let meshes = document.nodes().filter(|node| node.name() == Some("windows")).filter_map(|node| node.mesh());
        for primitive in meshes.flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()) {
            let bounds = primitive.bounding_box();
            let size = |axis: usize| bounds.max[axis] - bounds.min[axis];
            assert!(size(0) < widest && size(2) < widest, "{name}: {bounds:?}");
        }
    }
}

#[test]
fn cameras_look_through_the_same_pixels_everywhere() {
    for scene in [rolled(), shipped("first-night"), shipped("extreme/a-thousand-kilometres-away")] {
        let camera = scene.camera();
        let (width, height) = camera.resolution();

        let document = gltf::Gltf::from_slice(&bytes(&scene, Renderer::Gltf, "a.glb")).expect("glTF").document;
        let node = document.nodes().find(|node| node.camera().is_some()).expect("a camera");
        let (translation, rotation, _) = node.transform().decomposed();
        assert_eq!(bits(ours(translation)), bits(camera.position()));
        let turn = DQuat::from_array(rotation.map(f64::from));
        let axis = |v: DVec3| {
            let d = turn * v;
            DVec3::new(d.x, -d.z, d.y)
        };
        let lens = node.camera().expect("a camera");
        let gltf::camera::Projection::Perspective(lens) = lens.projection() else { panic!("no perspective") };
        let fov = f64::from(lens.yfov()).to_degrees();
        agrees(camera, axis(DVec3::NEG_Z), axis(DVec3::Y), fov, "glTF");
        assert!((lens.aspect_ratio().expect("an aspect") - width as f32 / height as f32).abs() < 1e-6);

        let xml = text(&scene, Renderer::Mitsuba, "a.xml");
        let sensor = between(&xml, "<sensor", "</sensor>");
        let look = |name: &str| numbers(between(sensor, &format!("{name}=\""), "\""));
        let (from, to, up) = (look("origin"), look("target"), look("up"));
        assert_eq!(bits(from.as_vec3()), bits(camera.position()));
        assert!(sensor.contains("name=\"fov_axis\" value=\"y\""));
        let fov: f64 = between(sensor, "name=\"fov\" value=\"", "\"").parse().expect("an angle");
        agrees(camera, to - from, up, fov, "Mitsuba");
        for (name, size) in [("width", width), ("height", height)] {
            assert!(sensor.contains(&format!("<integer name=\"{name}\" value=\"{size}\"/>")));
        }
        let far: f32 = between(sensor, "name=\"far_clip\" value=\"", "\"").parse().expect("a distance");
        assert!(scene.surfaces().iter().all(|s| s.corners.iter().all(|c| c.distance(camera.position()) < far)));

        let file = pbrt::parse(&text(&scene, Renderer::Pbrt, "a.pbrt"));
        let [from, to, up] = file.look_at;
        assert_eq!(bits(from.as_vec3()), bits(camera.position()));
        assert_eq!(file.scale, DVec3::new(-1.0, 1.0, 1.0), "pbrt's camera is left-handed");
        let shorter = (0.5 * file.camera.number("fov")).to_radians().tan();
        let vertical = if width < height { shorter * f64::from(height) / f64::from(width) } else { shorter };
        agrees(camera, to - from, up, 2.0 * vertical.atan().to_degrees(), "pbrt");
        assert_eq!(file.film.number("xresolution"), f64::from(width));
        assert_eq!(file.film.number("yresolution"), f64::from(height));
    }
}

/// What stands in `text` between two marks, the first of each.
fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let rest = &text[text.find(start).unwrap_or_else(|| panic!("no {start}")) + start.len()..];
    &rest[..rest.find(end).unwrap_or_else(|| panic!("no {end} after {start}"))]
}

/// Three numbers with commas between them.
fn numbers(text: &str) -> DVec3 {
    let parsed: Vec<f64> = text.split(", ").map(|n| n.parse().expect("a number")).collect();
    DVec3::from_slice(&parsed)
}

#[test]
fn pbrt_carries_every_bit_of_lights_and_surfaces() {
    for scene in [rolled(), shipped("first-night"), shipped("moonlit"), shipped("extreme/orders-of-magnitude")] {
        let file = pbrt::parse(&text(&scene, Renderer::Pbrt, "a.pbrt"));
        let mut lights = file.lights.clone();
        // Spots and moons have directions, which are compared below.
        let mut directions = Vec::new();
        for light in &mut lights {
            if let Shape::Spot { axis, .. } | Shape::Directional { towards: axis, .. } = light {
                directions.push(*axis);
            }
        }
        assert_eq!(sorted(lights.iter().map(key)), keys(&scene), "{}", scene.name());
        let wanted = scene.lights().iter().filter_map(|light| match light.shape() {
            Shape::Spot { axis, .. } => Some(axis),
            Shape::Directional { towards, .. } => Some(towards),
            _ => None,
        });
        let wanted: Vec<Vec3> = wanted.collect();
        assert_eq!(directions.len(), wanted.len());
        for (there, here) in directions.iter().zip(&wanted) {
            assert!((*there - *here).length() < 5e-7, "{there} for {here}");
        }
        assert_eq!(sorted(file.surfaces), surfaces(&scene), "{}", scene.name());
    }
}

#[test]
fn pbrt_films_keep_radiance_as_it_is() {
    let scene = shipped("plaza");
    let written = text(&scene, Renderer::Pbrt, "a.pbrt");
    let file = pbrt::parse(&written);
    assert_eq!(file.film.text("sensor"), "cie1931");
    assert_eq!(
        [file.film.number("iso"), file.camera.number("shutteropen"), file.camera.number("shutterclose")],
        [100.0, 0.0, 1.0]
    );
    assert_eq!(file.film.text("savefp16"), "false");
    assert!(!written.contains("power") && !written.contains("scale"));
    let note = &export(&scene, Renderer::Pbrt, Path::new("a.pbrt")).expect("an export").notes[0];
    assert!(note.contains("same flux") && written.contains(note), "{note}");
}

#[test]
fn mitsuba_files_name_their_meshes_and_cones() {
    let scene = rolled();
    let exported = export(&scene, Renderer::Mitsuba, Path::new("some/where/town.xml")).expect("an export");
    let (path, xml) = exported.files.last().expect("a file");
    assert_eq!(path, Path::new("some/where/town.xml"));
    let xml = std::str::from_utf8(xml).expect("text");
    for (path, _) in &exported.files[..exported.files.len() - 1] {
        let name = path.strip_prefix("some/where").expect("beside the scene").to_str().expect("text");
        assert!(name.starts_with("town/") && xml.contains(&format!("value=\"{name}\"")), "{name}");
    }
    let count = |mark: &str| xml.matches(mark).count();
    assert_eq!([count("type=\"point\""), count("type=\"spot\""), count("type=\"directional\"")], [5, 4, 1]);
    // Three radiances; one cone for all spots.
    assert_eq!([count("type=\"area\""), count("type=\"bitmap\""), exported.files.len()], [3, 1, 3]);

    // Meshes in the order of their shapes: the one material, then the radiances.
    let meshes = serialized(&exported.files[0].1);
    assert_eq!(meshes.len(), count("type=\"serialized\""));
    assert_eq!(meshes[0], scene.surfaces().iter().map(|s| s.corners.map(bits)).collect::<Vec<_>>());
    let triangles: Vec<_> = scene.lights().iter().map(|l| key(&l.shape())).filter(|k| k.0 == 3).map(|k| k.2).collect();
    assert_eq!(meshes[1..].concat().iter().map(|corners| corners.to_vec()).collect::<Vec<_>>(), triangles);
}

/// The triangles of each mesh in a `serialized` file, read by its definition.
fn serialized(file: &[u8]) -> Vec<Vec<[[u32; 3]; 3]>> {
    let number = |bytes: &[u8]| bytes.iter().rev().fold(0usize, |n, b| n << 8 | usize::from(*b));
    let count = number(&file[file.len() - 4..]);
    let table = file.len() - 4 - 8 * count;
    let offset = |i: usize| if i == count { table } else { number(&file[table + 8 * i..table + 8 * (i + 1)]) };
    (0..count)
        .map(|i| {
            let mesh = &file[offset(i)..offset(i + 1)];
            assert_eq!(mesh[..4], [0x1c, 0x04, 4, 0]);
            assert!(number(&[mesh[5], mesh[4]]).is_multiple_of(31), "no zlib header");
            let (mut data, mut at) = (Vec::new(), 6);
            loop {
                let length = number(&mesh[at + 1..at + 3]);
                assert_eq!(number(&mesh[at + 3..at + 5]), length ^ 0xffff);
                data.extend_from_slice(&mesh[at + 5..at + 5 + length]);
                let last = mesh[at] == 1;
                at += 5 + length;
                if last {
                    break;
                }
            }
            assert_eq!(at + 4, mesh.len());
            assert_eq!(number(&data[..4]), 0x1010, "f32 and face normals");
            let (vertices, triangles) = (number(&data[5..13]), number(&data[13..21]));
            assert_eq!(data.len(), 21 + vertices * 12 + triangles * 12);
            let vertex = |i: usize| {
                [0, 1, 2].map(|axis| {
                    let at = 21 + 12 * i + 4 * axis;
                    bits(Vec3::splat(f32::from_bits(number(&data[at..at + 4]) as u32)))[0]
                })
            };
            let index = |i: usize| number(&data[21 + 12 * vertices + 4 * i..21 + 12 * vertices + 4 * i + 4]);
            (0..triangles).map(|t| [0, 1, 2].map(|k| vertex(index(3 * t + k)))).collect()
        })
        .collect()
}

#[test]
fn files_of_other_formats_are_refused() {
    let scene = rolled();
    for (target, name) in [
        (Renderer::Gltf, "a.pbrt"),
        (Renderer::Pbrt, "a"),
        (Renderer::Mitsuba, "a.glb"),
        (Renderer::Mitsuba, "a&b.xml"),
    ] {
        let error = export(&scene, target, Path::new(name)).expect_err(name).to_string();
        assert!(error.contains(name), "{error}");
    }
    let error = Renderer::named("glft").expect_err("no such format").to_string();
    assert!(error.contains("format `glft`") && error.contains("gltf"), "{error}");
}

/// The part of pbrt's format that exports use, read strictly.
mod pbrt {
    use super::bits;
    use citylights::scene::light::Shape;
    use glam::{DVec3, Vec3};
    use std::collections::HashMap;

    /// The parameters of a directive, by name; each with its type.
    #[derive(Clone, Default)]
    pub(super) struct Parameters(HashMap<String, (String, Vec<String>)>);

    impl Parameters {
        fn values(&self, kind: &str, name: &str) -> Vec<f64> {
            let (given, values) = self.0.get(name).unwrap_or_else(|| panic!("no parameter {name}"));
            assert_eq!(given, kind, "the type of {name}");
            values.iter().map(|v| v.parse().unwrap_or_else(|_| panic!("{name} has `{v}`"))).collect()
        }

        fn vector(&self, kind: &str, name: &str) -> Vec3 {
            let values = self.values(kind, name);
            assert_eq!(values.len(), 3, "{name}");
            DVec3::from_slice(&values).as_vec3()
        }

        pub(super) fn number(&self, name: &str) -> f64 {
            let kind = self.0.get(name).unwrap_or_else(|| panic!("no parameter {name}")).0.clone();
            let values = self.values(&kind, name);
            assert!((kind == "float" || kind == "integer") && values.len() == 1, "{name}");
            assert!(kind == "float" || values[0].fract() == 0.0);
            values[0]
        }

        pub(super) fn text(&self, name: &str) -> &str {
            &self.0[name].1[0]
        }

        fn only(&self, known: &[&str]) {
            assert!(self.0.keys().all(|name| known.contains(&&**name)), "{:?} of {known:?}", self.0.keys());
        }
    }

    #[derive(Default)]
    pub(super) struct File {
        pub(super) scale: DVec3,
        pub(super) look_at: [DVec3; 3],
        pub(super) camera: Parameters,
        pub(super) film: Parameters,
        pub(super) lights: Vec<Shape>,
        pub(super) surfaces: Vec<([u32; 3], [[u32; 3]; 3])>,
    }

    /// Words, quoted words with their quotes, and brackets.
    fn tokens(text: &str) -> Vec<&str> {
        let mut out = Vec::new();
        for line in text.lines() {
            let mut rest = line.split('#').next().unwrap_or("").trim_start();
            while let Some(first) = rest.chars().next() {
                let length = match first {
                    '"' => rest[1..].find('"').expect("a closing quote") + 2,
                    '[' | ']' => 1,
                    _ => rest.find([' ', '[', ']', '"']).unwrap_or(rest.len()),
                };
                out.push(&rest[..length]);
                rest = rest[length..].trim_start();
            }
        }
        out
    }

    fn quoted(token: &str) -> &str {
        token.strip_prefix('"').and_then(|t| t.strip_suffix('"')).unwrap_or_else(|| panic!("{token} is not quoted"))
    }

    pub(super) fn parse(text: &str) -> File {
        let tokens = tokens(text);
        let mut at = 0;
        let mut file = File::default();
        let (mut world, mut albedo, mut emission) = (false, None, None);
        while at < tokens.len() {
            let directive = tokens[at];
            at += 1;
            let plain = match directive {
                "Scale" => 3,
                "LookAt" => 9,
                _ => 0,
            };
            let numbers: Vec<f64> = tokens[at..at + plain].iter().map(|t| t.parse().expect("a number")).collect();
            at += plain;
            let mut kind = "";
            let mut parameters = Parameters::default();
            if plain == 0 && tokens.get(at).is_some_and(|t| t.starts_with('"')) {
                kind = quoted(tokens[at]);
                at += 1;
                while let Some(token) = tokens.get(at).filter(|t| t.starts_with('"')) {
                    let (kind, name) = quoted(token).split_once(' ').expect("a type and a name");
                    at += 1;
                    let mut values = Vec::new();
                    if tokens[at] == "[" {
                        at += 1;
                        while tokens[at] != "]" {
                            values.push(tokens[at].to_owned());
                            at += 1;
                        }
                    } else {
                        values.push(tokens[at].trim_matches('"').to_owned());
                    }
                    at += 1;
                    let twice = parameters.0.insert(name.to_owned(), (kind.to_owned(), values));
                    assert!(twice.is_none(), "{name} twice");
                }
            }
            let options = ["Integrator", "PixelFilter", "Sampler", "Film", "Scale", "LookAt", "Camera", "WorldBegin"];
            assert_eq!(world, !options.contains(&directive), "{directive} stands on the wrong side of WorldBegin");
            match (directive, kind) {
                ("Scale", _) => file.scale = DVec3::from_slice(&numbers),
                ("LookAt", _) => file.look_at = [0, 3, 6].map(|i| DVec3::from_slice(&numbers[i..])),
                ("Integrator", "path") => assert_eq!(parameters.number("maxdepth"), 1.0),
                ("PixelFilter", "box") => {
                    assert_eq!([parameters.number("xradius"), parameters.number("yradius")], [0.5, 0.5]);
                }
                ("Sampler", "independent") => assert!(parameters.number("pixelsamples") >= 1.0),
                ("Film", "rgb") => file.film = parameters,
                ("Camera", "perspective") => file.camera = parameters,
                ("WorldBegin", _) => world = true,
                ("AttributeBegin", _) => assert!(emission.is_none()),
                ("AttributeEnd", _) => assert!(emission.take().is_some()),
                ("Material", "diffuse") => {
                    parameters.only(&["reflectance"]);
                    albedo = Some(parameters.vector("rgb", "reflectance"));
                }
                ("AreaLightSource", "diffuse") => {
                    parameters.only(&["L", "twosided"]);
                    assert_eq!(parameters.text("twosided"), "false");
                    assert_eq!(albedo, Some(Vec3::ZERO), "an emitter reflects");
                    emission = Some(parameters.vector("rgb", "L"));
                }
                ("LightSource", "point") => {
                    parameters.only(&["from", "I"]);
                    file.lights.push(Shape::Point {
                        position: parameters.vector("point3", "from"),
                        intensity: parameters.vector("rgb", "I"),
                    });
                }
                ("LightSource", "spot") => {
                    parameters.only(&["from", "to", "I", "coneangle", "conedeltaangle"]);
                    let position = parameters.vector("point3", "from");
                    let to = parameters.vector("point3", "to");
                    let outer = parameters.number("coneangle");
                    let inner = outer - parameters.number("conedeltaangle");
                    assert!(0.0 <= inner && inner < outer && outer <= 90.0, "{inner} {outer}");
                    file.lights.push(Shape::Spot {
                        position,
                        axis: (to.as_dvec3() - position.as_dvec3()).normalize().as_vec3(),
                        intensity: parameters.vector("rgb", "I"),
                        cos_inner: inner.to_radians().cos() as f32,
                        cos_outer: outer.to_radians().cos() as f32,
                    });
                }
                ("LightSource", "distant") => {
                    parameters.only(&["from", "to", "L"]);
                    file.lights.push(Shape::Directional {
                        towards: (parameters.vector("point3", "from") - parameters.vector("point3", "to")).normalize(),
                        irradiance: parameters.vector("rgb", "L"),
                    });
                }
                ("Shape", "trianglemesh") => {
                    parameters.only(&["P", "indices"]);
                    let points = parameters.values("point3", "P");
                    let indices = parameters.values("integer", "indices");
                    assert!(points.len().is_multiple_of(9) && indices.len() == points.len() / 3 && !indices.is_empty());
                    for triangle in indices.chunks_exact(3) {
                        let corners = [0, 1, 2].map(|k| {
                            let i = triangle[k] as usize * 3;
                            DVec3::from_slice(&points[i..i + 3]).as_vec3()
                        });
                        match emission {
                            Some(radiance) => file.lights.push(Shape::Triangle { corners, radiance }),
                            None => file.surfaces.push((bits(albedo.expect("a material")), corners.map(bits))),
                        }
                    }
                }
                other => panic!("unknown directive {other:?}"),
            }
        }
        assert!(world && emission.is_none());
        file
    }
}
