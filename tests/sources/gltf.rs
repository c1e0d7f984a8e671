//! Promise: a glTF file shows here what its specification says: every triangle and every light in its place, as bright
//! as it says.
#![cfg(feature = "gltf")]

use crate::common::{digest, lambert, stage};
use crate::made::{File, irradiance, near};
use citylights::base::random::Stream;
use citylights::scene::camera::Camera;
use citylights::scene::light::Shape;
use citylights::scene::{Parts, Scene, Surface};
use citylights::visibility::view::Seen;
use glam::{DVec3, Mat4, Vec3};
use serde_json::{Value, json};
use std::f64::consts::PI;

/// One triangle without symmetry, front towards +y of glTF and +z of ours.
const TRIANGLE: [[f32; 3]; 3] = [[0.25, 1.5, 0.1], [2.0, 1.5, -0.3], [0.5, 1.75, -3.0]];

/// A file with one primitive at a node.
fn shown(node: Value, primitive: impl FnOnce(&mut File) -> Value) -> File {
    let mut file = File::new();
    let primitive = primitive(&mut file);
    let mut node = node;
    node["mesh"] = json!(file.mesh(primitive));
    file.node(node);
    file
}

fn plain(file: &mut File) -> Value {
    json!({ "attributes": { "POSITION": file.positions(&TRIANGLE) } })
}

fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    scene.surfaces().iter().map(|surface| surface.corners).collect()
}

/// Corners in glTF's axes in ours.
fn turned(corners: [[f32; 3]; 3]) -> [Vec3; 3] {
    corners.map(|[x, y, z]| Vec3::new(x, -z, y))
}

/// The outward normal, not normalised.
fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}

#[test]
fn corners_stand_exactly_where_the_file_puts_them() {
    let scene = shown(json!({}), plain).scene();
    assert_eq!(corners(&scene), [turned(TRIANGLE)]);
    assert_eq!(scene.materials()[0].albedo, Vec3::ONE, "glTF's own default");
}

#[test]
fn indices_of_every_size_name_the_same_corners() {
    for kind in [5121, 5123, 5125] {
        let scene = shown(json!({}), |file| {
            let indices = file.indices(kind, &[1, 2, 0, 2, 0, 1]);
            json!({ "attributes": { "POSITION": file.positions(&TRIANGLE) }, "indices": indices, "mode": 4 })
        })
        .scene();
        let [a, b, c] = turned(TRIANGLE);
        assert_eq!(corners(&scene), [[b, c, a], [c, a, b]], "{kind}");
    }
}

#[test]
fn interleaved_positions_are_found_by_their_stride() {
    let mut file = shown(json!({}), |file| {
        // Each position followed by eight bytes of something else, after four bytes of something else.
        let padded: Vec<[f32; 5]> = TRIANGLE.iter().map(|[x, y, z]| [*x, *y, *z, 9.0, 9.0]).collect();
        file.bin = [9.0].iter().chain(padded.as_flattened()).flat_map(|x: &f32| x.to_le_bytes()).collect();
        let view = file.push("bufferViews", json!({ "buffer": 0, "byteLength": 64, "byteStride": 20 }));
        let accessor =
            json!({ "bufferView": view, "byteOffset": 4, "componentType": 5126, "count": 3, "type": "VEC3" });
        json!({ "attributes": { "POSITION": file.push("accessors", accessor) } })
    });
    assert_eq!(corners(&file.scene()), [turned(TRIANGLE)]);
    // The last element need not be followed by the rest of its stride, but must be there itself.
    file.json["bufferViews"][0]["byteLength"] = json!(55);
    assert!(file.read().is_err());
    file.json["bufferViews"][0]["byteLength"] = json!(56);
    assert!(file.read().is_ok());
}

