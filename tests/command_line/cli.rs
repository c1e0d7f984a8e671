//! Promise: the command line says what is wrong, loses nothing, and gives the same bytes however it is run.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::path::{Path, PathBuf};

fn citylights() -> Command {
    Command::cargo_bin("citylights").expect("the binary")
}

/// The arguments, split at blanks, fail with exit code 2 and a message that holds all of `said`.
fn refused(arguments: &str, said: &[&str]) {
    let assert = citylights().args(arguments.split(' ')).assert().code(2).stdout("");
    said.iter().fold(assert, |assert, text| assert.stderr(contains(*text)));
}

/// A small recipe in a folder of its own.
fn recipe(folder: &Path, text: &str) -> PathBuf {
    let file = folder.join("scene.toml");
    std::fs::write(&file, text).expect("written");
    file
}

const LAMP: &str = include_str!("../data/lamp.toml");

#[test]
fn unknown_names_are_refused_with_near_ones() {
    refused("render scenes/lamps-only.toml -s influense -o x.png", &["influense", "influence"]);
    refused("render scenes/lamps-only.toml -s power:pick=2 -o x.png", &["power:pick", "picks"]);
    refused("render scenes/lamps-only.toml -s power:picks=0 -o x.png", &["picks", "1 to 1024"]);
    refused("render scenes/lamps-only.toml --offset tmin -o x.png", &["tmin", "t-min"]);
    refused("compare scenes/lamps-only.toml --strategies power,power", &["power", "twice"]);
}

#[test]
fn studies_are_named_listed_and_run() {
    refused("study strategie", &["unknown study `strategie`", "strategies"]);
    refused("study scaling --scene scenes/plaza.toml", &["scenes/plaza.toml", "`city`"]);
    refused("study cutoff --strategies influense", &["influense", "influence"]);
    refused("study scaling --max-lights 7", &["100..="]);
    citylights().args(["list", "studies"]).assert().success().stdout(contains("cutoff\n    What does a hard cut-off"));

    let folder = tempfile::tempdir().expect("a folder");
    let (out, cache) = (folder.path().join("out"), folder.path().join("cache"));
    let small = "study scaling --strategies power --max-lights 100 --pixels 8 --passes 2 --repeats 2 --out";
    let study = || {
        let mut command = citylights();
        command.args(small.split(' ')).arg(&out).arg("--cache").arg(&cache);
        command
    };
    let printed = || contains("growth with the number of lights").and(contains("power"));
    study().assert().success().stdout(printed()).stderr(contains("rows go to"));
    let written = std::fs::read(out.join("study.json")).expect("a record");
    study().assert().success().stdout(printed());
    assert!(written == std::fs::read(out.join("study.json")).expect("a record"), "it was measured again");
    study().args(["--seed", "2"]).assert().code(2).stderr(contains("never overwritten"));
    let page = folder.path().join("README.md");
    let report = |check: &[&str]| {
        let mut command = citylights();
        command.arg("report").arg(&out).args(check).arg("--splice").arg(&page);
        command
    };
    report(&[]).assert().success();
    report(&["--check"]).assert().success();
    std::fs::write(out.join("scaling.md"), "").expect("written");
    report(&["--check"]).assert().code(1).stdout(contains("scaling.md"));
}

#[test]
fn impossible_outputs_are_refused_before_the_work() {
    refused("render scenes/megacity.toml -o picture.jpg", &["picture.jpg", ".png or .exr"]);
    refused("render scenes/megacity.toml -o no/such/folder/x.png", &["no/such/folder"]);
    refused("reference scenes/megacity.toml -o no/such/folder/x.exr", &["no/such/folder"]);
}

#[test]
fn missing_scenes_and_wrong_numbers_are_refused() {
    refused("inspect scenes/nowhere.toml", &["scenes/nowhere.toml"]);
    refused("render scenes/lamps-only.toml --resolution 0x9 -o x.png", &["0x9"]);
    refused("render scenes/lamps-only.toml --ev100 NaN -o x.png", &["NaN"]);
    refused("compare scenes/lamps-only.toml --seconds 0", &["above 0"]);
    refused("compare scenes/lamps-only.toml --repeats 0", &["1..="]);
}

#[test]
fn a_mistake_in_the_last_scene_costs_no_measuring() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let file = recipe(folder.path(), &LAMP.replace("fov = 50", "fof = 50"));
    let mut command = citylights();
    command.args(["compare", "scenes/lamps-only.toml"]).arg(&file).arg("--out").arg(&out);
    command.assert().code(2).stderr(contains("scene.toml:10").and(contains("fof")).and(contains("fov")));
    assert!(!out.exists(), "a result folder was made");
}

