//! Promise: each chapter of the lecture has one command that makes its labelled picture, and `docs/LECTURE.md` says which.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use predicates::str::contains;
use std::fs;
use std::path::{Path, PathBuf};

/// Names of the chapters, and words that their pictures hold.
const CHAPTERS: [(&str, &[&str]); 9] = [
    ("shadow-rays", &["1  Shadow rays", "No shadow test", "that end at the light: right", "Early outs save"]),
    ("offsets", &["2  Where", "No offset, near the origin", "pushed by 1e-4 m, 10 km away", "pixels are wrong"]),
    ("area-lights", &["3  Area lights", "Very small: 5 cm", "Large: 3 m", "Penumbra:", "irradiance, lx"]),
    ("points", &["4  Points", "Without the square root: wrong", "Uniform by solid angle", "of 256 points"]),
    ("solid-angle", &["5  Solid angle", "solid angle, sr", "printed formula in f32", "distance, m"]),
    ("samples", &["6  How many", "1 ray a pixel", "1,000 rays a pixel", "RMSE in the penumbra", "1 / √n"]),
    ("many-lights", &["7  Many lights", "How many lights carry 90 %", "Median:"]),
    ("range", &["8  Range", "lights in range", "of all light is lost", "display step"]),
    ("picks", &["9  Picking", "uniform: any light alike", "power: by flux", "exact share of the light"]),
];

/// The program, in the root of the repository.
fn citylights(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments);
    command
}

/// The picture of a chapter at a size that takes no time.
fn picture(chapter: &str, options: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("picture.svg");
    let mut command = citylights(&["lecture", chapter, "--size", "40x27", "--output"]);
    command.arg(&file).args(options).assert().success();
    fs::read_to_string(&file).expect("a picture")
}

/// All that is written in it, as it reads.
fn words(svg: &str) -> String {
    let lines = svg.lines().filter(|line| !line.starts_with('<'));
    lines.collect::<Vec<_>>().join(" ").replace("&apos;", "'").replace("&lt;", "<")
}

#[test]
fn every_chapter_writes_a_picture_with_its_labels_and_pixels() {
    for (chapter, labels) in CHAPTERS {
        let svg = picture(chapter, &[]);
        let words = words(&svg);
        for label in labels {
            assert!(words.contains(label), "{chapter}: `{label}` is not in: {words}");
        }
        assert!(!words.contains("NaN") && !words.contains("inf "), "{chapter}: {words}");
        let images: Vec<&str> = svg.split("data:image/png;base64,").skip(1).collect();
        assert_eq!(images.is_empty(), chapter == "points", "{chapter}");
        for image in images {
            let bytes = STANDARD.decode(image.split('"').next().expect("a closing quote")).expect("base64");
            let shown = image::load_from_memory(&bytes).expect("a PNG");
            assert!(
                shown.width() >= 40 && shown.to_rgb8().pixels().any(|texel| texel != shown.to_rgb8().get_pixel(0, 0))
            );
        }
    }
}

#[test]
fn a_number_names_a_chapter_and_the_same_seed_gives_the_same_bytes() {
    let first = picture("samples", &["--threads", "1"]);
    assert!(first == picture("6", &["--threads", "2"]));
    assert!(first != picture("6", &["--seed", "2"]));
}

#[test]
fn without_an_offset_pixels_are_wrong_and_with_the_default_none() {
    let words = words(&picture("offsets", &[]));
    // "25,861 of 32,400 pixels are wrong"
    let number = |at: usize| words[..at].split_whitespace().rev().nth(2).expect("a number").replace(',', "");
    let places = words.match_indices(" pixels are wrong").map(|(at, _)| at);
    let wrong: Vec<u32> = places.map(|at| number(at).parse().expect("a number")).collect();
    let [none, near, far, scaled] = wrong[..] else { panic!("{wrong:?}") };
    assert!(none > 300 && far > 300, "{wrong:?}");
    assert_eq!([near, scaled], [0, 0]);
}

