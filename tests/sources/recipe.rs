//! What a recipe promises: every mistake is told with file, line, field and what would be right; nothing panics.
#![cfg(feature = "recipe")]

use crate::common::digest;
use citylights::base::error::Error;
use citylights::scene::Scene;
use citylights::scene::cutoff::{Cutoff, Transfer};
use citylights::scene::light::{Kind, Light, Shape};
use citylights::sources::Overrides;
use citylights::sources::recipe::{load, parse};
use citylights::strategy::{BuildContext, Registry};
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::{DVec3, Vec3};
use std::path::Path;

/// A small recipe with every table; line numbers of the cases below count in it.
const GOOD: &str = r#"name = "corner"
seed = 5
version = 1
ev100 = 4

[camera]
position = [1, -60, 2]
target = [0, 40, 8]
resolution = [32, 18]

[city]
lights = 700
[city.buildings]
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

[ground]
size = [900, 800]
height = -0.25
material = "lawn"

[materials.lawn]
albedo = [0.05, 0.1, 0.04]

[[box]]
low = [-2, 300, 0]
high = [2, 304, 3]
material = "brick"

[[quad]]
corners = [[0, 310, 0], [4, 310, 0], [4, 310, 4], [0, 310, 4]]
material = "plaster"

[[triangle]]
corners = [[0, 320, 0], [4, 320, 0], [4, 320, 4]]
material = "roof"

[[light]]
kind = "point"
position = [0, 300, 5]
flux = 1000
kelvin = 2700

[[light]]
kind = "spot"
position = [0, 305, 5]
target = [0, 305, 0]
inner = 10
outer = 40
intensity = 800
colour = [1, 0.5, 0.25]

[[light]]
kind = "directional"
towards = [0, 0.5, 1]
irradiance = 0.1

[[light]]
kind = "triangle"
corners = [[0, 330, 0], [1, 330, 0], [0, 330, 1]]
radiance = 30

[[bulbs]]
size = [20, 20]
centre = [0, 340]
"#;

/// A recipe without a city; the camera looks at a plain ground.
const PLAIN: &str = r#"name = "plain"
seed = 1
version = 1
[camera]
position = [0, -5, 2]
target = [0, 0, 0]
[ground]
size = 20
material = "asphalt"
"#;

fn read(text: &str) -> Result<Scene, Error> {
    parse(text, Path::new("test.toml"), &Overrides::default())
}

/// Asserts that a text is refused at a line and field, with some words.
#[track_caller]
fn refused(text: &str, at: Option<usize>, path: &str, words: &[&str]) {
    match read(text) {
        Err(Error::Input { line, field, message, file }) => {
            let told = format!("{}:{line:?}: `{field}`: {message}", file.display());
            assert_eq!(file, Path::new("test.toml"));
            assert_eq!(line, at, "{told}");
            assert_eq!(field, path, "{told}");
            words.iter().for_each(|word| assert!(message.contains(word), "{told} should say {word}"));
        }
        other => panic!("an input error was expected, not {other:?}"),
    }
}

/// Replaces one line's text and asserts how the result is refused: the line of the error is that of the new text.
#[track_caller]
fn wrong(base: &str, old: &str, new: &str, path: &str, words: &[&str]) {
    assert_eq!(base.matches(old).count(), 1, "`{old}` must stand in the recipe once");
    let text = base.replace(old, new);
    let line = text.lines().position(|line| line == new).map(|i| i + 1);
    refused(&text, line, path, words);
}

#[test]
fn a_recipe_with_every_table_is_read() {
    let scene = read(GOOD).expect("a good recipe");
    assert_eq!((scene.name(), scene.seed(), scene.ev100()), ("corner", 5, Some(4.0)));
    assert_eq!(scene.camera().resolution(), (32, 18));
    let group = |name: &str| {
        let found = scene.groups().iter().find(|group| group.name == name);
        found.map_or_else(|| panic!("{name} in {:?}", scene.groups()), |group| group.range.clone())
    };
    let placed = group("placed lights");
    // The generated city comes first and holds the number that was asked for.
    assert!((699..=700).contains(&placed.start), "{placed:?}");
    assert_eq!(placed.len(), 4);
    assert_eq!(group("strings of bulbs").len(), 10);
    let at = |i: u32| scene.lights()[(placed.start + i) as usize];
    assert!((citylights::base::colour::luminance(at(0).flux(1.0)) - 1000.0).abs() < 0.01);
    let Shape::Spot { intensity, axis, .. } = at(1).shape() else { panic!("{:?}", at(1)) };
    assert_eq!((intensity, axis), (Vec3::new(800.0, 400.0, 200.0), Vec3::NEG_Z));
    assert_eq!((at(2).kind(), at(3).kind()), (Kind::Directional, Kind::Triangle));
    assert_eq!(at(3).area(), 0.5);
    assert!(scene.materials().iter().any(|material| material.name == "lawn" && !material.street));
}