#[test]
fn no_lights_is_a_black_image_and_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = recipe(folder.path(), LAMP.split("[[light]]").next().expect("a head"));
    let out = folder.path().join("dark.exr");
    for strategy in ["null", "all", "uniform", "power", "intensity", "influence", "influence-pick", "influence-tail"] {
        let mut command = citylights();
        command.arg("render").arg(&file).args(["-s", strategy, "--spp", "2", "-o"]).arg(&out);
        command.assert().success().stderr(contains("no lights"));
        let picture = citylights::image::read(&out).expect("a picture");
        assert!(picture.pixels.iter().all(|p| *p == [0.0; 3]), "{strategy}");
    }
}

#[test]
fn pictures_do_not_depend_on_threads_or_leaving_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    let render = |scene: &str, more: &[&str], name: &str| {
        let mut command = citylights();
        command.args(["render", scene, "--resolution", "48x27", "-o"]).arg(file(name)).args(more).assert().success();
        std::fs::read(file(name)).expect("a picture")
    };
    let first = "scenes/first-night.toml";
    let one = render(first, &["--spp", "4", "--threads", "1"], "one.exr");
    assert!(one == render(first, &["--spp", "4", "--threads", "2"], "two.exr"), "threads change the picture");
    for scene in [first, "scenes/lamps-only.toml", "scenes/plaza.toml", "scenes/moonlit.toml"] {
        let all = ["-s", "all", "--spp", "1", "--leave-out"];
        let on = render(scene, &[&all[..], &["on"]].concat(), "on.exr");
        assert!(on == render(scene, &[&all[..], &["off"]].concat(), "off.exr"), "leaving out changes {scene}");
    }
}

#[test]
fn a_replayed_pixel_sees_its_neighbours() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, out) = (recipe(folder.path(), LAMP), folder.path().join("frame.exr"));
    let render = |more: &[&str]| {
        let mut command = citylights();
        command.arg("render").arg(&file).args(["-s", "restir", "--spp", "3"]).args(more);
        String::from_utf8(command.assert().success().get_output().stdout.clone()).expect("text")
    };
    render(&["-o", out.to_str().expect("a name")]);
    let said = render(&["--pixel", "16,14"]);
    let mean = said.trim().rsplit_once("mean [").and_then(|(_, mean)| mean.strip_suffix(']')).expect("a mean");
    let mean: Vec<f32> = mean.split(", ").map(|number| number.parse().expect("a number")).collect();
    assert_eq!(mean, citylights::image::read(&out).expect("a picture").pixels[14 * 32 + 16]);
}

#[test]
fn one_pixel_can_be_replayed() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = recipe(folder.path(), LAMP);
    let mut command = citylights();
    command.arg("render").arg(&file).args(["-s", "power", "--spp", "3", "--pixel", "16,14"]);
    command.assert().success().stdout(contains("pass 2:"));
    let mut command = citylights();
    command.arg("render").arg(&file).args(["--pixel", "32,0"]).assert().code(2).stderr(contains("outside"));
}

#[test]
fn lists_and_inspections_are_json_on_demand() {
    for arguments in ["list strategies --json", "list scenes --json", "inspect scenes/first-night.toml --json"] {
        let output = citylights().args(arguments.split(' ')).output().expect("it runs");
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert!(value.is_array() || value["kinds"].is_array(), "{arguments}");
    }
}

#[test]
fn a_comparison_leaves_rows_tables_and_plots_that_reports_agree_with() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = recipe(folder.path(), LAMP);
    let out = folder.path().join("out");
    let compare = || {
        let mut command = citylights();
        command.arg("compare").arg(&file).args(["--repeats", "4", "--budget", "8", "--cache"]);
        command.arg(folder.path().join("cache")).arg("--out").arg(&out);
        command
    };
    compare().assert().success().stdout(contains("influence-tail").and(contains("exact")));
    for name in ["run.json", "runs.csv", "lamp.md", "lamp.svg"] {
        assert!(out.join(name).is_file(), "{name} is missing");
    }
    assert!(!out.join("films").exists());
    citylights().arg("report").arg(&out).arg("--check").assert().success();
    let again = contains("nothing was measured").and(contains("never overwritten"));
    compare().assert().success().stdout(contains("influence-tail")).stderr(again);
    compare().args(["--seed", "2"]).assert().code(2).stderr(contains("never overwritten"));
    std::fs::write(out.join("lamp.md"), "edited").expect("written");
    citylights().arg("report").arg(&out).arg("--check").assert().code(1).stdout(contains("lamp.md"));
}