#[test]
fn strips_and_fans_are_the_triangles_that_the_specification_lists() {
    let ring = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 0.0, -1.0], [1.3, 0.0, -1.2], [0.4, 0.0, -2.0]];
    let of = |mode: u32, indexed: bool| {
        let scene = shown(json!({}), |file| {
            let mut primitive = json!({ "attributes": { "POSITION": file.positions(&ring) }, "mode": mode });
            if indexed {
                primitive["indices"] = json!(file.indices(5123, &[0, 1, 2, 3, 4]));
            }
            primitive
        });
        corners(&scene.scene())
    };
    let corner = |i: usize| Vec3::new(ring[i][0], -ring[i][2], ring[i][1]);
    let listed = |list: [[usize; 3]; 3]| list.map(|triangle| triangle.map(corner));
    for indexed in [false, true] {
        let strip = of(5, indexed);
        assert_eq!(strip, listed([[0, 1, 2], [1, 3, 2], [2, 3, 4]]), "section 3.7.2.1");
        assert!(strip.iter().all(|triangle| normal(*triangle).z > 0.0), "all fronts point upwards");
        assert_eq!(of(6, indexed), listed([[1, 2, 0], [2, 3, 0], [3, 4, 0]]), "section 3.7.2.1");
    }
}

/// A quarter turn about +y: +z goes to +x, +x to -z.
const QUARTER: [f64; 4] = [0.0, std::f64::consts::FRAC_1_SQRT_2, 0.0, std::f64::consts::FRAC_1_SQRT_2];

#[test]
fn scale_then_rotation_then_translation_and_parents_last() {
    let mut file = File::new();
    let mesh = plain(&mut file);
    let mesh = file.mesh(mesh);
    let child = file.push("nodes", json!({ "mesh": mesh, "translation": [1, 0, 0], "scale": [2, 2, 2] }));
    file.node(json!({ "children": [child], "rotation": QUARTER, "translation": [0, 10, 0] }));
    // Twice as large, 1 m along x, turned so that x goes to -z and z to x, 10 m up.
    let wanted = TRIANGLE.map(|[x, y, z]| [2.0 * z, 2.0 * y + 10.0, -(2.0 * x + 1.0)]);
    let found = corners(&file.scene())[0];
    for (found, wanted) in found.iter().zip(turned(wanted)) {
        assert!((*found - wanted).length() < 1e-6, "{found} for {wanted}");
    }
}

#[test]
fn a_matrix_means_what_its_parts_do() {
    // Column by column: x goes to -2z, y to 2y, z to 2x.
    let matrix = [0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 5, 6, 7, 1];
    let by_matrix = corners(&shown(json!({ "matrix": matrix }), plain).scene())[0];
    let node = json!({ "translation": [5, 6, 7], "rotation": QUARTER, "scale": [2, 2, 2] });
    let by_parts = corners(&shown(node, plain).scene())[0];
    for (a, b) in by_matrix.iter().zip(by_parts) {
        assert!((*a - b).length() < 1e-6, "{a} and {b}");
    }
}

#[test]
fn a_mirror_keeps_the_front_in_front() {
    // The front of the triangle faces up; a mirror along x does not change which side that is.
    for (scale, up) in [([1, 1, 1], true), ([-1, 1, 1], true), ([1, -1, 1], false), ([-1, -1, -1], false)] {
        let front = normal(corners(&shown(json!({ "scale": scale }), plain).scene())[0]);
        assert_eq!(front.z > 0.0, up, "{scale:?}");
        let mut file = File::ground();
        file.emitter(TRIANGLE, 50.0, false, json!({ "scale": scale, "translation": [0, 6, 0] }));
        let scene = file.scene();
        let Shape::Triangle { corners, radiance } = scene.lights()[0].shape() else { panic!("a triangle") };
        assert_eq!((normal(corners).z > 0.0, radiance), (up, Vec3::splat(50.0)), "{scale:?}");
        assert_eq!(irradiance(&scene, Vec3::new(0.3, 0.2, 0.0), Vec3::Z) > 0.0, !up, "{scale:?}: light on the ground");
    }
}

#[test]
fn a_mesh_under_three_nodes_stands_three_times() {
    let mut file = File::new();
    let mesh = plain(&mut file);
    let mesh = file.mesh(mesh);
    for x in [0.0, 100.0, -50.5] {
        file.node(json!({ "mesh": mesh, "translation": [x, 0, 0] }));
    }
    let found = corners(&file.scene());
    assert_eq!(found, [0.0, 100.0, -50.5].map(|x| turned(TRIANGLE).map(|corner| corner + Vec3::X * x)));
}

