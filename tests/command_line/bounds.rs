//! Promise: no file, however it was made, takes more memory, time or length of name than its size allows, and what is
//! wrong in it is named.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use citylights::image::{self, Picture};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::TempDir;

const LAMP: &str = include_str!("../data/lamp.toml");

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn with(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        fs::write(self.path(name), text).expect("written");
        self.path(name)
    }

    /// The recipe with the scene of this name.
    fn scene(&self, file: &str, name: &str) -> PathBuf {
        self.with(file, LAMP.replacen("name = \"lamp\"", &format!("name = \"{name}\""), 1))
    }

    /// A finished comparison of the lamp.
    fn compared(&self) -> PathBuf {
        let mut command = citylights();
        command.arg("compare").arg(self.scene("lamp.toml", "lamp")).args(SMALL).arg("--out").arg(self.path("out"));
        command.arg("--cache").arg(self.path("cache")).assert().success();
        self.path("out")
    }
}

const SMALL: [&str; 7] = ["--strategies", "uniform,all", "--budget", "2", "--repeats", "3", "--threads=1"];

fn citylights() -> Command {
    Command::cargo_bin("citylights").expect("the binary")
}

fn record(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("run.json")).expect("a record")).expect("JSON")
}

/// Changes the record of a comparison.
fn edit(folder: &Path, change: impl FnOnce(&mut Value)) {
    let mut record = record(folder);
    change(&mut record);
    fs::write(folder.join("run.json"), record.to_string()).expect("written");
}

/// The bytes of a grey PNG, black, of 8 bits: zlib packs a thousand pixels into a byte.
fn black(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let grey = ::image::GrayImage::new(width, height);
    let best = ::image::codecs::png::CompressionType::Best;
    let encoder = ::image::codecs::png::PngEncoder::new_with_quality(
        &mut bytes,
        best,
        ::image::codecs::png::FilterType::NoFilter,
    );
    grey.write_with_encoder(encoder).expect("a PNG");
    bytes
}

#[cfg(unix)]
#[test]
fn a_few_bytes_do_not_ask_for_gigabytes() {
    let folder = Folder::new();
    let png = folder.with("black.png", black(8_192, 8_192));
    let length = fs::metadata(&png).expect("there").len();
    assert!(length < 300_000, "{length} bytes: is it still a bomb?");
    // What it asked for before was 9.5 GB.
    let mut limited = Command::new("sh");
    limited.args(["-c", "ulimit -v 4000000; exec \"$@\"", "sh"]).arg(assert_cmd::cargo::cargo_bin("citylights"));
    let said = contains("8192 x 8192 pixels; 1 to ").and(contains(length.to_string())).and(contains("--max-pixels"));
    limited.arg("diff-image").args([&png, &png]).timeout(Duration::from_secs(60));
    limited.assert().code(2).stdout("").stderr(contains("black.png").and(said));

    let black = Picture { width: 4_100, height: 2_100, pixels: vec![[0.0; 3]; 4_100 * 2_100] };
    let exr = folder.path("black.exr");
    image::write(&exr, &black, 1.0).expect("written");
    let diff = |a: &Path, more: &[&str]| citylights().arg("diff-image").args([a, a]).args(more).assert();
    diff(&exr, &[]).code(2).stdout("").stderr(contains("a window of 4100 x 2100 pixels; 1 to 8388608 are read"));
    assert!(image::read(&exr).is_err(), "the library takes it");
}

#[test]
fn the_bound_of_pixels_is_what_one_asks_for() {
    let folder = Folder::new();
    let grey = Picture { width: 32, height: 16, pixels: vec![[0.5; 3]; 512] };
    let diff = |file: &Path, most: &str| {
        citylights().arg("diff-image").args([file, file, "--max-pixels".as_ref(), most.as_ref()]).assert()
    };
    for name in ["grey.png", "grey.exr"] {
        let file = folder.path(name);
        image::write(&file, &grey, 1.0).expect("written");
        diff(&file, "512").success();
        diff(&file, "511").code(2).stderr(contains("32 x 16 pixels; 1 to 511 are read"));
        diff(&file, "0").code(2).stderr(contains("--max-pixels").and(contains("from 1 to 67108864")));
    }
}

