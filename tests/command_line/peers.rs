//! Promise: another renderer's images become rows like any other, and whatever it does, the comparison goes on.
//!
//! No renderer is needed: a shell script takes Python's place and does what a peer's script might do.
#![cfg(all(feature = "cli", unix))]

use assert_cmd::Command;
use citylights::base::claim::Claim;
use citylights::image::{self, Picture};
use citylights::record::{SceneRecord, Summary};
use predicates::prelude::*;
use predicates::str::contains;
use serde::Deserialize;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const LAMP: &str = include_str!("../data/lamp.toml");

/// Called as Python is: SCRIPT SCENE --out FOLDER --spp LIST --seeds LIST [more]. FAKE says what it does, IMAGE is what
/// it renders, HEARD is where it writes down what it was asked.
const FAKE: &str = r#"#!/bin/sh
scene=$2 out=$4 spp=$6 seeds=$8
echo "$@" >> "$HEARD"
test -s "$1" && test -s "$(dirname "$1")/contract.py" || exit 9
case $1 in
    *cycles_peer.py) test "$(head -c 4 "$scene")" = glTF || exit 8 ;;
    *mitsuba_peer.py) grep -q "<scene" "$scene" || exit 7 ;;
esac
if [ "$FAKE" = missing ]; then echo '{"kind":"missing","why":"No module named x"}'; exit 0; fi
echo '{"kind":"about","renderer":"Fake 1.0","remarks":["times are made up"]}'
case $FAKE in
    failing) echo "first words" >&2; echo "out of luck" >&2; exit 3 ;;
    garbage) echo "Fra:1 Mem:8M" ;;
    lazy) exit 0 ;;
    hanging) exec sleep 100 ;;
    unasked) echo '{"kind":"image","seed":1,"spp":3,"setup_s":0,"cpu_s":0,"wall_s":0,"file":"x"}' ;;
    nowhere) echo "{\"kind\":\"image\",\"seed\":${seeds%%,*},\"spp\":1,\"setup_s\":0,\"cpu_s\":1,\"wall_s\":0,\"file\":\"x\"}" ;;
    outside) echo "{\"kind\":\"image\",\"seed\":${seeds%%,*},\"spp\":1,\"setup_s\":0,\"cpu_s\":1,\"wall_s\":0,\"file\":\"../run.json\"}" ;;
    instant) echo "{\"kind\":\"image\",\"seed\":${seeds%%,*},\"spp\":1,\"setup_s\":0,\"cpu_s\":0,\"wall_s\":0,\"file\":\"x\"}" ;;
    untimely) echo "{\"kind\":\"image\",\"seed\":${seeds%%,*},\"spp\":1,\"setup_s\":0,\"cpu_s\":-1,\"wall_s\":0,\"file\":\"x\"}" ;;
esac
for seed in $(echo "$seeds" | tr , ' '); do
    for n in $(echo "$spp" | tr , ' '); do
        cp "$IMAGE" "$out/$seed-$n.exr"
        echo "{\"kind\":\"image\",\"seed\":$seed,\"spp\":$n,\"setup_s\":0.5,\"cpu_s\":0.0$n,\"wall_s\":0.1,\"file\":\"$seed-$n.exr\"}"
    done
    if [ "$FAKE" = "hanging later" ]; then exec sleep 100; fi
done
"#;

/// What all tests share. Made once: a script that is still open for writing, here or in a process that another test is
/// just starting, could not be run, and it is run only after the reference is there.
struct Ground {
    folder: TempDir,
}

fn ground() -> &'static Ground {
    static GROUND: OnceLock<Ground> = OnceLock::new();
    GROUND.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let fake = folder.path().join("python");
        std::fs::write(&fake, FAKE).expect("written");
        std::fs::set_permissions(&fake, std::fs::Permissions::from_mode(0o755)).expect("made executable");
        let scene = folder.path().join("lamp.toml");
        std::fs::write(&scene, LAMP).expect("written");
        let image = folder.path().join("reference.exr");
        let mut command = Command::cargo_bin("citylights").expect("the binary");
        command.arg("reference").arg(&scene).arg("-o").arg(&image).arg("--cache").arg(folder.path().join("cache"));
        command.assert().success();
        let right = image::read(&image).expect("a picture");
        let write = |name: &str, picture: &Picture| image::write(&folder.path().join(name), picture, 1.0).expect(name);
        let half = Picture { width: 16, height: 9, pixels: right.pixels[..144].to_vec() };
        write("half.exr", &half);
        let bright = |p: &[f32; 3]| p.map(|x| 1.5 * x);
        write("bright.exr", &Picture { pixels: right.pixels.iter().map(bright).collect(), ..right.clone() });
        write("broken.exr", &Picture { pixels: vec![[f32::NAN; 3]; right.pixels.len()], ..right.clone() });
        Ground { folder }
    })
}

