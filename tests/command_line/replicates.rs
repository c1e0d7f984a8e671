//! Promise: many cities and views of a recipe are scenes of one comparison, each of which can be had by itself, and what
//! they say together follows from the record.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn citylights() -> Command {
    Command::cargo_bin("citylights").expect("the binary")
}

/// The arguments, split at blanks, fail with exit code 2 and a message that holds all of `said`.
fn refused(arguments: &str, said: &[&str]) {
    let assert = citylights().args(arguments.split(' ')).assert().code(2).stdout("");
    said.iter().fold(assert, |assert, text| assert.stderr(contains(*text)));
}

#[test]
fn replicates_that_cannot_be_are_refused() {
    let first = "compare scenes/first-night.toml --out no/such/folder";
    refused("compare scenes/plaza.toml --views street,roof", &["scenes/plaza.toml", "`city`", "street, roof, sky"]);
    refused("compare scenes/plaza.toml --cities 2", &["scenes/plaza.toml", "no generated city", "[city]"]);
    refused("compare scenes/plaza.toml --cities 1", &["scenes/plaza.toml", "no generated city", "[city]"]);
    refused(&format!("{first} --cities 0"), &["--cities", "1..="]);
    refused(&format!("{first} --views street,rof"), &["rof", "street, roof, sky", "near it: roof"]);
    refused(&format!("{first} --views sky,sky"), &["`sky`", "twice"]);
    refused(&format!("{first} --views sky --view roof"), &["--view"]);
    refused(&format!("{first} --base power"), &["--base", "--cities", "--views"]);
    let some = format!("{first} --cities 2 -s power,influence");
    refused(&format!("{some} --base influence"), &["`influence`", "one of power is right"]);
    refused(&format!("{first} --scene-seed 18446744073709551615 --cities 2"), &["18446744073709551615"]);

    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("street.glb");
    citylights().args(["export", "scenes/first-night.toml", "--to", "gltf", "-o"]).arg(&file).assert().success();
    let of_gltf = |more: &[&str]| {
        let mut command = citylights();
        command.arg("compare").arg(&file).args(more).assert().code(2).stderr(contains("street.glb"))
    };
    of_gltf(&["--views", "sky"]).stderr(contains("street, roof, sky"));
    of_gltf(&["--cities", "2"]).stderr(contains("seed"));
    of_gltf(&["--cities", "1"]).stderr(contains("seed"));
}

fn read(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

#[test]
fn two_cities_and_two_views_are_four_scenes_and_one_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, cache) = (folder.path().join("out"), folder.path().join("cache"));
    let compare = || {
        let mut command = citylights();
        command.args(["compare", "scenes/first-night.toml", "--cities", "2", "--views", "street,roof"]);
        command.args(["--resolution", "32x18", "--budget", "4", "--repeats", "3", "--seconds", "0.1"]);
        command
            .args(["-s", "uniform,power,light-tree", "--threads", "1", "--out"])
            .arg(&out)
            .arg("--cache")
            .arg(&cache);
        command
    };
    let together =
        || contains("first-night: 4 replicates").and(contains("Ratio to light-tree")).and(contains("4 of 4"));
    compare().assert().success().stdout(together());
    let names = ["first-night 7 street", "first-night 7 roof", "first-night 8 street", "first-night 8 roof"];
    let record: Value = serde_json::from_str(&read(&out, "run.json")).expect("JSON");
    let scenes = record["scenes"].as_array().expect("scenes");
    assert_eq!(scenes.iter().map(|scene| scene["name"].as_str().expect("a name")).collect::<Vec<_>>(), names);
    let last = &scenes[3];
    assert_eq!((&last["family"], &last["seed"], &last["view"]), (&"first-night".into(), &8.into(), &"roof".into()));
    assert_eq!(record["base"], "light-tree");

    // Each can be had by itself.
    let mut inspect = citylights();
    inspect.args("inspect scenes/first-night.toml --scene-seed 8 --view roof --resolution 32x18".split(' '));
    inspect.assert().success().stdout(contains(last["hash"].as_str().expect("a hash")));

    // The page names all of them, and both follow from the record.
    let page = read(&out, "replicates-first-night.md");
    assert!(names.iter().all(|name| page.contains(name)) && page.contains("replicates-first-night.svg"), "{page}");
    assert!(read(&out, "replicates-first-night.svg").contains("light-tree"));
    let report = |more: &[&str]| {
        let mut command = citylights();
        command.arg("report").arg(&out).args(more).assert()
    };
    let readme = folder.path().join("README.md");
    report(&["--splice", readme.to_str().expect("a path")]).success().stdout(contains("replicates-first-night.md"));
    let spliced = fs::read_to_string(&readme).expect("a page");
    assert!(spliced.contains("begin replicates first-night") && !spliced.contains("begin first-night 7"), "{spliced}");
    report(&["--check"]).success();
    fs::write(out.join("replicates-first-night.md"), page + "\n").expect("written");
    report(&["--check"]).code(1).stdout(contains("replicates-first-night.md"));

    // Shown again, not measured again; with another base it is another comparison.
    compare().assert().success().stdout(together()).stderr(contains("nothing was measured"));
    compare().args(["--base", "power"]).assert().code(2).stderr(contains("another comparison"));
}
