//! Exports are written whole, and what cannot be written is refused before the work.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use predicates::str::contains;
use std::path::Path;

fn exporting(to: &str, file: &Path) -> Command {
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.args(["export", "scenes/shadows.toml", "--to", to, "-o"]).arg(file);
    command
}

#[test]
fn exports_are_written_and_replaced_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    for (to, name) in [("gltf", "a.glb"), ("gltf", "a.gltf"), ("pbrt", "a.pbrt"), ("mitsuba", "a.xml")] {
        let file = folder.path().join(name);
        std::fs::write(&file, "old").expect("written");
        exporting(to, &file).assert().success().stdout(contains("lights"));
        assert!(std::fs::metadata(&file).expect("a file").len() > 1000, "{name}");
    }
    let mut names: Vec<_> =
        std::fs::read_dir(folder.path()).expect("a folder").map(|e| e.expect("it").file_name()).collect();
    names.sort();
    assert_eq!(names, ["a", "a.glb", "a.gltf", "a.pbrt", "a.xml"]);
    let mut command = exporting("gltf", &folder.path().join("a.glb"));
    command.args(["--resolution", "32x18"]).assert().success();
    let file = std::fs::read(folder.path().join("a.glb")).expect("a file");
    assert!(String::from_utf8_lossy(&file).contains("\"resolution\":[32,18]"));
}

#[test]
fn impossible_outputs_are_refused_before_the_work() {
    let folder = tempfile::tempdir().expect("a folder");
    for (to, name, said) in [
        ("gltf", "a.xml", ".glb or .gltf"),
        ("pbrt", "a.glb", ".pbrt"),
        ("mitsuba", "a", ".xml"),
        ("gltf", "no/such/a.glb", "no/such"),
        ("glft", "a.glb", "gltf"),
    ] {
        exporting(to, &folder.path().join(name)).assert().code(2).stdout("").stderr(contains(said));
    }
    std::fs::create_dir(folder.path().join("a.glb")).expect("a folder");
    exporting("gltf", &folder.path().join("a.glb")).assert().code(2).stderr(contains("it is a folder"));
}

#[test]
fn a_folder_that_cannot_be_leaves_the_old_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("town.xml");
    std::fs::write(&file, "old").expect("written");
    std::fs::write(folder.path().join("town"), "in the way").expect("written");
    exporting("mitsuba", &file).assert().code(2).stderr(contains("town"));
    assert_eq!(std::fs::read_to_string(&file).expect("a file"), "old");

    // One of the files beside it cannot take its name: none of those that were there before is lost.
    std::fs::remove_file(folder.path().join("town")).expect("removed");
    std::fs::create_dir_all(folder.path().join("town/meshes.serialized/full")).expect("a folder");
    exporting("mitsuba", &file).assert().code(2).stderr(contains("meshes.serialized"));
    assert_eq!(std::fs::read_to_string(&file).expect("a file"), "old");
    assert_eq!(std::fs::read_dir(folder.path().join("town")).expect("a folder").count(), 1, "a part was left");
}
