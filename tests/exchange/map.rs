//! Maps of errors have the published colours, and what is left out of them reaches no neighbour.

use crate::promises::pictures::{noisy, picture, reference};
use citylights::image::Picture;
use citylights::image::map::{Map, Scale, magma};
use citylights::image::metrics::Pair;

#[test]
fn left_out_pixels_do_not_reach_their_neighbours_through_flip() {
    let (r, mut x) = (reference(), noisy());
    let mask = picture(|i, _| if i == 200 { 1.0 } else { 0.0 });
    let map = |x: &Picture| Pair::new(&r, x, Some(&mask)).expect("a pair").flip(1.0, 67.0);
    let before = map(&x);
    x.pixels[200] = [1e9; 3];
    assert_eq!(map(&x), before);
}

#[test]
fn magma_is_magma() {
    // Entries of the published table of 256 colours.
    for (entry, colour) in [
        (0, [0, 0, 4]),
        (64, [81, 18, 124]),
        (100, [137, 40, 129]),
        (128, [183, 55, 121]),
        (200, [253, 152, 105]),
        (255, [252, 253, 191]),
    ] {
        let here = magma(f64::from(entry) / 255.0);
        assert!((0..3).all(|c| here[c].abs_diff(colour[c]) <= 1), "entry {entry}: {here:?}, not {colour:?}");
    }
    assert_eq!((magma(-1.0), magma(2.0)), (magma(0.0), magma(1.0)));
    let folder = tempfile::tempdir().expect("a folder");
    let values = [0.0, 1e-9, f64::INFINITY, 1.0];
    let counted = [true, true, true, false];
    let map = Map { width: 2, height: 2, values: &values, counted: &counted, scale: Scale::Decades(1e-4, 1e2) };
    map.write(&folder.path().join("ends.png")).expect("written");
    let texels = ::image::open(folder.path().join("ends.png")).expect("a PNG").to_rgb8().into_raw();
    assert_eq!(texels, [magma(0.0), magma(0.0), magma(1.0), [128; 3]].concat());
}