/// Triangles of a file as the `gltf` crate reads and places them, in its order and axes.
fn by_the_crate(file: &File) -> Vec<[Vec3; 3]> {
    let read = gltf::Gltf::from_slice(&file.glb()).expect("valid for the crate");
    let mut waiting: Vec<(gltf::Node, Mat4)> =
        read.default_scene().expect("a scene").nodes().map(|node| (node, Mat4::IDENTITY)).collect();
    let mut found = Vec::new();
    while let Some((node, above)) = waiting.pop() {
        let to_world = above * Mat4::from_cols_array_2d(&node.transform().matrix());
        waiting.extend(node.children().map(|child| (child, to_world)));
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            let reader = primitive.reader(|_| read.blob.as_deref());
            let positions: Vec<Vec3> = reader.read_positions().expect("positions").map(Vec3::from_array).collect();
            let indices: Vec<u32> = match reader.read_indices() {
                Some(indices) => indices.into_u32().collect(),
                None => (0..positions.len() as u32).collect(),
            };
            found.extend(
                indices.chunks(3).map(|t| [0, 1, 2].map(|i| to_world.transform_point3(positions[t[i] as usize]))),
            );
        }
    }
    found
}

#[test]
fn random_trees_of_nodes_place_triangles_where_the_gltf_crate_does() {
    for seed in 0..20 {
        let mut stream = Stream::keyed(&[seed]);
        let mut uniform = |low: f64, high: f64| low + (high - low) * stream.uniform64();
        let mut file = File::new();
        let mesh = plain(&mut file);
        let indices = file.indices(5121, &[2, 0, 1]);
        let indexed = json!({ "attributes": { "POSITION": 0 }, "indices": indices });
        let meshes = [file.mesh(mesh), file.mesh(indexed)];
        let mut open: Vec<usize> = Vec::new();
        for i in 0..12 {
            let [x, y, z, w] = [(); 4].map(|()| uniform(-1.0, 1.0));
            let length = (x * x + y * y + z * z + w * w).sqrt();
            let mut node = json!({
                "translation": [uniform(-9.0, 9.0), uniform(-9.0, 9.0), uniform(-9.0, 9.0)],
                "rotation": [x / length, y / length, z / length, w / length],
                "scale": [uniform(0.2, 2.0), uniform(0.2, 2.0), uniform(0.2, 2.0)],
                "mesh": meshes[i % 2],
            });
            // Up to two of the nodes that wait for a parent become children of this one.
            let children: Vec<usize> = open.drain(..open.len().min(i % 3)).collect();
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            open.push(file.push("nodes", node));
        }
        file.json["scenes"][0]["nodes"] = json!(open);
        let mut wanted: Vec<[Vec3; 3]> =
            by_the_crate(&file).iter().map(|c| c.map(|v| Vec3::new(v.x, -v.z, v.y))).collect();
        let mut found = corners(&file.scene());
        assert_eq!(found.len(), 12);
        let key = |c: &[Vec3; 3]| (c[0] + c[1] + c[2]).dot(Vec3::new(1.0, 1.7, 0.3));
        wanted.sort_by(|a, b| key(a).total_cmp(&key(b)));
        found.sort_by(|a, b| key(a).total_cmp(&key(b)));
        for (a, b) in found.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((*a - *b).length() < 2e-4, "seed {seed}: {a} here, {b} there");
        }
    }
}

#[test]
fn a_scene_moved_by_a_thousand_kilometres_keeps_every_byte() {
    let made = |x: f64| {
        let mut file = File::ground();
        file.emitter(TRIANGLE, 50.0, false, json!({ "translation": [0.1, 4, 0.2] }));
        file.lamp(json!({ "type": "spot", "spot": {} }), json!({ "translation": [2.7, 5, 1] }));
        let roots = file.json["scenes"][0]["nodes"].take();
        file.json["scenes"][0]["nodes"] = json!([]);
        file.node(json!({ "children": roots, "translation": [x, 0, -x] }));
        file.scene()
    };
    let (here, there) = (made(0.0), made(1e6));
    assert_eq!(there.origin(), DVec3::new(1e6, 1e6, 0.0));
    assert!(digest(&here) == digest(&there));
}

