//! Promise: where a scene stands and how large it is changes nothing but what rounding its numbers changes.
use crate::promises::common::{bits, digest, image, stage_with};
use citylights::base::statistics::Moments;
use citylights::render::exact::exact;
use citylights::scene::light::Shape;
use citylights::scene::{Parts, Scene};
use citylights::sources::Overrides;
use citylights::sources::recipe::parse;
use citylights::strategy::{BuildContext, Claim, Registry};
use citylights::study::quality::{Finding, quality};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DQuat, DVec3, Vec3};
use std::path::Path;

/// A street corner with every kind of surface and light, its places moved by `shift` and then, like all lengths, times
/// `scale`; strengths times `scale^2`, so that the picture stays.
fn recipe(shift: DVec3, scale: f64) -> String {
    let place = |x: f64, y: f64, z: f64| {
        let p = (DVec3::new(x, y, z) + shift) * scale;
        format!("[{:?}, {:?}, {:?}]", p.x, p.y, p.z)
    };
    let strength = |s: f64| s * scale * scale;
    let level = (DVec3::new(0.5, -0.25, 0.0) + shift) * scale;
    format!(
        r#"
name = "corner"
version = 1
camera = {{ position = {eye}, target = {target}, resolution = [40, 24] }}
ground = {{ size = {size:?}, centre = [{x:?}, {y:?}], height = {z:?}, material = "paving" }}
box = [
    {{ low = {low1}, high = {high1}, material = "plaster" }},
    {{ low = {low2}, high = {high2}, material = "brick" }},
]
quad = [{{ corners = [{q0}, {q1}, {q2}, {q3}], material = "plaster" }}]
triangle = [{{ corners = [{t0}, {t1}, {t2}], material = "brick" }}]
light = [
    {{ kind = "point", position = {lamp1}, intensity = {i1:?} }},
    {{ kind = "point", position = {lamp2}, intensity = {i2:?} }},
    {{ kind = "point", position = {lamp3}, intensity = {i2:?} }},
    {{ kind = "spot", position = {spot}, target = {aim}, inner = 20, outer = 60, intensity = {i3:?} }},
    {{ kind = "directional", towards = [0.3, -0.5, 0.8], irradiance = 0.25 }},
    {{ kind = "triangle", corners = [{p0}, {p1}, {p2}], radiance = 40 }},
    {{ kind = "triangle", corners = [{p0}, {p2}, {p3}], radiance = 40 }},
]
[materials.paving]
albedo = [0.3, 0.3, 0.3]
[materials.plaster]
albedo = [0.5, 0.5, 0.4]
[materials.brick]
albedo = [0.4, 0.2, 0.1]
"#,
        eye = place(0.5, -14.25, 4.75),
        target = place(0.25, 0.0, 1.5),
        size = 40.0 * scale,
        x = level.x,
        y = level.y,
        z = level.z,
        low1 = place(-9.25, -3.5, 0.0),
        high1 = place(-4.75, 6.25, 7.5),
        low2 = place(3.125, -1.0, 0.0),
        high2 = place(8.0, 6.5, 5.25),
        q0 = place(-2.0, 3.0, 0.5),
        q1 = place(1.0, 3.25, 0.5),
        q2 = place(1.0, 3.75, 2.5),
        q3 = place(-2.0, 3.5, 2.5),
        t0 = place(-1.0, -3.0, 1.0),
        t1 = place(0.5, -2.5, 1.25),
        t2 = place(-0.25, -3.25, 2.25),
        lamp1 = place(-3.5, -4.0, 5.0),
        lamp2 = place(1.75, 1.5, 3.5),
        lamp3 = place(2.25, -6.0, 4.5),
        spot = place(0.0, 5.5, 8.0),
        aim = place(0.0, 0.5, 0.0),
        i1 = strength(300.0),
        i2 = strength(120.0),
        i3 = strength(700.0),
        p0 = place(-4.65, -2.0, 1.5),
        p1 = place(-4.65, 0.0, 1.5),
        p2 = place(-4.65, 0.0, 3.0),
        p3 = place(-4.65, -2.0, 3.0),
    )
}

fn read(shift: DVec3, scale: f64) -> Scene {
    parse(&recipe(shift, scale), Path::new("corner.toml"), &Overrides::default()).expect("a recipe")
}

