//! Promise: receivers may move from pass to pass under every verb that renders, and what cannot be done then is said.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;

const LAMP: &str = "tests/data/lamp.toml";

fn citylights(arguments: &str) -> Command {
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.args(arguments.split(' '));
    command
}

#[test]
fn what_cannot_be_done_is_refused() {
    let refused = |arguments: &str| citylights(arguments).assert().code(2).stdout("");
    for verb in ["compare", "verify", "render", "reference"] {
        let wrong = refused(&format!("{verb} {LAMP} --receivers centres"));
        wrong.stderr(contains("centre, spread, bounce")).stderr(contains("near it: centre"));
    }
    let peer = refused(&format!("compare {LAMP} --receivers bounce --peer mitsuba --out no/such"));
    peer.stderr(contains("--peer")).stderr(contains("--receivers centre"));
    refused(&format!("reference {LAMP} --receivers spread --passes 0 -o f.exr")).stderr(contains("--passes"));
}

#[test]
fn each_pass_says_where_it_is() {
    let render =
        |more: &str| citylights(&format!("render {LAMP} -s all --pixel 16,12 --spp 4{more}")).assert().success();
    let spread = render(" --receivers spread");
    let text = String::from_utf8_lossy(&spread.get_output().stdout).into_owned();
    let places: Vec<&str> = text.lines().map(|line| line.split(": [").next().unwrap_or(line)).collect();
    assert_eq!(places.len(), 4, "{text}");
    assert!(places.iter().all(|line| line.contains(" at position [")), "{text}");
    assert!(places.windows(2).all(|two| two[0][7..] != two[1][7..]), "two passes in one place: {text}");
    render(" --receivers bounce").stdout(contains("meets no surface"));
    render("").stdout(contains("pixel 16,12: position [")).stdout(contains(" at position").not());
}

#[test]
fn a_comparison_says_what_its_passes_visit() {
    let folder = tempfile::tempdir().expect("a folder");
    let compare = |receivers: &str, scene: &str| {
        let mut command = citylights(&format!("compare {scene} -s power,intensity,oracle --budget 4 --repeats 3"));
        command.args(["--receivers", receivers, "--out"]).arg(folder.path().join(receivers));
        command.arg("--cache").arg(folder.path().join("cache"));
        command
    };
    let spread = compare("spread", LAMP).assert().success();
    let page = std::fs::read_to_string(folder.path().join("spread/lamp.md")).expect("a page");
    for part in
        ["in each pass what another point of the pixel sees", "meet no surface", "run only where receivers stay"]
    {
        assert!(page.contains(part), "{part}: {page}");
    }
    spread.stdout(contains("intensity"));
    citylights("report --check").arg(folder.path().join("spread")).assert().success();
    // Nothing that leaves this plane comes back.
    let bare = folder.path().join("plane.toml");
    let plane = std::fs::read_to_string(LAMP).expect("read");
    let (before, after) = (plane.find("[[box]]").expect("a box"), plane.find("[[light]]").expect("a light"));
    std::fs::write(&bare, format!("{}{}", &plane[..before], &plane[after..])).expect("written");
    let nothing = compare("bounce", bare.to_str().expect("a name")).assert().code(1);
    nothing.stderr(contains("nothing can be measured")).stderr(contains("meets a surface"));
    // Going on there with other receivers is another comparison.
    let mut other =
        citylights(&format!("compare {LAMP} -s power,intensity,oracle --budget 4 --repeats 3 --receivers bounce"));
    other.arg("--out").arg(folder.path().join("spread")).arg("--cache").arg(folder.path().join("cache"));
    other.assert().code(2);
}

#[test]
fn strategies_keep_their_contract_wherever_passes_look() {
    for receivers in ["spread", "bounce"] {
        let mut command =
            citylights("verify tests/data/street.toml -q -s all,power,light-tree,visible,restir --draws 2000");
        command.args(["--places", "6", "--receivers", receivers]);
        command.assert().success().stdout(contains("every check passed"));
    }
}