#[test]
fn a_point_light_gives_its_candela_over_the_square() {
    let mut file = File::ground();
    let light = json!({ "type": "point", "color": [1, 0.5, 0.25], "intensity": 100 });
    file.lamp(light, json!({ "translation": [0, 6, 0], "scale": [3, 3, 3] }));
    let scene = file.scene();
    let Shape::Point { position, intensity } = scene.lights()[0].shape() else { panic!("a point") };
    assert_eq!((position, intensity), (Vec3::Z * 6.0, Vec3::new(100.0, 50.0, 25.0)));
    near(irradiance(&scene, Vec3::ZERO, Vec3::Z), 100.0 / 36.0, 1e-6);
    near(irradiance(&scene, Vec3::new(4.0, -3.0, 0.0), Vec3::Z), 100.0 * 6.0 / 61f64.powf(1.5), 2e-6);
}

/// Points a node's light from +y straight down: -z goes to -y.
const DOWN: [f64; 4] = [-std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];

#[test]
fn a_spot_falls_off_between_its_cones_as_the_extension_says() {
    // The extension's own reference code, in f64.
    let falloff = |angle: f64, inner: f64, outer: f64| {
        let scale = 1.0 / (inner.cos() - outer.cos());
        (angle.cos() * scale - outer.cos() * scale).clamp(0.0, 1.0).powi(2)
    };
    for (spot, inner, outer) in [
        (json!({ "innerConeAngle": 0.3, "outerConeAngle": 0.9 }), 0.3, 0.9),
        (json!({}), 0.0, PI / 4.0),
        (json!({ "outerConeAngle": 1.5707964 }), 0.0, PI / 2.0),
        (json!({ "innerConeAngle": 0.5, "outerConeAngle": 0.5 }), 0.5 - 1e-9, 0.5),
    ] {
        let mut file = File::ground();
        let light = json!({ "type": "spot", "intensity": 500, "spot": spot });
        file.lamp(light, json!({ "translation": [0, 5, 0], "rotation": DOWN }));
        let scene = file.scene();
        let mut lit = 0;
        for angle in [0.0f64, 0.1, 0.29, 0.45, 0.55, 0.7, 0.78, 0.8, 0.89, 0.95] {
            let x = 5.0 * angle.tan();
            let wanted = 500.0 * falloff(angle, inner, outer) * angle.cos().powi(3) / 25.0;
            let found = irradiance(&scene, Vec3::new(x as f32, 0.0, 0.0), Vec3::Z);
            assert!((found - wanted).abs() < 2e-5 * wanted + 1e-7, "{inner}..{outer}, {angle}: {found} for {wanted}");
            lit += i32::from(wanted > 0.0);
        }
        assert!(lit >= 4, "{lit} angles lie within the cone");
    }
}

#[test]
fn a_spot_without_cones_has_the_default_ones() {
    let mut file = File::ground();
    file.lamp(json!({ "type": "spot" }), json!({ "rotation": DOWN }));
    let Shape::Spot { axis, intensity, cos_inner, cos_outer, .. } = file.scene().lights()[0].shape() else {
        panic!("a spot")
    };
    assert!((axis - Vec3::NEG_Z).length() < 1e-7 && intensity == Vec3::ONE);
    assert_eq!((cos_inner, cos_outer), (1.0, std::f32::consts::FRAC_1_SQRT_2));
}

