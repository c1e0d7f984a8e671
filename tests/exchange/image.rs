//! Pictures keep their numbers, and are never half-written.
use citylights::base::error::Error;
use citylights::image::{self, Picture, exr, png};
use std::fs;

fn night() -> Picture {
    let mut pixels: Vec<[f32; 3]> =
        (0..37 * 21).map(|i| [1e-7 * i as f32, (i as f32 * 0.37).sin(), 1e9 / (i as f32 + 1.0)]).collect();
    pixels[5] = [f32::MIN_POSITIVE / 4.0, -0.0, f32::MAX];
    Picture { width: 37, height: 21, pixels }
}

#[test]
fn exr_keeps_every_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("night.exr");
    let mut picture = night();
    picture.pixels[9] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    assert_eq!(image::write(&path, &picture, 7.0).expect("written"), 1);
    let back = exr::read(&path, None).expect("read");
    assert_eq!((back.width, back.height), (37, 21));
    let bits = |p: &Picture| p.pixels.iter().map(|c| c.map(f32::to_bits)).collect::<Vec<_>>();
    assert!(bits(&back) == bits(&picture));
    assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1, "the temporary file is gone");
}

#[test]
fn png_is_exposed_encoded_and_clamped() {
    let pixels = vec![[0.0, 0.5, 1.0], [0.002, 9.0, -1.0], [f32::NAN, 0.0, 0.0], [0.25, f32::INFINITY, 0.1]];
    let picture = Picture { width: 2, height: 2, pixels };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("small.PNG");
    assert_eq!(image::write(&path, &picture, 0.5).expect("written"), 2);
    let texels = ::image::load_from_memory(&fs::read(&path).expect("read")).expect("a PNG").to_rgb8().into_raw();
    // 0.25 and 0.5 are 137 and 188 in sRGB; 0.001 is on its straight part: 255 * 12.92 * 0.001 = 3.3.
    assert_eq!(texels, [0, 137, 188, 3, 255, 0, 255, 0, 255, 255, 0, 255]);
}

#[test]
fn png_is_read_as_the_linear_values_that_a_screen_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("small.png");
    let steps: Vec<[u8; 3]> = (0..=255).map(|i| [i, 255 - i, 7]).collect();
    fs::write(&path, png::encode_texels(16, 16, &steps).expect("png")).expect("written");
    let picture = image::read(&path).expect("read");
    assert_eq!((picture.width, picture.height), (16, 16));
    // 188 is half of the light: 0.5029; encoding gives every step back.
    assert!((picture.pixels[188][0] - 0.5029).abs() < 1e-4, "{:?}", picture.pixels[188]);
    assert_eq!(fs::read(&path).expect("read"), png::encode(&picture, 1.0).expect("png"));
    // Grey of 16 bits with opacity, which is ignored.
    let grey = ::image::ImageBuffer::from_fn(3, 2, |x, _| ::image::LumaA([(x * 30_000) as u16, 5]));
    grey.save(&path).expect("saved");
    let picture = png::read(&path, None).expect("read");
    assert!((picture.pixels[5][1] - 0.818_51).abs() < 1e-4, "{:?}", picture.pixels[5]);
}

#[test]
fn a_damaged_or_enormous_png_is_an_error_and_no_panic() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cut.png");
    let whole = png::encode(&night(), 1.0).expect("png");
    // The last twelve bytes only say that it ends.
    for length in (0..whole.len() - 12).step_by(11) {
        fs::write(&path, &whole[..length]).expect("written");
        let error = image::read(&path).expect_err("cut short");
        assert!(matches!(error, Error::Input { .. }) && error.to_string().contains("cut.png"), "{error}");
    }
    // A header that claims 65,536 x 65,536 pixels, with its checksum.
    let mut huge = whole.clone();
    huge[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let checksum = crc32(&huge[12..29]);
    huge[29..33].copy_from_slice(&checksum.to_be_bytes());
    fs::write(&path, &huge).expect("written");
    let error = png::read(&path, None).expect_err("too large").to_string();
    assert!(error.contains("65536 x 65536") && error.contains("1 to 8388608 are read"), "{error}");
    assert!(matches!(png::read(&folder.path().join("none.png"), None), Err(Error::Io { .. })));
}

/// The checksum of a PNG chunk (ISO 3309), bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    assert!(png::encode(&night(), 1.0).expect("png") == png::encode(&night(), 1.0).expect("png"));
    let first = exr::encode(&night()).expect("exr");
    assert!((0..8).all(|_| exr::encode(&night()).expect("exr") == first));
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["missing/a.png", "missing/a.exr"] {
        let error = image::write(&folder.path().join(name), &night(), 1.0).expect_err("no such folder");
        assert!(matches!(&error, Error::Io { path, .. } if path.ends_with(name)), "{error}");
    }
    // A folder that bears the picture's name: the rename fails, and nothing is left behind.
    fs::create_dir_all(folder.path().join("taken.png/inside")).expect("made");
    let error = image::write(&folder.path().join("taken.png"), &night(), 1.0).expect_err("a folder is there");
    assert!(matches!(error, Error::Io { .. }), "{error}");
    assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
}

#[test]
fn other_formats_and_wrong_sizes_are_refused() {
    for name in ["a.jpg", "a", "exr"] {
        let error = image::write(name.as_ref(), &night(), 1.0).expect_err("no format");
        assert!(error.to_string().contains("use .png or .exr"), "{error}");
    }
    let short = Picture { width: 3, height: 2, pixels: vec![[0.0; 3]; 5] };
    assert!(png::encode(&short, 1.0).is_err() && exr::encode(&short).is_err());
    let empty = Picture { width: 0, height: 0, pixels: Vec::new() };
    assert!(png::encode(&empty, 1.0).is_err() && exr::encode(&empty).is_err());
}

#[test]
fn a_damaged_exr_is_an_error_and_no_panic() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cut.exr");
    let whole = exr::encode(&night()).expect("exr");
    for length in (0..whole.len()).step_by(7) {
        fs::write(&path, &whole[..length]).expect("written");
        let error = exr::read(&path, None).expect_err("cut short");
        assert!(error.to_string().contains("cut.exr"), "{error}");
    }
    assert!(matches!(exr::read(&folder.path().join("none.exr"), None), Err(Error::Io { .. })));
}