#[test]
fn a_folder_that_is_somebodys_own_is_refused_before_anything_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = |name: &str| folder.path().join("own").join(name);
    std::fs::create_dir_all(own("films")).expect("made");
    std::fs::write(own("films/holiday.mkv"), "mine").expect("written");
    std::fs::create_dir_all(own("offsets/peers")).expect("made");
    for verb in ["compare scenes/megacity.toml", "study offsets", "study all"] {
        let mut command = citylights();
        command.args(verb.split(' ')).arg("--out").arg(own(""));
        command.assert().code(2).stdout("").stderr(contains("nothing was touched").and(contains("own")));
    }
    assert_eq!(std::fs::read_to_string(own("films/holiday.mkv")).expect("read"), "mine");
    assert_eq!(std::fs::read_dir(own("")).expect("listed").count(), 2, "something was written");
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_utf8_are_taken() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(std::ffi::OsStr::from_bytes(b"lamp\xff.toml"));
    std::fs::write(&file, include_str!("../data/street.toml")).expect("written");
    for verb in [
        "compare --budget 1 --repeats 2 -s uniform",
        "study strategies --pixels 4 --receivers 4 --repeats 2 -s uniform --scene",
    ] {
        let mut command = citylights();
        command.args(verb.split(' ')).arg(&file).arg("--out").arg(folder.path().join(&verb[..5])).arg("--cache");
        command.arg(folder.path().join("cache")).assert().success();
    }
    let record = std::fs::read_to_string(folder.path().join("compa/run.json")).expect("a record");
    assert!(record.contains("lamp\u{fffd}.toml"), "{record}");
}

#[test]
fn a_record_names_the_build_wherever_it_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = recipe(folder.path(), LAMP);
    let mut command = citylights();
    // A checkout of something else, and nothing to be found.
    std::fs::create_dir(folder.path().join(".git")).expect("made");
    command.current_dir(folder.path()).env("PATH", "").arg("compare").arg(&file);
    command.args(["--budget", "1", "--repeats", "2", "-s", "uniform", "--out", "out"]).assert().success();
    let text = std::fs::read_to_string(folder.path().join("out/run.json")).expect("a record");
    let record: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let said = |field: &str| record[field].as_str().expect(field);
    assert_eq!(said("version"), env!("CARGO_PKG_VERSION"));
    assert_eq!(said("revision"), citylights::program!().revision);
    assert!(said("compiler").starts_with("rustc 1."), "{record}");
    assert!(said("flags").contains("target features"), "{record}");
}

#[test]
fn verify_prints_statistics_and_takes_a_seed_from_the_clock() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = recipe(folder.path(), LAMP);
    let verify = |more: &[&str]| {
        let mut command = citylights();
        command.arg("verify").arg(&file).args(["-s", "power,influence,light-tree", "--draws", "2000"]).args(more);
        command.assert().success()
    };
    let lines = contains("image-mean").and(contains("scaled-counts")).and(contains("bias")).and(contains("(limit"));
    verify(&[]).stdout(lines.and(contains("every check passed"))).stderr(contains("seed 1"));
    verify(&["--quiet", "--fresh-seed"]).stdout(contains("pass of")).stderr(contains("seed 1;").not());
}

#[test]
fn verify_shows_one_check_as_the_gate_makes_it() {
    let mut command = citylights();
    command.args(["verify", "--gate", "--seed", "5", "--strategies", "power", "--only", "arrival-order"]);
    let of_power = contains("power").and(contains("arrival-order")).and(contains("weights").not());
    command.assert().success().stdout(of_power.and(contains("every check passed")));
}

