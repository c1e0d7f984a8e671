//! A scene that goes out as glTF comes back in as the same scene.

#![cfg(all(feature = "gltf", feature = "recipe"))]

use crate::promises::common;
use citylights::export::{Renderer, export};
use citylights::scene::light::{Light, Shape};
use citylights::scene::{Parts, Scene};
use citylights::sources::{Overrides, open};
use glam::Vec3;
use std::path::Path;

/// Recipes whose every kind of light and every size of coordinates goes out and in.
const SCENES: [&str; 6] =
    ["first-night", "lamps-only", "moonlit", "plaza", "shadows", "extreme/a-thousand-kilometres-away"];

/// The scene of a recipe on a small film, and what comes back of it.
fn there_and_back(name: &str) -> [Parts; 2] {
    let recipe = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
    let scene = open(&recipe, &Overrides { resolution: Some((64, 36)), ..Overrides::default() }).expect(name);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.glb");
    export(&scene, Renderer::Gltf, &file).and_then(|export| export.write()).expect(name);
    let back = open(&file, &Overrides::default()).expect(name);
    [scene, back].map(|scene| in_order(scene.parts()))
}

/// The same scene with its lights in the order of their numbers: glTF has no order among lights.
fn in_order(mut parts: Parts) -> Parts {
    parts.lights.sort_by_cached_key(|&light| numbers(&light).map(ordered));
    parts.groups.clear();
    parts
}

/// An integer for each f32, in the same order.
fn ordered(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    if bits < 0 { i32::MIN - bits } else { bits }
}

/// What tells lights apart and no rotation rounds, then all else: the kind, the colour, the place; directions, cones.
fn numbers(light: &Shape) -> [f32; 18] {
    let kind = Light::from(*light).kind() as u32 as f32;
    let (colour, place, more) = match *light {
        Shape::Point { position, intensity } => (intensity, position, [0.0; 6]),
        Shape::Spot { position, axis, intensity, cos_inner, cos_outer } => {
            (intensity, position, [axis.x, axis.y, axis.z, cos_inner, cos_outer, 0.0])
        }
        Shape::Directional { towards, irradiance } => {
            (irradiance, Vec3::ZERO, [towards.x, towards.y, towards.z, 0.0, 0.0, 0.0])
        }
        Shape::Triangle { corners: [a, b, c], radiance } => (radiance, a, [b.x, b.y, b.z, c.x, c.y, c.z]),
    };
    let mut all = [0.0; 18];
    all[0] = kind;
    all[1..4].copy_from_slice(&colour.to_array());
    all[4..7].copy_from_slice(&place.to_array());
    all[7..13].copy_from_slice(&more);
    all
}

#[test]
fn the_lights_are_the_same() {
    for name in SCENES {
        let [out, back] = there_and_back(name);
        assert_eq!(out.lights.len(), back.lights.len(), "{name}");
        for (a, b) in out.lights.iter().zip(&back.lights) {
            let (x, y) = (numbers(a), numbers(b));
            // Kind, colour and place have every bit; directions went through a rotation, cones through an angle.
            assert_eq!(x[..7], y[..7], "{name}: {a:?} {b:?}");
            match a {
                Shape::Triangle { .. } | Shape::Point { .. } => assert_eq!(x, y, "{name}: {a:?} {b:?}"),
                _ => assert!(x.iter().zip(y).all(|(x, y)| (x - y).abs() < 5e-7), "{name}: {a:?} {b:?}"),
            }
        }
    }
}

#[test]
fn the_image_is_the_same_but_for_rounding() {
    for name in SCENES {
        let [out, back] = there_and_back(name).map(common::stage);
        assert_eq!(out.scene().camera().resolution(), back.scene().camera().resolution(), "{name}");
        assert_eq!(out.scene().exposure(), back.scene().exposure(), "{name}");
        let images = [&out, &back].map(|stage| {
            let image = common::image("all:points=random", stage, 1);
            citylights::render::picture::picture(stage, &image)
        });
        let off: Vec<f32> = std::iter::zip(&images[0], &images[1])
            .map(|(a, b)| {
                let (a, b) = (Vec3::from_array(*a), Vec3::from_array(*b));
                (a - b).abs().max_element() / a.max(b).max_element().max(1e-30)
            })
            .collect();
        // The camera's directions are rounded to f32: at the edge of a shadow or an object that can be another picture.
        let far = off.iter().filter(|&&off| off > 1e-3).count();
        let mut sorted = off.clone();
        sorted.sort_by(f32::total_cmp);
        println!("{name}: median {}, 99 % {}, {far} pixels off", sorted[off.len() / 2], sorted[off.len() * 99 / 100]);
        assert!(sorted[off.len() / 2] < 1e-6 && far <= off.len() / 200, "{name}: {far} of {} pixels", off.len());
    }
}

#[test]
fn surfaces_materials_and_exposure_are_the_same() {
    for name in SCENES {
        let [out, back] = there_and_back(name);
        let sorted = |parts: &Parts| {
            let mut all: Vec<_> = parts
                .surfaces
                .iter()
                .map(|s| {
                    let material = &parts.materials[s.material as usize];
                    let corners = s.corners.map(|c| c.to_array().map(ordered));
                    (corners, material.name.clone(), material.albedo.to_array().map(ordered), material.street)
                })
                .collect();
            all.sort();
            all
        };
        assert_eq!(sorted(&out), sorted(&back), "{name}");
        assert_eq!(out.ev100, back.ev100, "{name}");
        assert_eq!(Scene::new(back).expect(name).name(), out.name, "{name}");
    }
}