impl Ground {
    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A comparison of `null` with peers, of two runs at 1 and 4 samples.
    fn compare(&self, fake: &str, image: &str, out: &Path, more: &[&str]) -> Command {
        let mut command = Command::cargo_bin("citylights").expect("the binary");
        self.arguments(fake, image, out, more, |name, value| {
            command.env(name, value);
        });
        let arguments = self.arguments(fake, image, out, more, |_, _| ());
        command.args(arguments);
        command
    }

    fn arguments(
        &self,
        fake: &str,
        image: &str,
        out: &Path,
        more: &[&str],
        mut env: impl FnMut(&str, &Path),
    ) -> Vec<String> {
        env("FAKE", Path::new(fake));
        env("IMAGE", &self.file(image));
        env("HEARD", &out.with_extension("heard"));
        env("CITYLIGHTS_PYTHON", &self.file("python"));
        let text = |path: &Path| path.display().to_string();
        let fixed = ["compare".to_owned(), text(&self.file("lamp.toml")), "--out".into(), text(out), "--cache".into()];
        let rest = "--strategies null --budget 4".split(' ').map(str::to_owned);
        let runs = if more.contains(&"--repeats") { &[][..] } else { &["--repeats", "2"] };
        let more = runs.iter().chain(more).map(|&argument| argument.to_owned());
        fixed.into_iter().chain([text(&self.file("cache"))]).chain(rest).chain(more).collect()
    }
}

/// What `run.json` says, as far as these tests look.
#[derive(Deserialize)]
struct Run {
    finished: bool,
    scenes: Vec<SceneRecord>,
}

/// What `runs.csv` says of a run of a budget, as far as these tests look.
#[derive(Deserialize)]
struct Row {
    strategy: String,
    run: u32,
    passes: u32,
    error: String,
}

fn run(out: &Path) -> Run {
    serde_json::from_slice(&std::fs::read(out.join("run.json")).expect("a record")).expect("as documented")
}

fn of<'a>(run: &'a Run, name: &str) -> &'a Summary {
    run.scenes[0].summaries.iter().find(|summary| summary.strategy == name).expect(name)
}

fn rows(out: &Path, name: &str) -> Vec<Row> {
    let mut table = csv::Reader::from_path(out.join("runs.csv")).expect("rows");
    let rows = table.deserialize::<Row>().map(|row| row.expect("a whole row"));
    rows.filter(|row| row.strategy == name).collect()
}

