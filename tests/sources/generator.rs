//! What the city generator promises: equal bytes everywhere, exact counts, the degeneracies and gaps of real cities.

use crate::common::digest;
use citylights::base::colour::luminance;
use citylights::scene::camera::Camera;
use citylights::scene::light::Shape;
use citylights::scene::{Parts, Scene};
use citylights::sources::city::{
    Beacons, Buildings, Bulbs, City, Floodlights, Grown, LampKind, Lamps, Moon, Shops, Signs, Traffic, Windows,
    generate,
};
use glam::{DVec3, Vec3};

/// A city with every part.
fn everything(lights: u64) -> City {
    City {
        lights,
        squares: 0.1,
        buildings: Some(Buildings::default()),
        lamps: Some(Lamps::default()),
        windows: Some(Windows::default()),
        shops: Some(Shops::default()),
        signs: Some(Signs::default()),
        traffic: Some(Traffic::default()),
        beacons: Some(Beacons { from: 25.0, ..Beacons::default() }),
        floodlights: Some(Floodlights::default()),
        bulbs: Some(Bulbs::default()),
        moon: Some(Moon::default()),
        ..City::default()
    }
}

fn grow(plan: &City, seed: u64) -> Grown {
    generate(plan, seed).expect("a plan within its ranges")
}

fn scene(grown: Grown) -> Scene {
    Scene::new(Parts {
        name: "test".into(),
        seed: 0,
        origin: DVec3::ZERO,
        lights: grown.lights,
        groups: grown.groups,
        surfaces: grown.surfaces,
        materials: grown.materials,
        camera: Camera::new(Vec3::Z, Vec3::new(0.0, 9.0, 1.0), 60.0, 16, 9).expect("a camera"),
        ev100: Some(4.0),
        notes: grown.notes,
    })
    .expect("a generated city is a valid scene")
}

fn group<'a>(grown: &'a Grown, name: &str) -> &'a [Shape] {
    let range = grown.groups.iter().find(|group| group.name == name).map_or(0..0, |group| group.range.clone());
    &grown.lights[range.start as usize..range.end as usize]
}

#[test]
fn one_and_two_threads_grow_the_same_bytes() {
    let plan = everything(8_000);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        pool.install(|| digest(&scene(grow(&plan, 42))))
    };
    assert_eq!(with(1), with(2));
    assert_ne!(digest(&scene(grow(&plan, 43))), with(1), "another seed must give another city");
}

#[test]
fn windows_make_the_number_of_lights_exact() {
    for lights in [1_000, 4_001, 10_000, 33_333] {
        let grown = grow(&everything(lights), 3);
        let missing = lights as usize - grown.lights.len();
        assert!(missing <= 1, "{} lights of {lights}: {:?}", grown.lights.len(), grown.notes);
        assert!(grown.notes.is_empty(), "{:?}", grown.notes);
    }
}

#[test]
fn a_number_of_lights_out_of_reach_is_noted() {
    let too_few_windows = City {
        buildings: Some(Buildings { height: 8.0, spread: 0.0, ..Buildings::default() }),
        windows: Some(Windows { pitch: 20.0, ..Windows::default() }),
        ..everything(10_000)
    };
    let too_many_lamps = City { lamps: Some(Lamps { spacing: 5.0, ..Lamps::default() }), ..everything(1_000) };
    for (plan, says) in [(too_few_windows, "every one of the"), (too_many_lamps, "no window is lit")] {
        let notes = grow(&plan, 1).notes;
        assert!(notes.iter().any(|note| note.contains(says)), "{notes:?} should say {says}");
    }
    let without = grow(&City { windows: None, ..everything(2_000) }, 1);
    let note = format!("the city has no windows: {} lights on the extent of 2000", without.lights.len());
    assert_eq!(without.notes, [note]);
}

#[test]
fn lights_keep_their_density() {
    let grown = grow(&everything(40_000), 9);
    let corners = || grown.surfaces.iter().flat_map(|surface| surface.corners);
    let size = corners().fold(Vec3::NEG_INFINITY, Vec3::max) - corners().fold(Vec3::INFINITY, Vec3::min);
    let density = grown.lights.len() as f64 / f64::from(size.x * size.y / 1e6);
    assert!((density / 10_600.0 - 1.0).abs() < 0.1, "{density} lights per km^2");
}

