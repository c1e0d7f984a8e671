//! Promise: whatever stands in a file, what is said of it is text, fits the terminal, and names what is near alone.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const LAMP: &str = include_str!("../data/lamp.toml");
const VECTORS: &str = include_str!("../data/triangle.csv");

fn citylights() -> Command {
    Command::cargo_bin("citylights").expect("the binary")
}

/// A finished comparison of every strategy, in a folder of its own.
fn compared() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("lamp.toml"), LAMP).expect("written");
    let out = folder.path().join("out");
    compare(&folder, &out).assert().success();
    (folder, out)
}

fn compare(folder: &TempDir, out: &Path) -> Command {
    let mut command = citylights();
    command.arg("compare").arg(folder.path().join("lamp.toml")).args(["--budget", "4", "--repeats", "3", "--out"]);
    command.arg(out).arg("--cache").arg(folder.path().join("cache"));
    command
}

/// Nothing in it commands a terminal, and the commands that a file held are written out.
fn harmless(output: &std::process::Output) -> String {
    let text = String::from_utf8([&output.stdout[..], &output.stderr].concat()).expect("text");
    let bad = text.chars().find(|c| c.is_control() && *c != '\n');
    assert!(bad.is_none(), "{bad:?} in {text:?}");
    assert!(text.contains("\\u001b"), "the file's text is not told at all: {text}");
    text
}

#[test]
fn text_of_files_commands_no_terminal() {
    let (folder, out) = compared();
    let file = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).expect("written");
        folder.path().join(name)
    };
    let run = |command: &mut Command| command.output().expect("it runs");
    // A category of exact values, a field and a name of a recipe, an argument.
    let row = VECTORS.lines().nth(1).expect("a row");
    let bad = row.replacen(row.split(',').next().expect("a category"), "\u{1b}]0;title\u{7}", 1);
    let vectors = file("v.csv", &format!("{}\n{bad}\n", VECTORS.lines().next().expect("a header")));
    harmless(&run(citylights().args(["stability", "--vectors"]).arg(&vectors)));
    let field = file("field.toml", &LAMP.replace("fov = 50", "\"\\u001b[2J\" = 50"));
    harmless(&run(citylights().arg("inspect").arg(&field)));
    harmless(&run(citylights().arg("inspect").arg(folder.path().join("\u{1b}[31m.toml"))));
    // Rows of a strategy that the record does not name, and a record's own texts.
    let rows = fs::read_to_string(out.join("runs.csv")).expect("rows");
    fs::write(out.join("runs.csv"), rows.replacen(",uniform,", ",\u{1b}[2J\u{9b},", 1)).expect("written");
    let said = harmless(&run(citylights().arg("report").arg(&out).arg("--check")));
    assert!(said.contains("\\u001b[2J\\u009b"), "{said}");
    fs::write(out.join("runs.csv"), rows).expect("written");
    edit(&out, |r| r["scenes"][0]["notes"] = json!(["\u{1b}[2Jcleared\u{202e}", "\r\u{8}\u{7f}"]));
    let said = harmless(&run(&mut compare(&folder, &out)));
    assert!(said.contains("\\u001b[2Jcleared\\u202e") && said.contains("\\u000d\\u0008\\u007f"), "{said}");
}

/// Changes the record of a comparison.
fn edit(folder: &Path, change: impl FnOnce(&mut Value)) {
    let path = folder.join("run.json");
    let mut record: Value = serde_json::from_slice(&fs::read(&path).expect("a record")).expect("JSON");
    change(&mut record);
    fs::write(&path, record.to_string()).expect("written");
}

#[test]
fn text_of_records_is_no_markup_in_a_page() {
    let (folder, out) = compared();
    let tag = "<img src=x onerror=alert(1)>";
    edit(&out, |r| {
        r["command"] = json!(format!("```\n{tag}"));
        r["warnings"] = json!([tag]);
        r["machine"]["cpu"] = json!(tag);
        r["revision"] = json!(format!("{tag} `"));
        let scene = &mut r["scenes"][0];
        (scene["file"], scene["notes"]) = (json!(tag), json!([tag, format!("a\n\n{tag}")]));
        let summaries = scene["summaries"].as_array_mut().expect("rows");
        summaries[0]["error"] = json!(tag);
        let biased =
            summaries.iter_mut().find(|s| s["claim"]["kind"] == "biased").expect("one of all strategies is biased");
        biased["claim"]["why"] = json!(format!("| {tag}"));
    });
    citylights().arg("report").arg(&out).args(["--splice"]).arg(folder.path().join("README.md")).assert().success();
    for page in [out.join("lamp.md"), folder.path().join("README.md")] {
        let text = fs::read_to_string(&page).expect("a page");
        let mut fence = None;
        for line in text.lines() {
            // In a block of code a tag is text, to the fence that has as many marks.
            let marks = line.chars().take_while(|c| *c == '`').count();
            match fence {
                None if marks >= 3 => fence = Some(marks),
                Some(open) if marks >= open && line.len() == marks => fence = None,
                Some(_) => {}
                None => assert!(
                    !line
                        .replace(&format!("` ```  {tag} `"), "")
                        .replace(&format!("```` ```  {tag}"), "")
                        .replace(&format!("```` ``` {tag} ````"), "")
                        .contains("<img"),
                    "{}: {line}",
                    page.display()
                ),
            }
        }
        assert!(text.matches("&lt;img").count() >= 5, "{}: it is not told at all", page.display());
    }
    let svg = fs::read_to_string(out.join("lamp.svg")).expect("a plot");
    assert!(!svg.contains("<img"), "{svg}");
}