#[test]
fn images_of_peers_become_rows_marked_external() {
    let (ground, folder) = (ground(), tempfile::tempdir().expect("a folder"));
    let out = folder.path().join("out");
    let peers = ["--peer", "cycles:light-tree=off", "--peer", "mitsuba", "--peer", "cycles"];
    let printed = contains("external").and(contains("cycles:light-tree=off")).and(contains("`mitsuba`: Fake 1.0."));
    let noted = contains("`mitsuba`: times are made up").and(contains("`mitsuba`: 2 runs; errors over"));
    ground.compare("good", "reference.exr", &out, &peers).assert().success().stdout(printed.and(noted));
    let run = run(&out);
    for name in ["cycles:light-tree=off", "mitsuba", "cycles"] {
        let summary = of(&run, name);
        assert_eq!(summary.claim, Claim::External { renderer: "Fake 1.0".into() });
        assert_eq!((summary.runs, summary.passes), (2, 4));
        assert_eq!((summary.setup_cpu_s.mean, summary.cpu_s.mean), (0.5, 0.04));
        assert!(!summary.setup_cpu_s.is_bounded(), "measured once, not once a run");
        let points: Vec<(u32, f64)> = summary.curve.iter().map(|point| (point.passes, point.cpu_s.mean)).collect();
        assert_eq!(points, [(1, 0.51), (4, 0.54)], "from nothing to the image");
        assert_eq!(summary.seconds_to[0].value.mean, 0.51, "read as a strategy's curve is");
        assert_eq!((summary.seconds_to.len(), summary.error_at.len()), (3, run.scenes[0].times_s.len()));
        assert!(summary.rank.is_none() && summary.letters.is_empty());
        assert!(summary.rel_mse.mean < 1e-12 && summary.mean_bias.mean.abs() < 1e-6, "{summary:?}");
        let budgets: Vec<(u32, u32)> = rows(&out, name).iter().map(|row| (row.run, row.passes)).collect();
        assert_eq!(budgets, [(0, 1), (0, 4), (1, 1), (1, 4)]);
    }
    let heard = std::fs::read_to_string(out.with_extension("heard")).expect("heard");
    let asked: Vec<&str> = heard.lines().collect();
    assert!(asked[0].ends_with("--light-tree off") && asked[2].ends_with("--light-tree on"), "{heard}");
    assert!(asked[1].contains("mitsuba_peer.py") && asked[1].contains("--spp 1,4 --seeds "), "{heard}");
    assert!(!out.join("peers").exists() && !out.join("films").exists(), "something was left behind");
    let svg = std::fs::read_to_string(out.join("lamp.svg")).expect("a plot");
    assert!(svg.contains("not drawn: mitsuba"), "{svg}");
    let mut report = Command::cargo_bin("citylights").expect("the binary");
    report.arg("report").arg(&out).arg("--check").assert().success();
}

#[test]
fn a_peer_that_is_too_bright_is_seen_to_be() {
    let (ground, folder) = (ground(), tempfile::tempdir().expect("a folder"));
    let out = folder.path().join("out");
    let three = ["--peer", "mitsuba", "--repeats", "3"];
    let said =
        contains("`mitsuba` over the reference: mean 1.5000 ± 0.0000").and(contains("dotted: other renderers").not());
    ground.compare("good", "bright.exr", &out, &three).assert().success().stdout(said);
    let run = run(&out);
    let summary = of(&run, "mitsuba");
    assert!((summary.mean_bias.mean - 0.5).abs() < 1e-5, "{summary:?}");
    assert!(summary.rel_bias2.mean > 0.1, "{summary:?}");
    assert!(std::fs::read_to_string(out.join("lamp.svg")).expect("a plot").contains("dotted: other renderers"));
}

#[test]
fn a_peer_that_is_not_there_is_a_note_and_no_failure() {
    let (ground, folder) = (ground(), tempfile::tempdir().expect("a folder"));
    let readme = contains("src/peers/scripts/README.md");
    let out = folder.path().join("module");
    let missing = ground.compare("missing", "reference.exr", &out, &["--peer", "mitsuba"]).assert().success();
    missing
        .stdout(contains("skipped: No module"))
        .stderr(contains("peer `mitsuba`: skipped: No module named x").and(readme.clone()));
    assert!(run(&out).finished && rows(&out, "mitsuba").is_empty());
    let out = folder.path().join("python");
    let none = ["--peer", "mitsuba", "--peer-python", "no/such/python"];
    let missing = ground.compare("good", "reference.exr", &out, &none).assert().success();
    missing.stderr(contains("there is no Python `no/such/python`").and(readme));
    assert!(of(&run(&out), "mitsuba").skipped.is_some());
}

