//! Promise: `compare --tune` compares each strategy at the best parameters that other cities show, beside its defaults; what
//! was found can be used again for its like, and for nothing else.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A comparison in `folder`, small enough for a test.
fn compare(folder: &Path, out: &str, arguments: &str) -> Assert {
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.arg("compare").args(arguments.split(' ')).args("--resolution 32x18 --threads 1 --budget 4".split(' '));
    command.args("--repeats 2 --seconds 0.1 --reference-work 2 --out".split(' ')).arg(folder.join(out));
    command.arg("--cache").arg(folder.join("cache")).assert()
}

fn refused(folder: &Path, arguments: &str, said: &[&str]) {
    let assert = compare(folder, "never", arguments).code(2).stdout("");
    said.iter().fold(assert, |assert, text| assert.stderr(contains(*text)));
    assert!(!folder.join("never").exists(), "{arguments}");
}

fn json(file: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(file).expect("a file")).expect("JSON")
}

/// The strategies that have rows.
fn strategies(out: &Path) -> BTreeSet<String> {
    let record = json(&out.join("run.json"));
    let summaries = record["scenes"][0]["summaries"].as_array().expect("summaries");
    summaries.iter().map(|summary| summary["strategy"].as_str().expect("a name").to_owned()).collect()
}

const TUNE: &str = "scenes/first-night.toml --tune --tune-time 0.01 -s power:picks={1,8},null";

#[test]
fn the_best_of_other_cities_has_a_row_beside_the_default_and_is_found_once() {
    let temporary = tempfile::tempdir().expect("a folder");
    let folder = temporary.path();
    let said = "parameters found by tuning on 5 cities of other seeds (tuned.json); default rows beside them";
    compare(folder, "out", TUNE).success().stdout(contains(said)).stderr(contains("tuning").and(contains("best at")));
    let out = folder.join("out");
    let file = out.join("tuned.json");
    let tuned = json(&file);
    let best = tuned["strategies"][0]["best"].as_str().expect("a best").to_owned();
    let expected = BTreeSet::from([best.clone(), "power".to_owned(), "null".to_owned()]);
    assert_eq!(strategies(&out), expected);
    let cities = tuned["cities"].as_array().expect("cities");
    assert!(cities.len() == 5 && cities.iter().all(|city| city["seed"] != 7), "{cities:?}");

    // The page and the plot follow from the file.
    let page = fs::read_to_string(out.join("tuned-first-night.md")).expect("a page");
    assert!(page.contains(&format!("`{best}`<br>best")) && page.contains("frontier-first-night.svg"), "{page}");
    let report = |code: i32| {
        let mut command = Command::cargo_bin("citylights").expect("the binary");
        command.arg("report").arg(&out).arg("--check").assert().code(code)
    };
    report(0);
    fs::write(out.join("frontier-first-night.svg"), "another").expect("written");
    report(1).stdout(contains("frontier-first-night.svg"));

    // Used again, nothing is tuned.
    let again = format!("scenes/first-night.toml --tuned {} -s power:picks={{1,8}},null", file.display());
    compare(folder, "again", &again).success().stdout(contains(said)).stderr(contains("tuning").not());
    assert_eq!(strategies(&folder.join("again")), expected);
    assert_eq!(fs::read(folder.join("again/tuned.json")).expect("a file"), fs::read(&file).expect("a file"));

    // An interrupted comparison goes on with what was found: here with the default, as somebody has changed it.
    let mut record = json(&out.join("run.json"));
    record["finished"] = false.into();
    record["scenes"] = Value::Array(Vec::new());
    fs::write(out.join("run.json"), record.to_string()).expect("written");
    let mut changed = tuned.clone();
    changed["strategies"][0]["best"] = "power".into();
    fs::write(&file, changed.to_string()).expect("written");
    compare(folder, "out", TUNE).success().stderr(contains("tuning").not());
    assert_eq!(strategies(&out), BTreeSet::from(["power".to_owned(), "null".to_owned()]));
    // Another time to tune for is another comparison.
    compare(folder, "out", &TUNE.replace("0.01", "0.02")).code(2).stderr(contains("scenes or options"));

    // For another condition, or for a city that it was tuned on, it is of no use.
    for (options, said) in [
        ("-s power --receivers spread", "`condition.receivers`: is centre, this is spread"),
        ("-s power --ev100 2", "`condition.hash`"),
        ("-s power,uniform", "says nothing of `uniform`"),
        (&format!("-s power --scene-seed {}", cities[2]["seed"]), "`cities[2]`"),
        ("-s power --tune", "--tune"),
    ] {
        refused(folder, &format!("scenes/first-night.toml --tuned {} {options}", file.display()), &[said]);
    }
    let other = format!("scenes/lamps-only.toml --tuned {} -s power", file.display());
    refused(folder, &other, &["`condition.recipe`: is first-night, this is lamps-only"]);
    let text = fs::read_to_string(&file).expect("a file").replacen("\"rates\":", "\"rates\":9", 1);
    fs::write(&file, text).expect("written");
    refused(folder, &again, &["`rates`", "tune again"]);
}