#[test]
fn overrides_stand_in_for_the_recipes_words() {
    let overrides = Overrides { seed: Some(9), resolution: Some((8, 4)), ev100: Some(7.0), ..Overrides::default() };
    let scene = parse(GOOD, Path::new("test.toml"), &overrides).expect("a good recipe");
    assert_eq!((scene.seed(), scene.camera().resolution(), scene.ev100()), (9, (8, 4), Some(7.0)));
    assert_ne!(scene.lights(), read(GOOD).expect("a good recipe").lights());
}

#[test]
fn moving_a_recipe_by_a_thousand_kilometres_moves_only_the_origin() {
    let here = read(GOOD).expect("a good recipe");
    let there = read(&format!("origin = [1e6, -1e6, 250.5]\n{GOOD}")).expect("a good recipe");
    assert_eq!(digest(&here), digest(&there));
    assert_eq!(there.origin() - here.origin(), DVec3::new(1e6, -1e6, 250.5));
}

#[test]
fn surfaces_far_from_the_frame_keep_their_digits() {
    let far = PLAIN
        .replace("[0, -5, 2]", "[1000000, -5, 2]")
        .replace("target = [0, 0, 0]", "target = [1000000, 0, 0]")
        .replace("size = 20", "size = 20\ncentre = [1000000, 0]");
    let (near, far) = (read(PLAIN).expect("near"), read(&far).expect("far"));
    assert_eq!(far.origin(), DVec3::new(1e6, 0.0, 0.0));
    assert_eq!(digest(&near), digest(&far));
}

#[test]
fn no_lights_are_a_note_and_not_an_error() {
    let scene = read(PLAIN).expect("a plain recipe");
    assert!(scene.lights().is_empty());
    assert!(scene.notes().iter().any(|note| note.contains("no lights")), "{:?}", scene.notes());
    assert_eq!(scene.surfaces().len(), 2);
}

#[test]
fn unknown_names_are_refused_with_the_near_ones() {
    wrong(GOOD, "spacing = 25", "spacin = 25", "city.lamps.spacin", &["unknown field", "spacing"]);
    wrong(GOOD, "[city.lamps]", "[city.lampss]", "city.lampss", &["lamps"]);
    wrong(GOOD, "[ground]", "[grund]", "grund", &["ground"]);
    wrong(GOOD, "kind = \"directional\"", "kind = \"directionel\"", "light[2].kind", &["directional"]);
    wrong(GOOD, "kind = \"directional\"", "kind = \"area\"", "light[2].kind", &["one of point, spot"]);
    wrong(GOOD, "intensity = 800", "radiance = 800", "light[1].radiance", &["unknown field"]);
    wrong(GOOD, "material = \"lawn\"", "material = \"law\"", "ground.material", &["lawn"]);
    wrong(GOOD, "centre = [0, 340]", "center = [0, 340]", "bulbs[0].center", &["centre"]);
}

