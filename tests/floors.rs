//! The house plan: a module imports only from lower floors, and no file grows beyond what can be read.

use std::fs;
use std::path::{Path, PathBuf};

/// Every top-level module and its floor, as in the design.
const FLOORS: [(&str, u8); 16] = [
    ("base", 0),
    ("scene", 1),
    ("record", 1),
    ("image", 1),
    ("visibility", 2),
    ("shading", 2),
    ("export", 2),
    ("strategy", 3),
    ("render", 4),
    ("verify", 5),
    ("stability", 5),
    ("measure", 6),
    ("report", 7),
    ("peers", 7),
    ("study", 8),
    ("cli", 9),
];

/// A file may not be longer than this many lines.
const LONGEST: usize = 800;

fn floor(module: &str) -> Option<u8> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The text without what follows `//`; lines stay where they are.
fn without_comments(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// The top-level modules named after each `crate::`, with their lines.
fn imports(text: &str) -> Vec<(usize, String)> {
    let text = without_comments(text);
    let mut found = Vec::new();
    for (at, _) in text.match_indices("crate::") {
        if text[..at].chars().next_back().is_some_and(is_word) {
            continue;
        }
        let rest = &text[at + "crate::".len()..];
        let line = |offset: usize| text[..at + "crate::".len() + offset].matches('\n').count() + 1;
        if !rest.starts_with('{') {
            found.push((line(0), rest.chars().take_while(|&c| is_word(c)).collect()));
            continue;
        }
        let (mut depth, mut fresh) = (0, false);
        for (offset, c) in rest.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                break;
            }
            if depth == 1 && (c == '{' || c == ',') {
                fresh = true;
            } else if fresh && is_word(c) {
                found.push((line(offset), rest[offset..].chars().take_while(|&c| is_word(c)).collect()));
                fresh = false;
            }
        }
    }
    found
}

/// What is wrong with the imports of a file of `module`.
fn violations(module: &str, file: &str, text: &str) -> Vec<String> {
    let Some(own) = floor(module) else { return vec![format!("{file}: module `{module}` is on no floor")] };
    imports(text)
        .into_iter()
        .filter(|(_, imported)| imported != module)
        .filter_map(|(line, imported)| match floor(&imported) {
            Some(other) if other < own => None,
            Some(other) => {
                Some(format!("{file}:{line}: `{module}` (floor {own}) imports `{imported}` (floor {other})"))
            }
            None => Some(format!("{file}:{line}: `{imported}` is on no floor")),
        })
        .collect()
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

/// Files below src with their module, `None` for lib.rs and main.rs.
fn sources() -> Vec<(Option<String>, String, String)> {
    files(&root())
        .into_iter()
        .map(|path| {
            let relative = path.strip_prefix(root()).expect("below src").to_path_buf();
            let top = relative.iter().next().expect("a part").to_string_lossy().into_owned();
            let module = (!["lib.rs", "main.rs"].contains(&&*top)).then(|| top.trim_end_matches(".rs").to_owned());
            (module, format!("src/{}", relative.display()), fs::read_to_string(&path).expect("a source"))
        })
        .collect()
}

#[test]
fn every_module_imports_from_lower_floors_alone() {
    let sources = sources();
    assert!(sources.len() > 40, "only {} files were read", sources.len());
    let count: usize = sources.iter().map(|(_, _, text)| imports(text).len()).sum();
    assert!(count > 100, "only {count} imports were found");
    let wrong: Vec<String> = sources
        .iter()
        .filter_map(|(module, file, text)| Some(violations(module.as_deref()?, file, text)))
        .flatten()
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_module_of_the_library_is_on_a_floor() {
    let lib = fs::read_to_string(root().join("lib.rs")).expect("lib.rs");
    let modules: Vec<&str> =
        lib.lines().filter_map(|line| line.trim().split("mod ").nth(1)?.strip_suffix(';')).collect();
    assert!(modules.len() >= 7, "{modules:?}");
    let lost: Vec<&&str> = modules.iter().filter(|module| floor(module).is_none()).collect();
    assert!(lost.is_empty(), "on no floor: {lost:?}");
}

#[test]
fn no_file_is_longer_than_eight_hundred_lines() {
    let long: Vec<String> = sources()
        .into_iter()
        .filter(|(_, _, text)| text.lines().count() > LONGEST)
        .map(|(_, file, text)| format!("{file}: {} lines", text.lines().count()))
        .collect();
    assert!(long.is_empty(), "{long:?}");
}

#[test]
fn made_up_violations_are_found() {
    let text = "//! See crate::cli.\nuse crate::base::error::Error;\nuse crate::{\n    scene::{Scene, light},\n    render::film,\n};\nfn f() { crate::strategy::g(); }\nuse crate::shading::x;\n";
    let found = violations("visibility", "a.rs", text);
    assert_eq!(
        found,
        [
            "a.rs:5: `visibility` (floor 2) imports `render` (floor 4)",
            "a.rs:7: `visibility` (floor 2) imports `strategy` (floor 3)",
            "a.rs:8: `visibility` (floor 2) imports `shading` (floor 2)",
        ]
    );
    assert_eq!(violations("attic", "b.rs", "").len(), 1);
    assert!(violations("cli", "c.rs", text).is_empty());
}

/// Ways to read a clock.
const CLOCKS: [&str; 4] = ["ThreadTime", "ProcessTime", "cpu_time", "Instant"];

/// Files that may, and why.
const READERS: [(&str, &str); 5] = [
    ("src/measure/clock.rs", "what the engine reads"),
    ("src/measure/reference.rs", "the reference says what it cost itself"),
    ("src/peers/script.rs", "how long another program may be silent"),
    ("src/cli/progress.rs", "how long is left"),
    ("src/visibility/stage.rs", "what all strategies share, off their clocks"),
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
        .map(|(_, file, text)| (file, clocks(&text)))
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