#[test]
fn street_lamps_of_a_row_are_exactly_collinear() {
    let grown = grow(&everything(10_000), 5);
    let lamps: Vec<Vec3> = group(&grown, "street lamps")
        .iter()
        .map(|lamp| match lamp {
            Shape::Spot { position, axis, cos_outer, .. } => {
                assert_eq!(*axis, Vec3::NEG_Z);
                assert!(*cos_outer > 0.0, "a full cut-off lamp shines below the horizon only");
                *position
            }
            other => panic!("a street lamp is a spot, not {other:?}"),
        })
        .collect();
    let next_in_row = |a: Vec3, b: Vec3| b - a == Vec3::X * 30.0 || b - a == Vec3::Y * 30.0;
    let rows = 1 + lamps.windows(2).filter(|pair| !next_in_row(pair[0], pair[1])).count();
    // 9 or so streets each way, one or two rows each.
    assert!(lamps.len() > 300 && rows <= 44, "{} lamps in {rows} rows", lamps.len());
}

#[test]
fn windows_are_coplanar_and_stand_proud_of_their_wall() {
    let grown = grow(&everything(4_000), 8);
    let windows = group(&grown, "windows");
    assert!(windows.len() > 1_000);
    let mut powers: Vec<u32> = Vec::new();
    for window in windows {
        let Shape::Triangle { corners: [a, b, c], radiance } = *window else { panic!("{window:?}") };
        let normal = (b - a).cross(c - a).normalize();
        let axis = usize::from(normal.x.abs() < 0.5);
        assert_eq!(normal[axis].abs(), 1.0, "a window stands upright on an axis: {window:?}");
        assert!(a[axis] == b[axis] && b[axis] == c[axis], "corners in one plane: {window:?}");
        let centre = (a + b + c) / 3.0;
        let walled = |depth: f32| grown.solids.iter().any(|solid| solid.contains(centre - normal * depth));
        assert!(!walled(0.05) && walled(0.2), "5 to 20 cm before its wall: {window:?}");
        assert!(!walled(-0.5), "looks away from its wall: {window:?}");
        powers.push(radiance.x.to_bits());
    }
    powers.sort_unstable();
    powers.dedup();
    assert!(powers.len() <= 24, "{} powers: ties are wanted", powers.len());
}

#[test]
fn signs_come_back_to_back() {
    let grown = grow(&everything(4_000), 8);
    let signs: Vec<[Vec3; 3]> = group(&grown, "signs")
        .iter()
        .map(|sign| match sign {
            Shape::Triangle { corners, .. } => *corners,
            other => panic!("{other:?}"),
        })
        .collect();
    let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).normalize();
    let middle = |i: usize| 0.25 * (signs[i][0] + signs[i][1] + signs[i][2] + signs[i + 1][2]);
    let blades = (0..signs.len() - 3)
        .filter(|&i| normal(signs[i]) == -normal(signs[i + 2]))
        .filter(|&i| (middle(i) - middle(i + 2)).length() < 0.07)
        .count();
    assert!(blades > 20, "{blades} blades");
}

#[test]
fn spots_give_the_lumens_that_were_asked_for() {
    let lamps = Lamps { flux: [7_000.0; 2], kelvin: [2_200.0; 2], inner: 25.0, outer: 70.0, ..Lamps::default() };
    let traffic = Traffic { headlight: 1_100.0, ..Traffic::default() };
    let grown = grow(&City { lamps: Some(lamps), traffic: Some(traffic), ..everything(1_000) }, 2);
    for (name, lumens) in [("street lamps", 7_000.0), ("headlights", 1_100.0)] {
        let Shape::Spot { intensity, cos_inner, cos_outer, .. } = group(&grown, name)[0] else { panic!("{name}") };
        // The profile of KHR_lights_punctual, integrated over directions by the midpoint rule in the cosine.
        let steps = 200_000;
        let integral: f64 = (0..steps)
            .map(|i| {
                let cos = (f64::from(i) + 0.5) / f64::from(steps);
                let (inner, outer) = (f64::from(cos_inner), f64::from(cos_outer));
                ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2)
            })
            .sum::<f64>()
            / f64::from(steps);
        let flux = 2.0 * std::f64::consts::PI * integral * f64::from(luminance(intensity));
        assert!((flux / lumens - 1.0).abs() < 1e-4, "{name}: {flux} lm of {lumens}");
    }
    let bare = Lamps { kind: LampKind::Point, flux: [5_000.0; 2], ..Lamps::default() };
    let grown = grow(&City { lamps: Some(bare), ..everything(1_000) }, 2);
    let Shape::Point { intensity, .. } = group(&grown, "street lamps")[0] else { panic!("bare lamps are points") };
    let flux = 4.0 * std::f64::consts::PI * f64::from(luminance(intensity));
    assert!((flux / 5_000.0 - 1.0).abs() < 1e-4, "{flux} lm");
}