#[test]
fn a_record_that_cannot_be_what_it_says_is_refused() {
    let folder = Folder::new();
    let out = folder.compared();
    let whole = record(&out);
    let summary = |change: fn(&mut Value)| move |record: &mut Value| change(&mut record["scenes"][0]["summaries"][0]);
    type Change = Box<dyn Fn(&mut Value)>;
    let changes: [(Change, &str); 10] = [
        (
            Box::new(summary(|s| s["runs"] = json!(4_294_967_295u32))),
            "`scenes[0].summaries[0].runs`: is 4294967295; 0 to 3 are right",
        ),
        (Box::new(|r| r["repeats"] = json!(4_294_967_295u32)), "`repeats`: is 4294967295; 1 to 65536 are right"),
        (
            Box::new(summary(|s| s["passes"] = json!(4_294_967_295u32))),
            "`scenes[0].summaries[0].passes`: is 4294967295",
        ),
        (
            Box::new(summary(|s| s["curve"][1]["passes"] = json!(1))),
            "`scenes[0].summaries[0].curve[1].passes`: is 1; 2 to",
        ),
        (Box::new(summary(|s| s["rank"] = json!([1, 9]))), "`scenes[0].summaries[0].rank[1]`: is 9; 1 to 2 are right"),
        (Box::new(|r| r["scenes"][0]["width"] = json!(0)), "`scenes[0].width`: is 0; 1 to"),
        (Box::new(|r| r["scenes"][0]["receivers"] = json!(577)), "`scenes[0].receivers`: is 577; 0 to 576 are right"),
        (Box::new(|r| r["scenes"][0]["ranked_by"] = json!(3)), "`scenes[0].ranked_by`: is 3; 0 to 2 are right"),
        (Box::new(|r| r["scenes"][0]["times_s"][0] = json!("nan")), "`scenes[0].times_s`: holds NaN; finite numbers"),
        (
            Box::new(|r| {
                let twice = r["scenes"][0].clone();
                r["scenes"] = json!([twice, twice]);
            }),
            "an earlier scene's, too",
        ),
    ];
    for (change, said) in changes {
        fs::write(out.join("run.json"), whole.to_string()).expect("written");
        edit(&out, change);
        for check in [&["--check"][..], &[]] {
            let mut command = citylights();
            command.arg("report").arg(&out).args(check).timeout(Duration::from_secs(20));
            command.assert().code(2).stdout("").stderr(contains("run.json: ").and(contains(said)));
        }
    }
    fs::write(out.join("run.json"), whole.to_string()).expect("written");
    citylights().arg("report").arg(&out).arg("--check").assert().success();
}

#[test]
fn names_may_be_longer_than_a_file_s() {
    let folder = Folder::new();
    // Six scenes of the longest name that there may be, in a folder that is named after all of them.
    let scenes: Vec<PathBuf> =
        (0..6).map(|n| folder.scene(&format!("{n}.toml"), &format!("{n}{}", "x".repeat(63)))).collect();
    let mut command = citylights();
    command.current_dir(folder.0.path()).arg("compare").args(&scenes).args(SMALL);
    command.assert().success().stderr(contains("rows, tables and plots: results/"));
    let made = fs::read_dir(folder.path("results")).expect("results").map(|entry| entry.expect("an entry").file_name());
    let made: Vec<String> =
        made.map(|name| name.into_string().expect("text")).filter(|name| name != ".references").collect();
    assert!(made.len() == 1 && made[0].len() <= 160 && made[0].contains("-0xxx"), "{made:?}");
    // A record may say more than a recipe.
    let out = folder.compared();
    let long = format!("{}:x=1", "long".repeat(100));
    let rows = fs::read_to_string(out.join("runs.csv")).expect("rows");
    fs::write(out.join("runs.csv"), rows.replace("lamp,uniform", &format!("{long},{long}"))).expect("written");
    edit(&out, |r| {
        r["scenes"][0]["name"] = json!(long);
        let summaries = r["scenes"][0]["summaries"].as_array_mut().expect("rows");
        summaries.iter_mut().filter(|s| s["strategy"] == "uniform").for_each(|s| s["strategy"] = json!(long));
    });
    citylights().arg("report").arg(&out).assert().success();
    let pages = fs::read_dir(&out).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    let pages: Vec<String> =
        pages.map(|name| name.into_string().expect("text")).filter(|n| n.starts_with("long")).collect();
    assert!(pages.len() >= 2 && pages.iter().all(|name| name.len() < 200), "{pages:?}");
    // As long as a file's name may be, and one letter longer.
    let picture = |letters: usize| folder.path(&format!("{}.png", "p".repeat(letters)));
    let render = |to: &Path| {
        citylights().arg("render").arg(folder.path("lamp.toml")).args(["--spp", "1", "-o"]).arg(to).assert()
    };
    render(&picture(251)).success();
    assert!(picture(251).exists());
    render(&picture(252)).code(2).stderr(contains("cannot write").and(contains("too long")));
}