#[test]
fn a_directional_light_gives_its_lux_times_the_cosine() {
    let mut file = File::ground();
    // 60 degrees from the vertical, turned about +y on top; a child's direction is its parent's too.
    let child = file.light(json!({ "type": "directional", "intensity": 0.25 }));
    let (sin, cos) = (15f64.to_radians().sin(), 15f64.to_radians().cos());
    let child = file.push(
        "nodes",
        json!({ "rotation": [-sin, 0, 0, cos], "extensions": { "KHR_lights_punctual": { "light": child } } }),
    );
    file.node(json!({ "children": [child], "rotation": QUARTER, "scale": [2, 2, 2] }));
    let scene = file.scene();
    let Shape::Directional { towards, .. } = scene.lights()[0].shape() else { panic!("directional") };
    // -z tilted down by 30 degrees, then turned towards -x: the light comes from +x, 30 degrees up.
    let wanted = Vec3::new(0.75f32.sqrt(), 0.0, 0.5);
    assert!((towards - wanted).length() < 1e-6, "{towards} for {wanted}");
    near(irradiance(&scene, Vec3::new(1.0, 2.0, 0.0), Vec3::Z), 0.25 * 0.5, 1e-6);
}

#[test]
fn an_emissive_triangle_shines_from_its_front_with_factor_times_strength() {
    for double_sided in [false, true] {
        let mut file = File::ground();
        // The front faces up, 4 m over the ground.
        file.emitter(TRIANGLE, 50.0, double_sided, json!({ "translation": [0, 4, 0] }));
        file.json["materials"][1]["emissiveFactor"] = json!([0.5, 0.25, 1]);
        let scene = file.scene();
        assert_eq!(scene.lights().len(), 1 + usize::from(double_sided));
        assert_eq!(scene.surfaces().len(), 2, "an emitter is no surface");
        let Shape::Triangle { corners, radiance } = scene.lights()[0].shape() else { panic!("a triangle") };
        assert_eq!(radiance, Vec3::new(25.0, 12.5, 50.0));
        let (above, below) = (Vec3::new(0.5, 0.5, 9.0), Vec3::new(0.4, 0.7, 0.0));
        near(irradiance(&scene, above, Vec3::NEG_Z), 25.0 * lambert(corners, above, Vec3::NEG_Z), 1e-3);
        let found = irradiance(&scene, below, Vec3::Z);
        if double_sided {
            near(found, 25.0 * lambert(corners, below, Vec3::Z), 1e-3);
        } else {
            assert_eq!(found, 0.0, "behind it is dark");
        }
    }
}

#[test]
fn an_emitter_is_seen_from_the_sides_that_it_shines_from() {
    for double_sided in [false, true] {
        let mut file = File::ground();
        file.emitter(TRIANGLE, 50.0, double_sided, json!({ "translation": [0, 4, 0] }));
        let parts = file.scene().parts();
        let Shape::Triangle { corners: [a, b, c], .. } = parts.lights[0] else { panic!("a triangle") };
        let middle = (a + b + c) / 3.0;
        for (height, in_front) in [(9.0, true), (0.5, false)] {
            let eye = Vec3::new(middle.x + 0.1, middle.y - 0.1, height);
            let camera = Camera::new(eye, middle, 5.0, 1, 1).expect("a camera");
            let stage = stage(Parts { camera, ..parts.clone() });
            let seen = stage.view().pixels()[0];
            let wanted = if in_front || double_sided { "Emitter(" } else { "EmitterBack" };
            assert!(format!("{seen:?}").starts_with(wanted), "{seen:?} from {height} m, double-sided: {double_sided}");
            if let Seen::Emitter(light) = seen {
                let Shape::Triangle { corners: [a, b, c], .. } = parts.lights[light as usize] else { panic!("one") };
                assert!((b - a).cross(c - a).dot(eye - a) > 0.0, "its back was seen");
            }
        }
    }
}

#[test]
fn a_material_that_emits_nothing_is_a_surface() {
    for (strength, factor) in [(0.0, 1.0), (7.0, 0.0)] {
        let mut file = File::ground();
        file.emitter(TRIANGLE, strength, true, json!({}));
        file.json["materials"][1]["emissiveFactor"] = json!([factor, factor, factor]);
        // A texture that nothing multiplies adds no light.
        file.json["materials"][1]["emissiveTexture"] = json!({ "index": 0 });
        let scene = file.scene();
        assert_eq!((scene.lights().len(), scene.surfaces().len()), (0, 3));
        assert_eq!(scene.surfaces()[2], Surface { corners: turned(TRIANGLE), material: 1 });
    }
}