#[test]
fn wrong_types_and_units_are_refused() {
    wrong(GOOD, "spacing = 25", "spacing = \"8 m\"", "city.lamps.spacing", &["\"8 m\"", "5 and 500", "metres"]);
    wrong(GOOD, "lights = 700", "lights = 700.5", "city.lights", &["700.5", "whole number"]);
    wrong(GOOD, "lights = 700", "lights = [1]", "city.lights", &["whole number"]);
    wrong(GOOD, "target = [0, 40, 8]", "target = [0, 40]", "camera.target", &["3 numbers"]);
    wrong(GOOD, "position = [1, -60, 2]", "position = 1", "camera.position", &["3 numbers", "metres"]);
    wrong(GOOD, "name = \"corner\"", "name = 12", "name", &["in quotes"]);
    wrong(GOOD, "albedo = [0.05, 0.1, 0.04]", "albedo = [0.05, 1.1, 0.04]", "materials.lawn.albedo", &["0 and 1"]);
    wrong(GOOD, "ev100 = 4", "ev100 = 2026-01-01", "ev100", &["date"]);
    wrong(PLAIN, "[ground]", "[[ground]]", "ground", &["[ground]"]);
    wrong(GOOD, "[[bulbs]]", "[bulbs]", "bulbs", &["[[bulbs]]"]);
    refused("name = ", Some(1), "", &["not TOML"]);
    refused("name = \"a\"\nname = \"b\"", Some(2), "", &["not TOML", "duplicate"]);
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    wrong(PLAIN, "size = 20", "size = -20", "ground.size", &["-20", "metres"]);
    wrong(GOOD, "spacing = 25", "spacing = -25", "city.lamps.spacing", &["5 and 500"]);
    wrong(GOOD, "spacing = 25", "spacing = nan", "city.lamps.spacing", &["nan"]);
    wrong(GOOD, "spacing = 25", "spacing = inf", "city.lamps.spacing", &["inf"]);
    wrong(GOOD, "position = [1, -60, 2]", "position = [nan, 0, 0]", "camera.position", &["nan"]);
    wrong(GOOD, "radiance = [5, 50]", "radiance = [50, 5]", "city.windows.radiance", &["[least, greatest]"]);
    wrong(GOOD, "high = [2, 304, 3]", "high = [2, 300, 3]", "box[0].high", &["exceed"]);
    wrong(GOOD, "inner = 10", "inner = 40", "light[1].inner", &["below the outer, 40"]);
    wrong(GOOD, "inner = 10", "inner = 39.99999999", "light[1].inner", &["below the outer"]);
    wrong(GOOD, "target = [0, 305, 0]", "target = [0, 305, 5]", "light[1].target", &["no length"]);
    wrong(GOOD, "resolution = [32, 18]", "resolution = [0, 18]", "camera.resolution", &["pixels"]);
    wrong(GOOD, "resolution = [32, 18]", "resolution = [1.5, 18]", "camera.resolution", &["whole numbers"]);
    wrong(GOOD, "target = [0, 40, 8]", "target = [1, -60, 2]", "camera.target", &["0.01 metres"]);
    let zero = Overrides { resolution: Some((0, 9)), ..Overrides::default() };
    let error = parse(GOOD, Path::new("test.toml"), &zero).expect_err("a film without pixels");
    assert!(error.to_string().contains("0 x 9"), "{error}");
}

#[test]
fn enormous_numbers_are_refused_with_the_allowed_range() {
    for lights in ["1_000_000_000_000", "1e12", "99999999999999999999999999", "0", "-5"] {
        wrong(GOOD, "lights = 700", &format!("lights = {lights}"), "city.lights", &["1 and 10000000"]);
    }
    let many: String = (0..2_000).map(|i| format!("[materials.m{i}]\nalbedo = [0, 0, 0]\n")).collect();
    refused(&format!("{PLAIN}{many}"), Some(10), "materials", &["2000", "1000"]);
    // Ten million lights at the least density: ten thousand square kilometres.
    let sparse = "lights = 10_000_000\ndensity = 100\nblock = [40, 60]";
    let text = GOOD.replace("lights = 700", sparse);
    refused(&text, Some(13), "city.density", &["100000"]);
    wrong(GOOD, "size = [20, 20]", "size = [1e5, 1e5]", "bulbs[0].size", &["10000000"]);
    let crowded = GOOD.replace("lights = 700", "lights = 5_000_000").replace("spacing = 25", "spacing = 5");
    refused(
        &crowded.replace("[city.signs]", "[city.signs]\nper_100m = 40"),
        Some(12),
        "city.lights",
        &["at most 20000000"],
    );
}

#[test]
fn a_city_of_too_many_buildings_is_refused() {
    // 92,000 blocks, few enough, with 128 lots each.
    let crowded = "lights = 1.7e6\ndensity = 100\nblock = 400";
    let text = GOOD.replace("lights = 700", crowded).replace("[city.buildings]", "[city.buildings]\nlot = 12");
    refused(&text, Some(12), "city.lights", &["boxes of buildings", "at most 4000000", "a longer `lot`"]);
}

#[test]
fn names_that_would_break_a_table_or_a_path_are_refused() {
    let named = |name: &str| GOOD.replacen("corner", name, 1);
    let longest = "é".repeat(64);
    for name in ["a", "first-night 2.5_b", "Zürich", "東京 (夜)", &longest] {
        assert_eq!(read(&named(name)).expect("a good name").name(), name);
    }
    let asked = ["1 to 64 printable", "without <"];
    for name in ["", " ", "a\\nb", "a\\tb", "a\\u0000", "a\\u202eb", "a\\u00a0b", "a\\u2028b", "\\\\", "a\\\"b"] {
        refused(&named(name), Some(1), "name", &asked);
    }
    for name in ["<b>", "a|b", "../a", "it's", "a,b", "`a`"] {
        refused(&named(name), Some(1), "name", &asked);
    }
    refused(&named(&"x".repeat(300)), Some(1), "name", &["300 characters", "1 to 64"]);
}

