//! `stability` shows where arithmetic breaks and that ours does not; a file that cannot be used is said to be so.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;

/// A few rows of each category of the exact values that the project was given.
const VECTORS: &[u8] = include_bytes!("../data/triangle.csv");

/// The categories that the rows are of.
fn categories() -> Vec<&'static str> {
    let text = std::str::from_utf8(VECTORS).expect("text");
    let mut names: Vec<&str> = text.lines().skip(1).filter_map(|row| row.split(',').next()).collect();
    names.dedup();
    names
}

fn stability(arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("citylights").expect("the binary").arg("stability").args(arguments).assert()
}

/// The header without the sign of a remark.
fn header() -> String {
    let text = String::from_utf8_lossy(VECTORS);
    text.lines().next().expect("a header").trim_start_matches(['#', ' ']).to_owned()
}

/// A file of the header and these rows.
fn file(rows: &str) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().expect("a file");
    let header = String::from_utf8_lossy(VECTORS).lines().next().expect("a header").to_owned();
    std::fs::write(file.path(), format!("{header}\n{rows}")).expect("written");
    file
}

const ROW: &str = "ordinary,1,0,0,0,1,0,0,0,1,0,0,1,1.5707963267948966,0.7853981633974483";

#[test]
fn the_table_of_a_file_shows_every_category_and_the_textbook() {
    let shown =
        categories().iter().fold(stability(&["--vectors", "tests/data/triangle.csv"]).success(), |shown, name| {
            shown.stdout(contains(*name))
        });
    shown
        .stdout(contains("textbook, f32").and(contains("every error is within its limit")).and(contains("FAIL").not()));
}

#[test]
fn the_table_of_cases_has_every_group() {
    let groups = [
        "solid-angle/sliver",
        "irradiance/vertex",
        "solid-angle-sample/",
        "choice/",
        "light-tree/",
        "influence/",
        "offset",
    ];
    groups.iter().fold(stability(&[]).success(), |shown, name| shown.stdout(contains(*name)));
}

#[test]
fn an_octant_is_right_and_a_false_claim_about_it_fails() {
    stability(&["--vectors", file(ROW).path().to_str().expect("a name")]).success();
    for (from, to, said) in [
        ("1.5707963267948966", "1.5708", "1 beyond its limit: solid angle of ordinary"),
        ("0.7853981633974483", "0.78541", "1 beyond its limit: irradiance of ordinary"),
        // Right but for the side it is seen from.
        ("1.5707963267948966", "-1.5707963267948966", "solid angle of ordinary"),
    ] {
        let file = file(&ROW.replace(from, to));
        let failed = stability(&["--vectors", file.path().to_str().expect("a name")]).code(1);
        failed.stdout(contains("FAIL").and(contains(said)));
    }
}

#[test]
fn a_malformed_file_is_refused_with_line_and_column() {
    for (rows, said) in [
        (ROW.replace(",0,0,1,1.57", ",0,zero,1,1.57"), ":2: `ny`: column 12: `zero` is not a finite number"),
        (format!("{ROW}\n{}", ROW.replace("1,0,0,0,1", "1,nan,0,0,1")), ":3: `ay`: column 3: `nan` is not a finite"),
        (ROW.replace("1,0,0,0,1", "1,1e39,0,0,1"), ":2: `ay`: column 3: `1e39` is beyond f32"),
        (
            ROW.replace("ordinary", "ordinery"),
            ":2: `category`: column 1: unknown category `ordinery`; near it: ordinary",
        ),
        (ROW.replace(",0.7853981633974483", ""), ":2: `irradiance`: column 15: the row ends here, with 14 columns"),
        (format!("{ROW},7"), ":2: column 16: the row goes on here, with 16 columns"),
        (ROW.replace(",0,0,1,1.57", ",0,0,0,1.57"), ":2: `nx`: column 11: the normal's length is 0; 1 is right"),
        (ROW.replace("1.5707963267948966", "7"), ":2: `solid_angle`: column 14: 7 sr"),
        (ROW.replace(",0.78", ",-0.78"), ":2: `irradiance`: column 15: -0.78"),
        (format!("# a remark\n\n{ROW}\n\"{ROW}\n"), ":5: `category`: column 1"),
        (String::new(), ":1: `category`: column 1: there are no rows"),
    ] {
        let file = file(&rows);
        let name = file.path().to_str().expect("a name");
        stability(&["--vectors", name]).code(2).stdout("").stderr(contains(format!("{name}{said}")));
    }
    let header = header();
    for (header, said) in [
        (header.replace("ax,ay,az", "ax,az,ay"), ":1: `ay`: column 3: the header says `az`; `ay` is right"),
        (format!("# {}", header.replace("nx,ny", "ny,nx")), ":1: `nx`: column 11: the header says `ny`; `nx` is right"),
        (format!("#{header},remark"), ":1: column 16: the header goes on with `remark`; 15 columns are right"),
        (header.replace(",irradiance", ""), ":1: `irradiance`: column 15: the header ends here, with 14 columns"),
        (format!("{header}\n{ROW}\n# category,bx"), ":3: `ax`: column 2: the header says `bx`; `ax` is right"),
    ] {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), format!("{header}\n{ROW}\n")).expect("written");
        let name = file.path().to_str().expect("a name");
        stability(&["--vectors", name]).code(2).stdout("").stderr(contains(format!("{name}{said}")));
    }
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), [ROW.as_bytes(), b"\nordinary,\xff,1\n"].concat()).expect("written");
    let name = file.path().to_str().expect("a name");
    stability(&["--vectors", name]).code(2).stdout("").stderr(contains(":2: `ax`: column 2: this is no text"));
    stability(&["--vectors", "no/such/file.csv"]).code(2).stderr(contains("cannot read no/such/file.csv"));
}