#[test]
fn every_part_can_be_left_out_and_leaves_the_others_alone() {
    type Leave = fn(&mut City);
    let parts: [(&[&str], Leave); 9] = [
        (&["street lamps"], |plan| plan.lamps = None),
        (&["shop windows"], |plan| plan.shops = None),
        (&["signs"], |plan| plan.signs = None),
        (&["headlights", "tail lights"], |plan| plan.traffic = None),
        (&["beacons"], |plan| plan.beacons = None),
        (&["floodlights"], |plan| plan.floodlights = None),
        (&["bulbs"], |plan| plan.bulbs = None),
        (&["moon"], |plan| plan.moon = None),
        (&["windows"], |plan| plan.windows = None),
    ];
    let all = grow(&everything(6_000), 4);
    for (names, leave) in parts {
        let mut plan = everything(6_000);
        leave(&mut plan);
        let less = grow(&plan, 4);
        for name in all.groups.iter().map(|group| group.name.as_str()) {
            if names.contains(&name) {
                assert!(!group(&all, name).is_empty(), "the full city has {name}");
                assert!(group(&less, name).is_empty(), "{name} was left out");
            } else if name != "windows" {
                assert_eq!(group(&less, name), group(&all, name), "{name} changed without {names:?}");
            }
        }
        assert_eq!(less.surfaces, all.surfaces);
    }
    let bare = grow(&City::default(), 4);
    assert!(bare.lights.is_empty() && bare.solids.is_empty() && !bare.surfaces.is_empty());
    let no_buildings = grow(&City { buildings: None, ..everything(6_000) }, 4);
    assert!(group(&no_buildings, "windows").is_empty() && !group(&no_buildings, "floodlights").is_empty());
}

#[test]
fn emitters_stand_inside_no_building_and_nowhere_twice() {
    let grown = grow(&everything(6_000), 6);
    let mut places = Vec::new();
    for light in &grown.lights {
        let corners = match *light {
            Shape::Point { position, .. } | Shape::Spot { position, .. } => [position; 3],
            Shape::Triangle { corners, .. } => corners,
            Shape::Directional { .. } => continue,
        };
        let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        for point in corners.into_iter().chain([centre]) {
            let around = grown.solids.iter().find(|solid| solid.contains(point));
            assert!(around.is_none(), "{light:?} stands in {around:?}");
            assert!(point.z > 0.15, "{light:?} is under the pavement");
        }
        places.push(centre.to_array().map(f32::to_bits));
    }
    let all = places.len();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), all, "lights at the very same place break tree builders");
}

#[test]
fn surfaces_of_a_building_look_outwards() {
    let grown = grow(&everything(1_000), 6);
    let street_or_kerb = ["asphalt", "pavement", "kerb"];
    let mut walls = 0;
    for surface in &grown.surfaces {
        if street_or_kerb.contains(&grown.materials[surface.material as usize].name.as_str()) {
            continue;
        }
        let [a, b, c] = surface.corners;
        let behind = (a + b + c) / 3.0 - 0.01 * (b - a).cross(c - a).normalize();
        assert!(grown.solids.iter().any(|solid| solid.contains(behind)), "nothing is behind {surface:?}");
        walls += 1;
    }
    assert_eq!(walls, 10 * grown.solids.len());
}

#[test]
fn a_million_lights_grow_in_about_ten_times_the_time_of_a_hundred_thousand() {
    use crate::common::{IN_PROPORTION, times_as_long};
    let grown = |lights: u64| {
        let grown = grow(&everything(lights), 13);
        assert!(lights - grown.lights.len() as u64 <= 1, "{} lights", grown.lights.len());
    };
    let ratio = times_as_long(|| grown(1_000_000), || grown(100_000));
    assert!(ratio < IN_PROPORTION, "{ratio} times as long");
}

#[test]
fn plans_made_in_code_are_checked() {
    let small_lots = Buildings { lot: 12.0, ..Buildings::default() };
    let towers = Buildings { height: 200.0, lot: 15.0, ..Buildings::default() };
    let bad: [City; 6] = [
        City { lights: 1_000_000_000_000, ..City::default() },
        City { block: [120.0, 80.0], ..City::default() },
        City { lights: 10_000_000, density: 100.0, ..City::default() },
        City { lights: 1_700_000, density: 100.0, block: [400.0; 2], buildings: Some(small_lots), ..City::default() },
        City { lights: 10_000_000, buildings: Some(towers), ..City::default() },
        City { lamps: Some(Lamps { spacing: f64::NAN, ..Lamps::default() }), ..City::default() },
    ];
    for plan in bad {
        let error = generate(&plan, 1).expect_err("a plan outside its ranges");
        assert!(error.to_string().starts_with("city"), "{error}");
    }
    // Ten times the shipped megacity is within the limits; only checked here, for it takes a while to make.
    let buildings = Buildings { height: 24.0, spread: 0.5, ..Buildings::default() };
    everything(10_000_000).check().expect("ten million lights");
    City { street: [16.0, 28.0], buildings: Some(buildings), ..everything(10_000_000) }
        .check()
        .expect("ten megacities");
}