#[test]
fn only_what_is_near_is_called_near() {
    let refused = |arguments: &str| {
        let output = citylights().args(arguments.split(' ')).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        String::from_utf8(output.stderr).expect("text")
    };
    for (arguments, near, all) in [
        ("render scenes/shadows.toml -o x.png -s influense", "near it: influence", ""),
        ("render scenes/shadows.toml -o x.png -s qqq", "", "there are null, "),
        ("render scenes/shadows.toml -o x.png -s power:qqq=2", "", "there are "),
        ("study qqq", "", "there are strategies, visible, elsewhere, cutoff, scaling, soft-shadows, offsets"),
        ("lecture ofsets", "near it: offsets", ""),
        ("compare scenes/shadows.toml --peer qqq", "", "there are cycles, mitsuba"),
        ("export scenes/shadows.toml --to qqq -o x.glb", "", "there are "),
        ("inspect scenes/shadows.toml --offset qqq", "", "one of scaled, "),
        ("verify --only qqq", "", "there are "),
    ] {
        let said = refused(arguments);
        assert_eq!(said.contains("near it"), !near.is_empty(), "{arguments}: {said}");
        let lists = said.contains("there are") || said.contains("one of");
        assert_eq!(lists, !all.is_empty(), "{arguments}: {said}");
        assert!(said.contains(near) && said.contains(all), "{arguments}: {said}");
    }
}

#[test]
fn an_exposure_that_cannot_be_is_the_option_s_mistake() {
    for verb in ["inspect scenes/shadows.toml", "render scenes/shadows.toml -o x.png", "diff-image a.exr b.exr"] {
        for value in ["3.4e38", "1e-38", "0", "-1", "nan", "inf"] {
            let mut command = citylights();
            command.args(verb.split(' ')).arg(format!("--exposure={value}"));
            let named = contains("--exposure").and(contains("from 1e-17 to 1e17")).and(contains("shadows.toml").not());
            command.assert().code(2).stdout("").stderr(named);
        }
    }
    for value in ["1e-17", "1e17"] {
        let mut command = citylights();
        command
            .args(["inspect", "scenes/shadows.toml", "--resolution", "16x9", "--exposure", value])
            .assert()
            .success();
    }
}

/// What the program prints on a terminal of so many columns.
#[cfg(unix)]
fn on_a_terminal(command: &mut std::process::Command, columns: u16) -> String {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::io::Read;
    let terminal = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a terminal");
    grantpt(&terminal).and_then(|()| unlockpt(&terminal)).expect("its other end");
    let size = rustix::termios::Winsize { ws_row: 40, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 };
    rustix::termios::tcsetwinsize(&terminal, size).expect("its size");
    let name = ptsname(&terminal, Vec::new()).expect("a name").into_string().expect("text");
    let open = || fs::OpenOptions::new().read(true).write(true).open(&name).expect("its other end");
    let mut child = command.stdout(open()).stderr(std::process::Stdio::null()).spawn().expect("it starts");
    // Kept open, else reading may fail before anything is there.
    let kept = open();
    let reader = std::thread::spawn(move || {
        let (mut terminal, mut text, mut block) = (fs::File::from(terminal), Vec::new(), [0; 4096]);
        while let Ok(n @ 1..) = terminal.read(&mut block) {
            text.extend_from_slice(&block[..n]);
            if text.ends_with(END) {
                break;
            }
        }
        String::from_utf8(text).expect("text")
    });
    assert!(child.wait().expect("ended").success());
    let mut end = kept;
    std::io::Write::write_all(&mut end, b"\nthe end").expect("written");
    reader.join().expect("read").replace('\r', "")
}

#[cfg(unix)]
const END: &[u8] = b"\nthe end";