#[test]
fn chapters_are_listed_and_unknown_ones_refused_with_near_ones() {
    for arguments in [&["lecture"][..], &["list", "lecture"]] {
        let listed = citylights(arguments).assert().success();
        CHAPTERS.iter().fold(listed, |listed, (name, _)| listed.stdout(contains(*name)));
    }
    citylights(&["list", "lecture", "--json"]).assert().success().stdout(contains("\"number\": 9"));
    let refused = |arguments: &[&str], said: &str| {
        citylights(arguments).assert().code(2).stdout("").stderr(contains(said));
    };
    refused(&["lecture", "ofsets"], "near it: offsets");
    refused(&["lecture", "10"], "unknown chapter `10`");
    refused(&["lecture", "offsets", "-o", "x.png"], ".svg");
    refused(&["lecture", "offsets", "-o", "no/such/folder/x.svg"], "no/such/folder");
    refused(&["lecture", "offsets", "--size", "0x9"], "0x9");
}

#[test]
fn a_scene_without_what_a_chapter_shows_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("x.svg");
    let refused = |arguments: &[&str], said: &str| {
        citylights(arguments).args(["--size", "32x18", "-o"]).arg(&file).assert().code(2).stderr(contains(said));
        assert!(!file.exists());
    };
    for chapter in ["area-lights", "points", "solid-angle", "samples"] {
        refused(&["lecture", chapter, "--scene", "scenes/lecture/lamps.toml"], "area light");
    }
    refused(&["lecture", "offsets", "--scene", "scenes/first-night.toml"], "give a smaller scene");
    refused(&["lecture", "picks", "--pixel", "32,0"], "outside");
    refused(&["lecture", "picks", "--pixel", "16,0"], "sky");
    refused(&["lecture", "range", "--scene", "scenes/nowhere.toml"], "nowhere.toml");
}

#[test]
fn outside_the_repository_a_scene_must_be_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.current_dir(&folder).args(["lecture", "shadow-rays"]).assert().code(2).stderr(contains("--scene"));
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lecture/lamps.toml");
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.current_dir(&folder).args(["lecture", "shadow-rays", "--size", "32x18", "--scene"]).arg(scene);
    command.assert().success();
    assert!(folder.path().join("lecture/01-shadow-rays.svg").is_file());
}

#[test]
fn the_acne_of_no_offset_can_be_rendered() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |offset: &str| folder.path().join(format!("{offset}.png"));
    let mean = |offset: &str| -> f64 {
        let arguments = ["render", "scenes/lecture/lamps.toml", "-s", "all", "--spp", "1", "--resolution", "64x36"];
        citylights(&arguments).args(["--offset", offset, "-o"]).arg(file(offset)).assert().success();
        let picture = image::open(file(offset)).expect("a picture").to_luma8();
        picture.pixels().map(|texel| f64::from(texel.0[0])).sum::<f64>()
    };
    assert!(mean("none") < 0.5 * mean("scaled"));
}

/// The documents' folder.
fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

#[test]
fn the_document_has_every_chapter_its_command_and_its_picture() {
    let text = fs::read_to_string(docs().join("LECTURE.md")).expect("the document");
    let mut all = 0;
    for (number, (name, labels)) in (1..).zip(CHAPTERS) {
        let command = format!("cargo run --release -- lecture {name}\n");
        assert!(text.contains(&command), "{command}");
        let file = format!("lecture/{number:02}-{name}.svg");
        assert!(text.contains(&format!("({file})")), "{file} is not shown");
        let svg = fs::read_to_string(docs().join(&file)).expect("a picture");
        assert!(svg.len() <= 250_000, "{file}: {} bytes", svg.len());
        all += svg.len();
        let words = words(&svg);
        labels.iter().for_each(|label| assert!(words.contains(label), "{file}: {label}"));
    }
    assert!(all <= 1_500_000, "{all} bytes");
}
