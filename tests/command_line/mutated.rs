//! Promise: whatever bytes stand in a folder of results or in a list of vectors, they are read or refused: no panic, no hang, no
//! memory out of proportion.
//!
//! `CITYLIGHTS_MUTATIONS` is how many of each kind are tried; `cargo test` tries few, for each is a process.
#![cfg(all(feature = "cli", unix))]

use crate::broken::broken;
use assert_cmd::Command;
use citylights::base::random::Stream;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// How long any may take, as a whole process on a busy machine.
const LONGEST: Duration = Duration::from_secs(20);

fn wanted() -> u64 {
    std::env::var("CITYLIGHTS_MUTATIONS").map_or(60, |text| text.parse().expect("a number of mutants"))
}

/// The program in 2 GB of addresses.
fn limited() -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 2000000; exec \"$@\"", "sh"]).arg(assert_cmd::cargo::cargo_bin("citylights"));
    command
}

/// Runs the program on mutants of a file; each ends by itself, with 0, 1 or 2.
fn run(kind: &str, file: &Path, arguments: &[&str]) {
    let whole = fs::read(file).expect("a file");
    let (mut codes, mut longest) = ([0u64; 3], Duration::ZERO);
    for number in 0..wanted() {
        let bytes = broken(&mut Stream::keyed(&[2, number]), whole.clone());
        fs::write(file, &bytes).expect("written");
        let begun = Instant::now();
        let output = limited().args(arguments).timeout(LONGEST).output().expect("a process");
        let (text, said) = (String::from_utf8_lossy(&bytes), String::from_utf8_lossy(&output.stderr));
        let code = output.status.code().filter(|code| (0..3).contains(code));
        let code = code.unwrap_or_else(|| panic!("{kind} mutant {number}: {}\n{said}\n{text}", output.status));
        assert!(!said.contains("panicked"), "{kind} mutant {number}: {said}\n{text}");
        codes[code as usize] += 1;
        longest = longest.max(begun.elapsed());
    }
    fs::write(file, whole).expect("written");
    println!("{kind}: {codes:?} ended with 0, 1 and 2, the longest after {longest:?}");
    assert!(codes[0] + codes[1] > 0 && codes[2] > 0, "{kind}: {codes:?}");
}

#[test]
fn mutated_results_are_read_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("lamp.toml"), include_str!("../data/lamp.toml")).expect("written");
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.arg("compare").arg(at("lamp.toml")).args(["-s", "uniform,all", "--budget", "2", "--repeats", "3"]);
    command.arg("--out").arg(at("out")).arg("--cache").arg(at("cache")).assert().success();
    let out = at("out");
    for name in ["run.json", "runs.csv"] {
        run(name, &out.join(name), &["report", out.to_str().expect("text"), "--check"]);
    }
}

#[test]
fn mutated_vectors_are_met_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("vectors.csv");
    let text = include_str!("../data/triangle.csv");
    fs::write(&file, text.lines().take(12).collect::<Vec<_>>().join("\n")).expect("written");
    run("vectors", &file, &["stability", "--vectors", file.to_str().expect("text")]);
}

#[test]
fn mutated_references_are_taken_or_made_anew() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let scene = include_str!("../data/lamp.toml").replace("resolution = [32, 18]", "resolution = [8, 6]");
    fs::write(at("lamp.toml"), scene).expect("written");
    let [scene, picture, cache] = ["lamp.toml", "picture.exr", "cache"].map(|name| at(name).display().to_string());
    let arguments = ["reference", &scene, "-o", &picture, "--cache", &cache, "--threads", "1"];
    Command::cargo_bin("citylights").expect("the binary").args(arguments).assert().success();
    let whole = fs::read(&picture).expect("a picture");
    let tile = fs::read_dir(at("cache")).expect("a cache").map(|entry| entry.expect("a file").path());
    let tile =
        tile.filter(|path| path.is_file()).max_by_key(|path| path.metadata().expect("there").len()).expect("a tile");
    let good = fs::read(&tile).expect("a tile");
    let (mut refused, mut anew) = (0, 0);
    for number in 0..wanted() {
        let bytes = broken(&mut Stream::keyed(&[3, number]), good.clone());
        if bytes == good {
            continue;
        }
        fs::write(&tile, &bytes).expect("written");
        let output = limited().args(arguments).timeout(LONGEST).output().expect("a process");
        let said = String::from_utf8_lossy(&output.stderr);
        match output.status.code() {
            Some(0) => {
                assert!(fs::read(&picture).expect("a picture") == whole, "mutant {number} changed the picture: {said}");
                anew += u64::from(fs::read(&tile).expect("a tile") == good);
            }
            Some(2) => refused += 1,
            _ => panic!("mutant {number}: {}\n{said}", output.status),
        }
        fs::write(&tile, &good).expect("written");
    }
    println!("references: {refused} of {} refused, {anew} made anew", wanted());
    assert!(refused + anew > wanted() / 2, "damage was not noticed: {refused} refused, {anew} made anew");
}
