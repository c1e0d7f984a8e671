//! Promise: two pictures are compared by the figures that papers print, over the pixels that count, and a comparison
//! that would mean nothing is refused.
#![cfg(feature = "cli")]

use crate::pictures::{noisy, picture, reference};
use assert_cmd::Command;
use citylights::image::{self, Picture};
use predicates::str::contains;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Entries of the published table of 256 colours.
const MAGMA: [(f64, [u8; 3]); 6] = [
    (0.0, [0, 0, 4]),
    (64.0, [81, 18, 124]),
    (100.0, [137, 40, 129]),
    (128.0, [183, 55, 121]),
    (200.0, [253, 152, 105]),
    (255.0, [252, 253, 191]),
];

/// Writes pictures to a folder of their own.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn with(&self, name: &str, picture: &Picture) -> PathBuf {
        image::write(&self.path(name), picture, 1.0).expect("written");
        self.path(name)
    }
}

fn diff(a: &Path, b: &Path, options: &[&str]) -> Command {
    let mut command = Command::cargo_bin("citylights").expect("the binary");
    command.arg("diff-image").arg(a).arg(b).args(options);
    command
}

fn figures(a: &Path, b: &Path, options: &[&str]) -> Value {
    let output = diff(a, b, options).arg("--json").assert().success().get_output().stdout.clone();
    serde_json::from_slice(&output).expect("JSON")
}

fn near(value: &Value, expected: f64) {
    let value = value.as_f64().expect("a number");
    assert!((value - expected).abs() <= 1e-6 * expected.abs(), "{value}, not {expected}");
}

#[test]
fn figures_are_those_of_their_definitions() {
    let folder = Folder::new();
    let (r, x) = (reference(), noisy());
    let report = figures(&folder.with("r.exr", &r), &folder.with("x.exr", &x), &[]);
    let n = r.pixels.len() as f64;
    let channel = |p: &Picture, c: usize| p.pixels.iter().map(|p| f64::from(p[c])).sum::<f64>() / n;
    let epsilon = [0, 1, 2].map(|c| 0.01 * channel(&r, c).powi(2));
    let square = |i: usize, c: usize| f64::from(x.pixels[i][c] - r.pixels[i][c]).powi(2);
    let over = |value: &dyn Fn(usize, usize) -> f64| {
        (0..r.pixels.len()).map(|i| (0..3).map(|c| value(i, c)).sum::<f64>() / 3.0).collect::<Vec<_>>()
    };
    near(&report["mse"], over(&square).iter().sum::<f64>() / n);
    let mut relative = over(&|i, c| square(i, c) / (f64::from(r.pixels[i][c]).powi(2) + epsilon[c]));
    near(&report["rel_mse"], relative.iter().sum::<f64>() / n);
    relative.sort_by(f64::total_cmp);
    near(&report["rel_mse_trimmed"], relative[..relative.len() - 1].iter().sum::<f64>() / (n - 1.0));
    let luminance = |p: &Picture| [0.2126, 0.7152, 0.0722].iter().enumerate().map(|(c, w)| w * channel(p, c)).sum();
    let (mean_r, mean_x): (f64, f64) = (luminance(&r), luminance(&x));
    near(&report["mean_reference"], mean_r);
    near(&report["mean_test"], mean_x);
    near(&report["mean_ratio"], mean_x / mean_r);
    assert_eq!((&report["width"], &report["height"], &report["pixels"]), (&24.into(), &16.into(), &384.into()));
    assert!(report["flip"]["mean"].as_f64() > Some(0.01) && report["hdr_flip"]["exposures"].as_u64() >= Some(2));
}

#[test]
fn equal_pictures_have_no_error() {
    let folder = Folder::new();
    let file = folder.with("r.exr", &reference());
    let report = figures(&file, &file, &["--fail-above", "0"]);
    for place in ["/mse", "/rel_mse", "/flip/mean", "/flip/max", "/hdr_flip/mean", "/hdr_flip/weighted_median"] {
        assert_eq!(report.pointer(place), Some(&0.0.into()), "{place}");
    }
    assert_eq!(report["mean_ratio"], 1.0);
    // A black reference has no ratio, and everything else is still a number.
    let black = folder.with("black.exr", &picture(|_, _| 0.0));
    let report = figures(&black, &file, &[]);
    assert!(report["mean_ratio"].is_null() && report["hdr_flip"]["mean"].as_f64() > Some(0.5), "{report}");
    assert_eq!(figures(&black, &black, &[])["rel_mse"], 0.0);
}