#[cfg(unix)]
#[test]
fn no_table_is_wider_than_the_terminal() {
    let (folder, out) = compared();
    let long = "a-strategy-whose-name-has-no-place-where-it-could-be-broken-at-all:mix=0.5";
    edit(&out, |r| {
        let summaries = r["scenes"][0]["summaries"].as_array_mut().expect("rows");
        summaries.iter_mut().filter(|s| s["strategy"] == "power").for_each(|s| s["strategy"] = json!(long));
    });
    let shown = |columns: u16| {
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("citylights"));
        command.arg("compare").arg(folder.path().join("lamp.toml"));
        command
            .args(["--budget", "4", "--repeats", "3", "--out"])
            .arg(&out)
            .arg("--cache")
            .arg(folder.path().join("cache"));
        on_a_terminal(&mut command, columns)
    };
    let wide = shown(300);
    let piped = compare(&folder, &out).output().expect("it runs");
    assert_eq!(wide.trim_end_matches("the end").trim_end(), String::from_utf8(piped.stdout).expect("text").trim_end());
    for columns in [60, 80, 100, 139] {
        let text = shown(columns);
        let widest = text.lines().max_by_key(|line| line.chars().count()).expect("lines");
        assert!(widest.chars().count() <= columns.into(), "{} of {columns} columns: {widest}", widest.chars().count());
        // All figures are there, each whole.
        let figures = |text: &str| {
            let mut all: Vec<String> = text
                .split_whitespace()
                .filter(|w| w.starts_with(|c: char| c.is_ascii_digit()) && w.contains('.'))
                .map(str::to_owned)
                .collect();
            all.sort();
            all.dedup();
            all
        };
        let (there, lost) = (figures(&text), figures(&wide));
        let lost: Vec<&String> = lost.iter().filter(|figure| !there.contains(figure)).collect();
        assert!(lost.is_empty(), "{columns} columns: {lost:?} are lost in\n{text}");
        assert!(text.contains("x oracle") || !wide.contains("x oracle"), "{text}");
    }
    let mut inspect = std::process::Command::new(assert_cmd::cargo::cargo_bin("citylights"));
    inspect.arg("inspect").arg(folder.path().join("lamp.toml"));
    let table = on_a_terminal(&mut inspect, 30);
    let table: Vec<&str> = table.lines().skip_while(|line| !line.contains("kind")).take(3).collect();
    assert!(table.len() == 3 && table.iter().all(|line| line.chars().count() <= 30), "{table:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn every_verb_takes_paths_that_are_not_utf8() {
    use std::ffi::{OsStr, OsString};
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &[u8]| folder.path().join(OsStr::from_bytes(name));
    let scene = path(b"s\xff.toml");
    fs::write(&scene, LAMP).expect("written");
    fs::write(path(b"v\xff.csv"), VECTORS).expect("written");
    let (exr, cache) = (path(b"p\xff.exr"), path(b"c\xff"));
    let run = |verb: &str, files: &[(&str, &Path)], code: i32| {
        let mut command = citylights();
        command.args(verb.split(' '));
        files.iter().for_each(|(option, file)| {
            command.args(Some(option).filter(|option| !option.is_empty())).arg(file);
        });
        command.assert().code(code).stderr(contains("panicked").not());
    };
    run("render --spp 1", &[("", &scene), ("-o", &exr)], 0);
    run("reference", &[("", &scene), ("-o", &path(b"r\xff.exr")), ("--cache", &cache)], 0);
    run("diff-image", &[("", &exr), ("", &exr), ("--mask", &exr), ("-o", &path(b"m\xff.png"))], 0);
    run("diff-image", &[("", &exr), ("", &exr), ("-o", &path(b"m\xff.png"))], 0);
    run("inspect", &[("", &scene)], 0);
    run("explain -s power --pixel 8,8", &[("", &scene)], 0);
    run("export --to gltf", &[("", &scene), ("-o", &path(b"g\xff.glb"))], 0);
    run("inspect", &[("", &path(b"g\xff.glb"))], 0);
    run("verify --gate -s power", &[("", &scene)], 0);
    run("stability", &[("--vectors", &path(b"v\xff.csv"))], 0);
    run(
        "compare --budget 1 --repeats 2 -s uniform",
        &[("", &scene), ("--out", &path(b"o\xff")), ("--cache", &cache)],
        0,
    );
    run("report", &[("", &path(b"o\xff")), ("--splice", &path(b"R\xff.md"))], 0);
    run("report --check", &[("", &path(b"o\xff")), ("--splice", &path(b"R\xff.md"))], 0);
    run("lecture areas", &[("--scene", &scene), ("-o", &path(b"l\xff.svg"))], 2);
    run("new-strategy my-lights", &[("--library", &path(b"none\xff"))], 2);
    // Where text is asked for.
    for verb in [&["render", "x", "-o", "y.png", "-s"][..], &["study"], &["list"], &["export", "x", "-o", "y", "--to"]]
    {
        let mut arguments: Vec<OsString> = verb.iter().map(OsString::from).collect();
        arguments.push(OsString::from(OsStr::from_bytes(b"\xff")));
        citylights().args(arguments).assert().code(2).stderr(contains("panicked").not());
    }
}