#[test]
fn whatever_a_peer_does_wrong_is_its_row_and_the_comparison_goes_on() {
    let (ground, folder) = (ground(), tempfile::tempdir().expect("a folder"));
    for (fake, image, said) in [
        ("failing", "reference.exr", "exit code 3: out of luck"),
        ("garbage", "reference.exr", "its script said `Fra:1 Mem:8M`, which is no line of the contract"),
        ("lazy", "reference.exr", "gave no image of seed"),
        ("unasked", "reference.exr", "gave an image nobody asked for: seed 1, 3 spp"),
        ("nowhere", "reference.exr", "cannot read"),
        ("outside", "reference.exr", "gave `../run.json`, which is no plain file name"),
        ("instant", "reference.exr", "gave times of"),
        ("untimely", "reference.exr", "gave times of"),
        ("good", "half.exr", "gave an image of 16 x 9 pixels where 32 x 18 are right"),
        ("good", "broken.exr", "infinite or undefined radiance"),
        ("good", "lamp.toml", ".exr: not an EXR picture that can be read"),
    ] {
        let out = folder.path().join(format!("{fake}-{image}"));
        let assert = ground.compare(fake, image, &out, &["--peer", "mitsuba"]).assert().success();
        assert.stderr(contains("peer `mitsuba`: ").and(contains(said))).stdout(contains("failed"));
        let run = run(&out);
        assert!(run.finished && of(&run, "null").error.is_none(), "{fake}");
        assert!(of(&run, "mitsuba").error.as_deref().is_some_and(|error| error.contains(said)), "{fake}");
        let rows = rows(&out, "mitsuba");
        let error = rows.iter().map(|row| &row.error).find(|error| !error.is_empty()).expect("a row that says so");
        assert!(!error.contains(&folder.path().display().to_string()), "{error} names a folder of this machine");
    }
}

#[test]
fn a_peer_that_says_nothing_is_stopped() {
    let (ground, folder) = (ground(), tempfile::tempdir().expect("a folder"));
    let (out, begun) = (folder.path().join("out"), Instant::now());
    let impatient = ["--peer", "mitsuba", "--peer-patience", "1"];
    let assert = ground.compare("hanging", "reference.exr", &out, &impatient).assert().success();
    assert.stderr(contains("said nothing for 1 s and was stopped"));
    // The script sleeps for longer.
    assert!(begun.elapsed() < Duration::from_secs(100), "it was waited for");
}

#[test]
fn an_interrupted_peer_goes_on_with_the_runs_that_are_missing() {
    let (ground, folder) = (ground(), tempfile::tempdir().expect("a folder"));
    let out = folder.path().join("out");
    let mut process = std::process::Command::new(assert_cmd::cargo::cargo_bin("citylights"));
    let arguments = ground.arguments("hanging later", "reference.exr", &out, &["--peer", "mitsuba"], |name, value| {
        process.env(name, value);
    });
    let mut process = process.args(arguments).stdout(std::process::Stdio::null()).spawn().expect("started");
    let begun = Instant::now();
    while !out.join("runs.csv").exists() || rows(&out, "mitsuba").len() < 2 {
        assert!(begun.elapsed() < Duration::from_secs(60), "no rows came");
        std::thread::sleep(Duration::from_millis(20));
    }
    // The film of the finished run is written a moment after its last row.
    std::thread::sleep(Duration::from_millis(300));
    std::process::Command::new("kill").args(["-INT", &process.id().to_string()]).status().expect("interrupted");
    assert_eq!(process.wait().expect("ended").code(), Some(130));
    ground.compare("good", "reference.exr", &out, &["--peer", "mitsuba"]).assert().success();
    let heard = std::fs::read_to_string(out.with_extension("heard")).expect("heard");
    let seeds: Vec<Vec<&str>> =
        heard.lines().map(|line| line.split("--seeds ").nth(1).expect("seeds").trim().split(',').collect()).collect();
    assert!(seeds[0].len() == 2 && seeds[1] == seeds[0][1..], "{heard}");
    assert_eq!(rows(&out, "mitsuba").len(), 4);
    assert_eq!(of(&run(&out), "mitsuba").runs, 2);
}

#[test]
fn unknown_peers_are_refused_with_near_ones() {
    let (ground, folder) = (ground(), tempfile::tempdir().expect("a folder"));
    let out = folder.path().join("out");
    for (peer, said) in [
        ("mitsubo", "unknown peer `mitsubo`; near it: mitsuba"),
        ("cycles:light-tre=off", "light-tree"),
        ("cycles:light-tree=maybe", "one of on|off"),
        ("mitsuba:variant=x", "mitsuba has no parameters"),
    ] {
        let assert = ground.compare("good", "reference.exr", &out, &["--peer", peer]).assert().code(2);
        assert.stdout("").stderr(contains(said));
    }
    let twice = ["--peer", "cycles", "--peer", "cycles:light-tree=on"];
    ground.compare("good", "reference.exr", &out, &twice).assert().code(2).stderr(contains("`cycles` is named twice"));
    assert!(!out.exists(), "a result folder was made");
}
