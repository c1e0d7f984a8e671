//! Promise: `stability` shows where arithmetic breaks and that ours does not; a file that cannot be used is said to be so.

use citylights::stability::CASES;
use citylights::stability::vectors::{CATEGORIES, judge, parse};

/// A few rows of each category of the exact values that the project was given.
const VECTORS: &[u8] = include_bytes!("../data/triangle.csv");

#[test]
fn exact_values_are_met_in_every_category() {
    let rows = parse(VECTORS, "tests/data/triangle.csv".as_ref()).expect("vectors");
    let judged = judge(&rows);
    assert_eq!(judged.len(), CATEGORIES.len());
    for one in judged {
        assert_eq!(one.solid_angle.ours.count(), 5, "{}", one.category);
        assert!(one.solid_angle.passed() && one.irradiance.passed(), "{one:?}");
        // Far inside the limits, so that another set of vectors is met as well.
        assert!(one.solid_angle.ours.worst() < 1e-9, "{one:?}");
        assert!(one.irradiance.ours.worst() < 1e-8, "{one:?}");
        if one.category == "distant" {
            let textbook = one.solid_angle.textbook.expect("the formula in f32").worst();
            assert!(textbook > 1000.0 * 2e-6, "the textbook is off by {textbook} alone");
        }
    }
}

#[test]
fn every_built_in_case_is_right() {
    for case in CASES {
        let finding = (case.run)();
        assert!(finding.passed(), "{}: worst {:e} of {:e}", case.name, finding.ours.worst(), finding.limit);
        assert!(finding.ours.count() > 100, "{}", case.name);
        // Where the textbook's way is shown beside choices, trees, lights and offsets, it is shown because it fails.
        let of_triangles = ["solid-angle", "irradiance"].iter().any(|group| case.name.starts_with(group));
        if let Some(textbook) = finding.textbook.filter(|_| !of_triangles) {
            assert!(!textbook.holds(finding.limit), "{}: the textbook is right too", case.name);
        }
    }
}

/// The header without the sign of a remark.
fn header() -> String {
    let text = String::from_utf8_lossy(VECTORS);
    text.lines().next().expect("a header").trim_start_matches(['#', ' ']).to_owned()
}

const ROW: &str = "ordinary,1,0,0,0,1,0,0,0,1,0,0,1,1.5707963267948966,0.7853981633974483";

#[test]
fn a_header_may_be_a_remark_and_a_remark_may_speak_of_categories() {
    let header = header();
    for text in [
        format!("{header}\n{ROW}"),
        format!("# {header}\n{ROW}"),
        format!("#{}\n{ROW}", header.replace(',', ", ")),
        format!("# categories, all of them\n# category names stand first\n{ROW}"),
        ROW.to_owned(),
    ] {
        assert_eq!(parse(text.as_bytes(), "file".as_ref()).expect("a right header").len(), 1, "{text}");
    }
}