#[test]
fn the_exposure_decides_flip_and_nothing_else() {
    let folder = Folder::new();
    let (r, x) = (folder.with("r.exr", &reference()), folder.with("x.exr", &noisy()));
    let (one, dark) = (figures(&r, &x, &[]), figures(&r, &x, &["--exposure", "0.001"]));
    assert!(dark["flip"]["mean"].as_f64() < one["flip"]["mean"].as_f64(), "{dark}");
    for same in ["mse", "rel_mse", "hdr_flip"] {
        assert_eq!(one[same], dark[same]);
    }
    // 1 / (1.2 * 2^-2) = 10/3.
    let (a, b) = (figures(&r, &x, &["--ev100", "-2"]), figures(&r, &x, &["--exposure", "3.3333333"]));
    assert!((a["flip"]["mean"].as_f64().expect("a") - b["flip"]["mean"].as_f64().expect("b")).abs() < 1e-6);
    // From nearer, a pixel is larger and its noise seen more.
    let near = figures(&r, &x, &["--ppd", "10"]);
    assert!(near["flip"]["mean"].as_f64() > one["flip"]["mean"].as_f64());
}

#[test]
fn masked_and_broken_pixels_are_left_out_of_all_figures_and_said() {
    let folder = Folder::new();
    let (r, mut x) = (reference(), noisy());
    let clean = figures(&folder.with("r.exr", &r), &folder.with("x.exr", &x), &[]);
    // Whatever stands in a left-out pixel changes nothing: 5 and 50 masked, 100 NaN, 101 infinite.
    (x.pixels[5], x.pixels[50]) = ([1e6; 3], [f32::NAN; 3]);
    (x.pixels[100], x.pixels[101]) = ([0.1, f32::NAN, 0.1], [f32::INFINITY; 3]);
    let mut mask = picture(|_, _| 0.0);
    (mask.pixels[5], mask.pixels[50]) = ([0.0, 1.0, 0.0], [-1.0; 3]);
    let mask = folder.with("mask.exr", &mask);
    let mask = mask.to_str().expect("a name");
    let map = folder.path("map.exr");
    let output = map.to_str().expect("a name");
    let (r, x) = (folder.path("r.exr"), folder.with("y.exr", &x));
    let report = figures(&r, &x, &["--mask", mask, "-o", output, "--metric", "rel-mse"]);
    assert_eq!((&report["pixels"], &report["masked"], &report["not_finite"]), (&380.into(), &2.into(), &2.into()));
    for figure in ["mse", "rel_mse"] {
        let (with, without) = (report[figure].as_f64().expect("with"), clean[figure].as_f64().expect("without"));
        assert!((with / without - 1.0).abs() < 0.05, "{figure}: {with} with the mask, {without} before");
    }
    let left_out: Vec<usize> = (0..384).filter(|&i| image::read(&map).expect("read").pixels[i][0].is_nan()).collect();
    assert_eq!(left_out, [5, 50, 100, 101]);
    diff(&r, &x, &[]).assert().success().stderr(contains("3 pixels are not finite and left out"));
    let all = folder.with("all.exr", &picture(|_, _| 1.0));
    diff(&r, &x, &["--mask", all.to_str().expect("a name")]).assert().code(2).stderr(contains("no pixel is left"));
}