#[test]
fn verify_without_a_scene_looks_at_the_generated_ones() {
    let mut command = citylights();
    command.args(["verify", "-q", "-s", "uniform,influence-tail", "--draws", "1000", "--places", "4"]);
    command.assert().success().stdout(contains("no-lights").and(contains("sixteen")).and(contains("giant")));
    refused("verify --level 2", &["between 0 and 1"]);
    refused("verify --seed 3 --fresh-seed", &["--fresh-seed"]);
    refused("verify --only wieghts", &["weights"]);
    refused("verify --gate --draws 1000", &["--gate"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_comparison_keeps_its_rows_and_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = recipe(folder.path(), LAMP);
    let out = folder.path().join("out");
    let arguments = |repeats: &str| {
        let mut arguments = vec!["compare".to_owned(), file.display().to_string()];
        for more in ["--strategies", "uniform,all", "--budget", "64", "--repeats", repeats, "--threads", "1", "--out"] {
            arguments.push(more.to_owned());
        }
        arguments.push(out.display().to_string());
        arguments.push("--cache".to_owned());
        arguments.push(folder.path().join("cache").display().to_string());
        arguments
    };
    let rows = || std::fs::read_to_string(out.join("runs.csv")).map_or(0, |text| text.lines().count());
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("citylights"))
        .args(arguments("250"))
        .stderr(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("it starts");
    let patience = std::time::Instant::now();
    while rows() < 20 && patience.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    let status = child.wait().expect("it ends");
    assert_eq!(status.code(), Some(130), "it ended before it was interrupted");
    let kept = rows();
    assert!(kept >= 20);
    let again = || citylights().args(arguments("250")).assert();
    let text = std::fs::read_to_string(&file).expect("the recipe");
    std::fs::write(&file, text.replace("intensity = 100", "intensity = 200")).expect("written");
    again().code(2).stderr(contains("another comparison"));
    std::fs::write(&file, text).expect("written");
    again().success();
    let text = std::fs::read_to_string(out.join("runs.csv")).expect("rows");
    let keys: Vec<String> = text.lines().skip(1).map(|l| l.split(',').take(4).collect::<Vec<_>>().join(",")).collect();
    let distinct: std::collections::HashSet<&String> = keys.iter().collect();
    assert_eq!(distinct.len(), keys.len(), "a run stands twice in runs.csv");
    assert!(keys.len() > kept, "{} rows after {kept}", keys.len());
    assert_eq!(keys.len() % 250, 0, "each run has all its budgets: {}", keys.len());
}

#[test]
fn a_crate_for_a_strategy_is_written_once_and_into_an_empty_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str| {
        let mut command = citylights();
        command.current_dir(folder.path()).args(["new-strategy", name]);
        command
    };
    write("my-lights").assert().success().stdout(contains("cargo run --release -- compare"));
    let read = |file: &str| std::fs::read_to_string(folder.path().join("my-lights").join(file)).expect(file);
    let (strategy, program) = (read("src/lib.rs"), read("src/main.rs"));
    assert!(strategy.contains("pub struct MyLights") && strategy.contains("name: \"my-lights\""), "{strategy}");
    assert!(strategy.lines().count() <= 60, "{} lines", strategy.lines().count());
    assert!(program.contains("my_lights::registry()"), "{program}");
    let rust = ["build.rs", "src/lib.rs", "src/main.rs", "benches/strategy.rs", "tests/contract.rs"];
    let lines: usize = rust.iter().map(|file| read(file).lines().count()).sum();
    assert!(lines <= 90, "{lines} lines");
    for file in rust.iter().chain(&["Cargo.toml"]) {
        let left = ["{name}", "{crate}", "{type}", "{library}"].into_iter().find(|left| read(file).contains(left));
        assert!(left.is_none(), "{file} still holds {left:?}");
    }
    // The example is such a crate: what it has not changed is what is written today.
    let example = |file: &str| std::fs::read_to_string(Path::new("examples/own-strategy").join(file)).expect(file);
    let as_example = |text: String| text.replace("my-lights", "systematic").replace("my_lights", "systematic");
    for file in ["build.rs", "src/main.rs", "tests/contract.rs"] {
        assert_eq!(as_example(read(file)), example(file), "{file}");
    }
    write("my-lights").assert().code(2).stderr(contains("holds something already"));
    write("power").assert().code(2).stderr(contains("is the name of a strategy that there is"));
    for name in ["match", "sampler", "build", "a--b"] {
        write(name).assert().code(2).stderr(contains("means something else"));
    }
    write("My Lights").assert().code(2).stderr(contains("lower-case letters"));
    write("x").args(["--library", "."]).assert().code(2).stderr(contains("holds no Cargo.toml"));
}

#[test]
fn a_pixel_is_explained_by_its_picks_and_by_what_lights_add() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = recipe(folder.path(), LAMP);
    let explain = |pixel: &str, strategy: &str| {
        let mut command = citylights();
        command.arg("explain").arg(&file).args(["--pixel", pixel, "-s", strategy]);
        command
    };
    let shown = contains("light 0 (point").and(contains("81.70 %")).and(contains("exact luminance"));
    explain("8,8", "power").assert().success().stdout(shown);
    explain("8,8", "resampled").assert().success().stdout(contains("expected picks of it in a pass: cannot be told"));
    explain("999,0", "power").assert().code(2).stderr(contains("outside the"));
    explain("8", "power").assert().code(2).stderr(contains("10,20"));
}

#[test]
fn sweeps_are_expanded_and_named_by_what_was_varied() {
    refused("verify --strategies power:mix={0..1*2}", &["must rise"]);
    refused("verify --strategies power:mix={0,1", &["has no `}`"]);
    let list = ["verify", "--quiet", "--gate", "--strategies", "power:picks={1,2}"];
    let scene = "scenes/lamps-only.toml";
    citylights()
        .args(list)
        .arg(scene)
        .args(["--resolution", "16x9"])
        .assert()
        .success()
        .stdout(contains("power:picks=1 ").and(contains("power:picks=2 ")));
}
