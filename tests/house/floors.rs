//! The house plan: a module imports only from lower floors, no files import one another in a circle, and none grows beyond
//! what can be read.

use crate::imports::{House, Import, Place};
use std::fs;
use std::path::{Path, PathBuf};

/// Every room and its floor, as in the design.
const FLOORS: [(&str, u8); 26] = [
    ("base", 0),
    ("scene", 1),
    ("record", 1),
    ("image", 1),
    ("texture", 1),
    ("sources", 2),
    ("visibility", 3),
    ("shading", 3),
    ("export", 3),
    ("strategy", 4),
    ("tree", 5),
    ("strategies", 6),
    ("render", 7),
    ("verify", 8),
    ("stability", 8),
    ("explain", 9),
    ("measure", 9),
    ("inspect", 10),
    ("report", 10),
    ("peers", 10),
    ("bench", 10),
    ("calls", 11),
    ("study", 11),
    ("lecture", 11),
    ("prelude", 12),
    ("cli", 12),
];

/// No file is longer, in lines.
const LONGEST: usize = 400;
/// Half of all files are no longer.
const MEDIAN: usize = 120;
/// No room holds more of the lines of all.
const LARGEST_ROOM: f64 = 0.15;

fn floor(room: &str) -> Option<u8> {
    FLOORS.iter().find(|(name, _)| *name == room).map(|(_, floor)| *floor)
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The text without what follows `//`; lines stay where they are.
fn without_comments(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("src") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Files below src, by their path there, with their text; without main.rs, a program of its own.
pub(crate) fn sources() -> Vec<(String, String)> {
    let all = files(&root()).into_iter().map(|path| {
        let below = path.strip_prefix(root()).expect("below src").display().to_string();
        (below, fs::read_to_string(&path).expect("a source"))
    });
    all.filter(|(file, _)| file != "main.rs").collect()
}

fn house(sources: &[(String, String)]) -> House {
    let mut house = House::default();
    sources.iter().for_each(|(file, text)| house.add(file, text));
    house
}

/// What is wrong with an import, if anything is.
fn violation(house: &House, import: &Import) -> Option<String> {
    let (from, to) = (import.from.first()?, import.to.first()?);
    if from == to {
        return None;
    }
    let file = &house.0[&import.from].file;
    let Some(own) = floor(from) else { return Some(format!("{file}: `{from}` is on no floor")) };
    match floor(to) {
        Some(other) if other < own => None,
        Some(other) => {
            Some(format!("{file}: `{from}` (floor {own}) imports `{}` of `{to}` (floor {other})", import.path))
        }
        None => Some(format!("{file}: `{to}` is on no floor")),
    }
}

#[test]
fn every_room_imports_from_lower_floors_alone() {
    let house = house(&sources());
    assert!(house.0.len() > 200, "only {} files were read", house.0.len());
    let imports = house.imports();
    assert!(imports.len() > 1_000, "only {} imports were found", imports.len());
    let wrong: Vec<String> = imports.iter().filter_map(|import| violation(&house, import)).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_room_is_on_a_floor() {
    let house = house(&sources());
    let lost: Vec<&Place> =
        house.0.keys().filter(|place| place.first().is_some_and(|room| floor(room).is_none())).collect();
    assert!(lost.is_empty(), "on no floor: {lost:?}");
}

#[test]
fn no_files_import_one_another_in_a_circle() {
    let house = house(&sources());
    let imports = house.imports();
    let told = house.circles().into_iter().map(|circle| {
        let within = imports.iter().filter(|i| circle.contains(&i.from) && circle.contains(&i.to));
        within.map(|i| format!("{} takes {}", house.0[&i.from].file, i.path)).collect::<Vec<_>>().join("\n")
    });
    let told: Vec<String> = told.collect();
    assert!(told.is_empty(), "\n{}", told.join("\n\n"));
}

#[test]
fn no_file_and_no_room_outgrows_what_can_be_read() {
    let house = house(&sources());
    let long = house.0.values().filter(|module| module.lines > LONGEST);
    let long: Vec<String> = long.map(|module| format!("{}: {} lines", module.file, module.lines)).collect();
    assert!(long.is_empty(), "{long:?}");
    let mut lines: Vec<usize> = house.0.values().map(|module| module.lines).collect();
    lines.sort_unstable();
    assert!(lines[lines.len() / 2] <= MEDIAN, "half of all files have more than {} lines", lines[lines.len() / 2]);
    let all = lines.iter().sum::<usize>() as f64;
    for (room, _) in FLOORS {
        let own: usize =
            house.0.iter().filter(|(place, _)| place.first().is_some_and(|r| r == room)).map(|(_, m)| m.lines).sum();
        assert!(own as f64 <= LARGEST_ROOM * all, "{room} holds {own} of {all} lines");
    }
}

#[test]
fn made_up_violations_are_found() {
    let made_up = [
        ("base/error.rs".to_owned(), String::new()),
        ("base/mod.rs".to_owned(), "mod error;".to_owned()),
        ("render/mod.rs".to_owned(), "mod film;".to_owned()),
        ("render/film.rs".to_owned(), String::new()),
        ("scene/mod.rs".to_owned(), "mod camera; mod light; pub use light::Light;".to_owned()),
        ("scene/light.rs".to_owned(), "pub struct Light; fn f() { super::camera::g(); }".to_owned()),
        (
            "scene/camera.rs".to_owned(),
            "//! See crate::cli.\nuse crate::{base::error, render::film};\nfn g(_: crate::scene::Light) {}\n\
             #[cfg(test)]\nmod tests { use crate::cli::x; }"
                .to_owned(),
        ),
    ];
    let house = house(&made_up);
    let wrong: Vec<String> = house.imports().iter().filter_map(|import| violation(&house, import)).collect();
    assert_eq!(wrong, ["scene/camera.rs: `scene` (floor 1) imports `crate::render::film` of `render` (floor 7)"]);
    // One through the face of the room.
    let place = |name: &str| vec!["scene".to_owned(), name.to_owned()];
    assert_eq!(house.circles(), [vec![place("camera"), place("light")]]);
}

/// Ways to read a clock.
const CLOCKS: [&str; 4] = ["ThreadTime", "ProcessTime", "cpu_time", "Instant"];

/// Files that may, and why.
const READERS: [(&str, &str); 5] = [
    ("measure/clock.rs", "what the engine reads"),
    ("measure/reference.rs", "the reference says what it cost itself"),
    ("peers/script.rs", "how long another program may be silent"),
    ("cli/progress.rs", "how long is left"),
    ("visibility/stage.rs", "what all strategies share, off their clocks"),
];

/// Lines outside tests that read a clock.
fn clocks(text: &str) -> Vec<usize> {
    let text = without_comments(text);
    let code = text.split("#[cfg(test)]").next().unwrap_or("");
    let reads = |line: &str| line.split(|c| !is_word(c)).any(|word| CLOCKS.contains(&word));
    code.lines().zip(1..).filter(|(line, _)| reads(line)).map(|(_, number)| number).collect()
}

#[test]
fn nothing_but_the_engine_reads_a_clock_for_a_strategy() {
    let read: Vec<(String, Vec<usize>)> = sources()
        .into_iter()
        .map(|(file, text)| (file, clocks(&text)))
        .filter(|(_, lines)| !lines.is_empty())
        .collect();
    let wrong: Vec<_> = read.iter().filter(|(file, _)| READERS.iter().all(|(reader, _)| reader != file)).collect();
    assert!(wrong.is_empty(), "time strategies through measure::engine: {wrong:?}");
    for (reader, _) in READERS {
        assert!(
            read.iter().any(|(file, _)| file == reader),
            "{reader} reads no clock any more: strike it off the list"
        );
    }
    let made_up = "use std::time::Instant; // a clock\nfn f() {}\n// Instant::now()\nlet t = ThreadTime::now();\n#[cfg(test)]\nmod tests { use std::time::Instant; }";
    assert_eq!(clocks(made_up), [1, 4]);
}