#[test]
fn maps_are_colours_in_a_png_and_values_in_an_exr() {
    let folder = Folder::new();
    let (r, x) = (folder.with("r.exr", &reference()), folder.with("x.exr", &noisy()));
    let mut told = std::collections::BTreeSet::new();
    for (metric, figure) in
        [("flip", "/flip/mean"), ("hdr-flip", "/hdr_flip/mean"), ("rel-mse", "/rel_mse"), ("mse", "/mse")]
    {
        let (png, exr) = (folder.path(&format!("{metric}.png")), folder.path(&format!("{metric}.exr")));
        let write = |to: &Path| figures(&r, &x, &["--metric", metric, "-o", to.to_str().expect("a name")]);
        let report = write(&exr);
        let values: Vec<f64> = image::read(&exr).expect("read").pixels.iter().map(|p| f64::from(p[0])).collect();
        near(report.pointer(figure).expect(figure), values.iter().sum::<f64>() / 384.0);
        write(&png);
        let colours = ::image::open(&png).expect("a PNG").to_rgb8();
        let brightest = values.iter().copied().fold(0.0, f64::max);
        let place = |v: f64| match metric {
            "rel-mse" => (v / 1e-4).log10() / 6.0,
            "mse" => (v / brightest * 1e6).log10() / 6.0,
            _ => v,
        };
        // Those texels whose place is nearly that of a published colour: it changes by at most 4 an entry.
        for (value, texel) in values.iter().zip(colours.pixels()) {
            let entry = place(*value).clamp(0.0, 1.0) * 255.0;
            for (_, colour) in MAGMA.iter().filter(|(known, _)| (entry - known).abs() < 3.0) {
                assert!((0..3).all(|c| texel.0[c].abs_diff(colour[c]) <= 12), "{metric}: {value} is {texel:?}");
                told.insert(metric);
            }
        }
    }
    assert!(told.contains("rel-mse") && told.contains("mse"), "published colours in {told:?} alone");
    // What the map shows without being told: HDR-FLIP, or FLIP where an exposure is given.
    let map = folder.path("default.exr");
    for (options, same) in [(&[][..], "hdr-flip.exr"), (&["--exposure", "1"][..], "flip.exr")] {
        diff(&r, &x, options).arg("-o").arg(&map).assert().success();
        assert_eq!(fs::read(&map).expect("read"), fs::read(folder.path(same)).expect("read"), "{same}");
    }
}

#[test]
fn png_files_are_compared_as_they_are_displayed() {
    let folder = Folder::new();
    let (r, x) = (folder.with("r.png", &reference()), folder.with("x.png", &noisy()));
    let report = figures(&r, &x, &["--fail-above", "0.9"]);
    assert!(report["hdr_flip"].is_null() && report["flip"]["mean"].as_f64() > Some(0.0), "{report}");
    // Eight bits of the same radiance: nearly the figure of the EXR files.
    let linear = figures(&folder.with("r.exr", &reference()), &folder.with("x.exr", &noisy()), &[]);
    let (a, b) = (report["flip"]["mean"].as_f64().expect("a"), linear["flip"]["mean"].as_f64().expect("b"));
    assert!((a - b).abs() < 0.01, "{a} and {b}");
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = Folder::new();
    let r = folder.with("r.exr", &reference());
    let mut small = reference();
    (small.width, small.height) = (16, 24);
    let other = folder.with("other.exr", &small);
    let refused = |a: &Path, b: &Path, options: &[&str], said: &str| {
        diff(a, b, options).assert().code(2).stdout("").stderr(contains(said));
    };
    refused(&r, &other, &[], "the reference has 24 x 16 pixels, the test 16 x 24");
    refused(&r, &r, &["--mask", other.to_str().expect("a name")], "the mask 16 x 24");
    refused(&r, &folder.path("none.exr"), &[], "none.exr");
    refused(&r, &folder.path("none.jpg"), &[], "use .png or .exr");
    let png = folder.with("r.png", &reference());
    refused(&r, &png, &[], "two of a kind");
    refused(&png, &png, &["--metric", "hdr-flip"], "EXR files are right");
    refused(&r, &r, &["-o", "none/map.png"], "there is no folder none");
    refused(&r, &r, &["-o", "map.jpg"], "use .png or .exr");
    for (option, value, said) in [
        ("--ppd", "0", "from 1 to 1000"),
        ("--ppd", "nan", "from 1 to 1000"),
        ("--exposure", "0", "above 0"),
        ("--ev100", "100", "-60 to 60"),
        ("--fail-above", "-1", "0 or more"),
        ("--metric", "psnr", "rel-mse"),
    ] {
        refused(&r, &r, &[&format!("{option}={value}")], said);
    }
    fs::write(folder.path("text.exr"), "not a picture").expect("written");
    refused(&r, &folder.path("text.exr"), &[], "text.exr: not an EXR picture");
}

#[test]
fn a_limit_makes_a_check() {
    let folder = Folder::new();
    let (r, x) = (folder.with("r.exr", &reference()), folder.with("x.exr", &noisy()));
    let mean = figures(&r, &x, &["--metric", "rel-mse"])["rel_mse"].as_f64().expect("a number");
    let check = |limit: f64| diff(&r, &x, &["--metric", "rel-mse", "--fail-above", &limit.to_string()]).assert();
    check(1.01 * mean).code(0).stdout(contains("relMSE"));
    check(0.99 * mean).code(1).stdout(contains("relMSE"));
}