#[test]
fn cones_too_narrow_for_f32_are_refused() {
    wrong(GOOD, "outer = 40", "outer = 0.49", "light[1].outer", &["0.5 and 90", "degrees"]);
    wrong(GOOD, "inner = 10", "inner = 39.95", "light[1].inner", &["at least 0.1 below"]);
    for (inner, outer) in [("39.9", "40"), ("0", "0.5"), ("0.4", "0.5"), ("0.7", "0.8"), ("89.9", "90")] {
        let text = GOOD.replace("inner = 10", &format!("inner = {inner}"));
        read(&text.replace("outer = 40", &format!("outer = {outer}"))).expect("cones 0.1 degrees apart");
    }
}

#[test]
fn influence_ends_at_twice_the_scenes_diameter() {
    let sun = "[[light]]\nkind = \"triangle\"\ncorners = [[0, 0, 9], [2e6, 0, 9], [0, 2e6, 9]]\nradiance = 1e15\n";
    let lamp = "[[light]]\nkind = \"point\"\nposition = [0, 0, 5]\nintensity = 1\ncolour = [0, 1, 0]\n";
    for ev100 in [-60.0, -1e3, 1e3] {
        let overrides = Overrides { ev100: Some(ev100), ..Overrides::default() };
        let scene =
            parse(&format!("{PLAIN}{sun}{lamp}"), Path::new("test.toml"), &overrides).expect("extreme, but legal");
        let cutoff = Cutoff::new(&scene, 0.5, Transfer::Linear);
        let volume = |light: &Light| cutoff.volume(light).expect("a local light");
        for volume in scene.lights().iter().map(volume) {
            assert!(volume.radius2.sqrt() <= 4.0 * scene.radius() * 1.000_001, "{volume:?}");
            let (low, high) = volume.bounds();
            assert!(low.is_finite() && high.is_finite(), "{low}..{high}");
            let lit = scene
                .surfaces()
                .iter()
                .flat_map(|s| s.corners)
                .all(|corner| corner.distance_squared(volume.centre) <= volume.radius2);
            assert!(lit || ev100 > 0.0, "all of the scene is in range of {volume:?}");
        }
        let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
        for name in ["influence", "influence-pick", "influence-tail"] {
            let strategy = Registry::standard().parse(name).expect("a strategy");
            let built = strategy.build(BuildContext { stage: &stage, seed: 1 });
            if let Err(error) = built {
                panic!("{name} at EV100 {ev100}: {error}");
            }
        }
    }
}

#[test]
fn what_is_missing_is_named() {
    refused("", None, "", &["empty"]);
    refused(" \n\t\n", None, "", &["empty"]);
    refused("name = \"a\"", None, "version", &["missing"]);
    refused("version = 2", Some(1), "version", &["version = 1"]);
    wrong(GOOD, "version = 1", "version = 3", "version", &["version 1"]);
    refused(&GOOD.replace("name = \"corner\"\n", ""), None, "name", &["missing"]);
    refused(&GOOD.replace("target = [0, 40, 8]\n", ""), Some(6), "camera.target", &["missing", "metres"]);
    refused(&GOOD.replace("flux = 1000\n", ""), Some(48), "light[0].flux", &["`intensity`"]);
    let no_camera = PLAIN.replace("[camera]\nposition = [0, -5, 2]\ntarget = [0, 0, 0]\n", "");
    refused(&no_camera, None, "camera", &["[camera]"]);
    let no_surfaces = PLAIN.replace("[ground]\nsize = 20\nmaterial = \"asphalt\"\n", "");
    refused(&no_surfaces, None, "", &["no surfaces", "add a ground"]);
}

#[test]
fn a_camera_in_a_solid_is_refused() {
    wrong(GOOD, "position = [1, -60, 2]", "position = [0, 302, 1]", "camera.position", &["box[0]", "black"]);
    wrong(GOOD, "position = [1, -60, 2]", "position = [20, 20, 3]", "camera.position", &["building", "move it out"]);
}

#[test]
fn files_that_cannot_be_read_are_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = load(&folder.path().join("none.toml"), &Overrides::default()).expect_err("no such file");
    assert!(missing.to_string().contains("none.toml"), "{missing}");
    let latin = folder.path().join("latin.toml");
    std::fs::write(&latin, b"name = 'a'\nseed = 1 # caf\xe9\n").expect("write");
    let error = load(&latin, &Overrides::default()).expect_err("not UTF-8");
    assert!(error.to_string().contains("latin.toml:2: is not UTF-8"), "{error}");
    assert!(load(folder.path(), &Overrides::default()).is_err(), "a folder is not a recipe");
}