fn whole(scene: Scene) -> Stage {
    Stage::new(scene, LeaveOut::No, Offset::SCALED)
}

/// Light at every pixel that sees a surface, by pixel.
fn picture(stage: &Stage) -> Vec<(u32, f64)> {
    stage.receivers().iter().map(|at| (at.pixel, exact(stage, at, 64, 1).mean().element_sum())).collect()
}

/// The difference of two pictures' means, as a share, and the share of their common pixels that differ by more than 1
/// %.
fn difference(a: &[(u32, f64)], b: &[(u32, f64)]) -> (f64, f64) {
    let mean = |picture: &[(u32, f64)]| Moments::of(picture.iter().map(|(_, light)| *light)).mean;
    let pairs: Vec<(f64, f64)> = a
        .iter()
        .filter_map(|(pixel, light)| {
            let other = b.binary_search_by_key(pixel, |(pixel, _)| *pixel);
            other.ok().map(|i| (*light, b[i].1))
        })
        .collect();
    assert!(pairs.len() > 300 && mean(a) > 0.0, "{} pixels, mean {}", pairs.len(), mean(a));
    let differ = pairs.iter().filter(|(a, b)| (a - b).abs() > 0.01 * a.max(*b)).count();
    (mean(b) / mean(a) - 1.0, differ as f64 / pairs.len() as f64)
}

fn sorted(stage: &Stage) -> Vec<(u32, f64)> {
    let mut picture = picture(stage);
    picture.sort_by_key(|(pixel, _)| *pixel);
    picture
}

#[test]
fn a_recipe_written_a_thousand_kilometres_away_is_the_same_to_the_byte() {
    let here = read(DVec3::ZERO, 1.0);
    // Whole kilometres: the scene's origin, and the numbers of this recipe but for four, are then exact.
    let shift = DVec3::new(1e6, -2e6, 3e3);
    let there = read(shift, 1.0);
    assert_eq!(there.origin() - here.origin(), shift);
    assert_eq!(digest(&here), digest(&there));
    let (a, b) = (image("all", &whole(here), 2), image("all", &whole(there), 2));
    assert_eq!(bits(&a), bits(&b));
}

#[test]
fn a_recipe_written_anywhere_changes_as_little_as_its_rounding() {
    let here = sorted(&whole(read(DVec3::ZERO, 1.0)));
    // The origin is a multiple of 1 km: up to half of one is left in the coordinates, which are rounded to 30
    // micrometres.
    let there = whole(read(DVec3::new(1e6 + 123.4, -1e6 - 432.1, 77.7), 1.0));
    assert!(there.scene().bounds().1.abs().max_element() > 400.0);
    let (mean, pixels) = difference(&here, &sorted(&there));
    println!("{mean:e} of the mean, {pixels} of the pixels differ by 1 %");
    assert!(mean.abs() < 1e-3, "{mean} of the mean");
    assert!(pixels < 0.02, "{pixels} of the pixels differ by more than 1 %");
}

#[test]
fn a_recipe_a_hundred_times_as_large_gives_the_same_picture() {
    let here = sorted(&whole(read(DVec3::ZERO, 1.0)));
    for scale in [100.0, 0.01] {
        let (mean, pixels) = difference(&here, &sorted(&whole(read(DVec3::ZERO, scale))));
        println!("x {scale}: {mean:e} of the mean, {pixels} of the pixels differ by 1 %");
        assert!(mean.abs() < 2e-3, "x {scale}: {mean} of the mean");
        assert!(pixels < 0.02, "x {scale}: {pixels} of the pixels differ by more than 1 %");
    }
}

#[test]
fn a_model_on_a_table_gives_the_picture_of_the_street_to_the_bit() {
    let street = whole(read(DVec3::ZERO, 1.0));
    let wanted = bits(&image("all", &street, 2));
    for scale in [2f64.powi(-8), 2f64.powi(-4)] {
        let model = whole(read(DVec3::ZERO, scale));
        let image = bits(&image("all", &model, 2));
        let differ = image.iter().zip(&wanted).filter(|(a, b)| a != b).count();
        assert!(image.len() == wanted.len() && differ == 0, "times {scale}: {differ} of {} differ", wanted.len());
    }
}

