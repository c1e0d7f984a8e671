//! Promise: what can be measured is, and what cannot is said instead of ranked.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use predicates::str::contains;
use serde_json::Value;
use std::fs;
use std::path::Path;

const LAMP: &str = include_str!("../data/lamp.toml");

/// A comparison of a scene, with its results in `folder`.
fn compare(folder: &Path, scene: &str) -> Command {
    let file = folder.join("scene.toml");
    fs::write(&file, scene).expect("written");
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.arg("compare").arg(file).args(["--budget", "2", "--repeats", "3", "--threads=1", "-s"]);
    command.arg("null,all,uniform,power").arg("--out").arg(folder.join("out")).arg("--cache").arg(folder.join("cache"));
    command
}

#[test]
fn a_scene_that_nothing_lights_is_not_ranked() {
    let head = LAMP.split("[[light]]").next().expect("a head");
    let lamp = |z: f32, candela: f32| {
        format!("{head}[[light]]\nkind = \"point\"\nposition = [0.0, 0.0, {z:?}]\nintensity = {candela:?}\n")
    };
    let sky = LAMP.replace("target = [0.0, 0.0, 0.0]", "target = [0.0, -7.9, 9.0]");
    assert!(sky != LAMP);
    for (what, scene, why) in [
        ("no lights", head.to_owned(), "the scene has no lights"),
        ("a lamp of 0 cd", lamp(6.0, 0.0), "none of 1 lights reaches any of the"),
        ("a lamp below the ground", lamp(-3.0, 100.0), "none of 1 lights reaches any of the"),
        ("a camera at the sky", sky, "the camera sees no surface"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let said = format!("nothing can be measured: {why}");
        compare(folder.path(), &scene).assert().code(1).stdout(contains("not run, see below")).stderr(contains(said));
        let rows = fs::read_to_string(folder.path().join("out/runs.csv")).expect("rows");
        assert_eq!(rows.lines().count(), 1, "{what} is ranked: {rows}");
    }
}

#[test]
fn an_emitter_a_hundred_times_as_wide_as_it_is_high_is_measured() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = include_str!("../data/huge-emitter.toml");
    compare(folder.path(), scene).assert().success();
    let record = fs::read(folder.path().join("out/run.json")).expect("a record");
    let record: Value = serde_json::from_slice(&record).expect("JSON");
    let rows = record["scenes"][0]["summaries"].as_array().expect("rows");
    assert_eq!(rows.len(), 4);
    for row in rows {
        assert!(row["error"].is_null() && row["runs"].as_u64() > Some(0), "{row}");
    }
}