#[test]
fn a_cached_tile_is_of_the_scene_that_it_says() {
    let folder = Folder::new();
    let lamp = folder.scene("lamp.toml", "lamp");
    let bright = folder.with("bright.toml", LAMP.replace("intensity = 100", "intensity = 9000"));
    let reference = |scene: &Path, cache: &str, to: &str| {
        let mut command = citylights();
        command.arg("reference").arg(scene).args(["--noise", "1e-3", "-o"]).arg(folder.path(to));
        command.arg("--cache").arg(folder.path(cache)).assert().success();
        fs::read(folder.path(to)).expect("a picture")
    };
    let (right, other) = (reference(&lamp, "a", "a.exr"), reference(&bright, "b", "b.exr"));
    assert!(right != other, "they look the same");
    let files = |cache: &str| {
        let files = fs::read_dir(folder.path(cache)).expect("a cache").map(|entry| entry.expect("an entry").path());
        files.collect::<Vec<_>>()
    };
    // Every tile of the other scene under the name of each of this one's.
    let mut copied = 0;
    for (own, other) in files("a").iter().flat_map(|own| files("b").into_iter().map(move |other| (own.clone(), other)))
    {
        if fs::metadata(&own).expect("there").len() == fs::metadata(&other).expect("there").len() {
            fs::copy(other, own).expect("copied");
            copied += 1;
        }
    }
    assert!(copied > 0, "nothing was copied");
    assert!(reference(&lamp, "a", "now.exr") == right, "another scene's tiles are taken");
}

/// Starts the program so that permissions bind it even where an administrator runs the tests.
#[cfg(target_os = "linux")]
fn bound_by_permissions(command: &mut std::process::Command) -> std::process::Output {
    std::thread::scope(|scope| {
        let started = scope.spawn(|| {
            // Of this thread and what it starts alone. Nobody but an administrator has it, or may give it up.
            for capability in
                [rustix::thread::CapabilitySet::DAC_OVERRIDE, rustix::thread::CapabilitySet::DAC_READ_SEARCH]
            {
                let _ = rustix::thread::remove_capability_from_bounding_set(capability);
            }
            command.output().expect("it starts")
        });
        started.join().expect("ended")
    })
}

#[cfg(target_os = "linux")]
#[test]
fn a_whole_cache_may_be_read_only() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let lamp = folder.scene("lamp.toml", "lamp");
    let cache = folder.path("cache");
    let reference = |to: &str, more: &[&str]| {
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("citylights"));
        command.arg("reference").arg(&lamp).arg("-o").arg(folder.path(to)).arg("--cache").arg(&cache).args(more);
        bound_by_permissions(&mut command)
    };
    let said = |output: &std::process::Output| {
        [&output.stdout[..], &output.stderr].concat().iter().map(|b| *b as char).collect::<String>()
    };
    let first = reference("first.exr", &[]);
    assert!(first.status.success(), "{}", said(&first));
    let permit = |mode: u32, file: u32| {
        fs::read_dir(&cache).expect("a cache").for_each(|entry| {
            let path = entry.expect("an entry").path();
            fs::set_permissions(path, fs::Permissions::from_mode(file)).expect("permitted");
        });
        fs::set_permissions(&cache, fs::Permissions::from_mode(mode)).expect("permitted");
    };
    permit(0o555, 0o444);
    // Of another size: nothing of it is there, and it cannot be kept.
    let refused = reference("other.exr", &["--resolution", "16x9"]);
    let again = reference("again.exr", &[]);
    permit(0o755, 0o644);
    assert_eq!(refused.status.code(), Some(2), "permissions bind nobody here: {}", said(&refused));
    assert!(said(&refused).contains("cache") && said(&refused).contains("ermission"), "{}", said(&refused));
    assert!(again.status.success() && said(&again).contains("from the cache"), "{}", said(&again));
    assert!(fs::read(folder.path("first.exr")).expect("a picture") == fs::read(folder.path("again.exr")).expect("one"));
}