/// The parts of a scene with every place put through `place`.
fn placed(mut parts: Parts, place: impl Fn(Vec3) -> Vec3) -> Parts {
    for surface in &mut parts.surfaces {
        surface.corners = surface.corners.map(&place);
    }
    for light in &mut parts.lights {
        match light {
            Shape::Point { position, .. } | Shape::Spot { position, .. } => *position = place(*position),
            Shape::Triangle { corners, .. } => *corners = corners.map(&place),
            Shape::Directional { .. } => {}
        }
    }
    parts.camera = parts.camera.turned(place(parts.camera.position()), DQuat::IDENTITY);
    parts
}

/// A scene whose f32 coordinates have `far` m added, and the very same rounded scene brought back: its numbers are
/// exact.
fn baked(far: f64) -> [Stage; 2] {
    let add = |place: Vec3, far: f64| (place.as_dvec3() + far).as_vec3();
    let there = placed(read(DVec3::ZERO, 1.0).parts(), |place| add(place, far));
    let back = placed(there.clone(), |place| add(place, -far));
    [there, back].map(|parts| stage_with(parts, LeaveOut::No, Offset::SCALED))
}

#[test]
fn baked_coordinates_change_a_picture_as_much_as_rounding_them() {
    let here = sorted(&whole(read(DVec3::ZERO, 1.0)));
    // By distance: most of the difference to the scene as it was rounded, and to the scene itself.
    for (far, rendered, rounded) in [(1e3, 1e-4, 1e-4), (1e4, 1e-3, 1e-3), (1e5, 5e-3, 5e-3), (1e6, 0.03, 0.03)] {
        let [there, back] = baked(far).map(|stage| sorted(&stage));
        let ((own, own_pixels), (all, _)) = (difference(&back, &there), difference(&here, &there));
        println!(
            "{far:e} m: {own:e} of the mean to the rounded scene ({own_pixels} of the pixels), {all:e} to the scene"
        );
        assert!(own.abs() < rendered, "{far} m: {own} of the mean of the scene as it was rounded");
        assert!(all.abs() < rounded, "{far} m: {all} of the mean of the scene");
    }
}

/// Mean relative variance of each strategy that tells its probabilities, brought to one pick.
fn variances(stage: &Stage) -> Vec<(String, f64)> {
    let mut found = Vec::new();
    for info in Registry::standard().infos() {
        if info.claim != Claim::Unbiased {
            continue;
        }
        let strategy = Registry::standard().parse(info.name).expect("a name of the registry");
        // Its probabilities are another's in another unit of length.
        if !strategy.scale_free() {
            continue;
        }
        let sampler = strategy.build(BuildContext { stage, seed: 1 }).expect("a sampler");
        let mut counts = Vec::new();
        let known = |at| match quality(stage, sampler.as_ref(), at, &mut counts) {
            Finding::Known(quality) => Some(quality.variance),
            Finding::Dark | Finding::Unknown => None,
        };
        let variances: Vec<f64> = stage.receivers().iter().filter_map(known).collect();
        if !variances.is_empty() {
            found.push((info.name.to_owned(), Moments::of(variances).mean));
        }
    }
    found
}

#[test]
fn no_ranking_of_strategies_changes() {
    let here = variances(&whole(read(DVec3::ZERO, 1.0)));
    assert!(here.len() >= 5, "{here:?}");
    let [baked, _] = baked(1e6);
    let changed = [
        ("moved", whole(read(DVec3::new(1e6, -2e6, 3e3), 1.0)), 0.0),
        ("100 times as large", whole(read(DVec3::ZERO, 100.0)), 0.01),
        ("a hundredth as large", whole(read(DVec3::ZERO, 0.01)), 0.01),
        ("baked at 1,000 km", baked, 0.1),
    ];
    for (what, stage, tolerance) in changed {
        let there = variances(&stage);
        assert_eq!(here.len(), there.len(), "{what}");
        for ((name, a), (_, b)) in here.iter().zip(&there) {
            println!("{what}: {name} {a:.4} {b:.4}");
            assert!((a - b).abs() <= tolerance * a.max(*b).max(0.05), "{what}: {name} has {a}, then {b}");
        }
        for (i, (first, a)) in here.iter().enumerate() {
            for (j, (second, b)) in here.iter().enumerate() {
                // Nearer than that they are equal.
                if *a < b - 2.0 * tolerance * b.max(0.05) {
                    assert!(there[i].1 < there[j].1, "{what}: {first} and {second} changed places");
                }
            }
        }
    }
}