#[test]
fn each_recipe_is_tuned_for_by_itself() {
    let temporary = tempfile::tempdir().expect("a folder");
    let folder = temporary.path();
    let recipe = fs::read_to_string("scenes/first-night.toml").expect("a recipe");
    let second = folder.join("second.toml");
    fs::write(&second, recipe.replace("first-night", "second").replace("lights = 1200", "lights = 600"))
        .expect("written");
    let both = format!("{TUNE} {} --cities 2 --views street,roof", second.display());
    compare(folder, "out", &both)
        .success()
        .stdout(contains("(tuned-first-night.json)").and(contains("(tuned-second.json)")));
    let [first, second] = ["first-night", "second"].map(|name| json(&folder.join(format!("out/tuned-{name}.json"))));
    assert_eq!((&first["condition"]["recipe"], &second["condition"]["lights"]), (&"first-night".into(), &600.into()));
    for name in ["frontier-first-night.svg", "frontier-second.svg", "tuned-second.md", "replicates-second.md"] {
        assert!(folder.join("out").join(name).exists(), "{name}");
    }
}

#[test]
fn what_cannot_be_tuned_is_refused_before_anything_is_measured() {
    let temporary = tempfile::tempdir().expect("a folder");
    let folder = temporary.path();
    let right = "--tune is for recipes with a table [city]";
    refused(folder, "tests/data/street.toml --tune -s power", &["street.toml", "no generated city", right]);
    let file = folder.join("street.glb");
    let mut export = Command::cargo_bin("citylights").expect("the binary");
    export.args(["export", "tests/data/street.toml", "--to", "gltf", "-o"]).arg(&file).assert().success();
    refused(folder, &format!("{} --tune -s power", file.display()), &["street.glb", "no seed can be given", right]);
    let first = "scenes/first-night.toml";
    refused(folder, &format!("{first} --tune -s power:picks={{}}"), &["holds no values", "light-tree:arity={2,4,8}"]);
    refused(folder, &format!("{first} --tune -s power:pick={{1,2}}"), &["near it: picks"]);
    refused(folder, &format!("{first} --tune -s null"), &["nothing can be tuned", "sweep a parameter"]);
    refused(folder, &format!("{first} --tune --tune-time 0 -s power"), &["above 0"]);
    refused(folder, &format!("{first} --tune-time 1 -s power"), &["--tune"]);
    refused(folder, &format!("{first} --tuned {first} -s power"), &["first-night.toml:1", "`--tune` wrote is wanted"]);
    refused(folder, &format!("{first} --tuned no/such.json -s power"), &["no/such.json"]);
}

#[test]
fn defaults_alone_say_so() {
    let temporary = tempfile::tempdir().expect("a folder");
    let line = "every strategy at its defaults or as named";
    compare(temporary.path(), "a", "scenes/first-night.toml -s power,null").success().stdout(contains(line));
    compare(temporary.path(), "b", "tests/data/street.toml -s power:picks=2,mix=0.25,null")
        .success()
        .stdout(contains(line).not());
}
