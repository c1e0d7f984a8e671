//! EXR files of other tools are read by one rule, and no file, however broken, panics or takes memory for what it
//! merely claims.
use citylights::base::error::{Error, Result};
use citylights::image::{Picture, exr as ours};
use exr::image::Layers;
use exr::prelude::*;
use std::fs;
use std::io::Cursor;
use std::path::Path;

const SIZE: Vec2<usize> = Vec2(13, 7);

/// The value of a colour at a pixel: whole numbers, which every sample type holds.
fn value(place: usize, colour: usize) -> f32 {
    (1 + place * 3 + colour) as f32
}

fn samples(kind: SampleType, size: Vec2<usize>, colour: usize) -> FlatSamples {
    let values = (0..size.area()).map(|place| value(place, colour));
    match kind {
        SampleType::F16 => FlatSamples::F16(values.map(f16::from_f32).collect()),
        SampleType::F32 => FlatSamples::F32(values.collect()),
        SampleType::U32 => FlatSamples::U32(values.map(|v| v as u32).collect()),
    }
}

/// A layer with these channels; those whose name ends in R, G, B hold colours 0, 1, 2, any other holds colour 7.
fn layer(names: &[&str], kind: SampleType, encoding: Encoding, at: Vec2<i32>) -> Layer<AnyChannels<FlatSamples>> {
    let colour = |name: &str| ["R", "G", "B"].iter().position(|c| name.ends_with(c)).unwrap_or(7);
    let channels = names.iter().map(|name| AnyChannel::new(*name, samples(kind, SIZE, colour(name)))).collect();
    let attributes = LayerAttributes::default().with_position(at);
    Layer::new(SIZE, attributes, encoding, AnyChannels::sort(channels))
}

fn plain(names: &[&str]) -> Layer<AnyChannels<FlatSamples>> {
    layer(names, SampleType::F32, Encoding::FAST_LOSSLESS, Vec2(0, 0))
}

fn file(layers: Vec<Layer<AnyChannels<FlatSamples>>>, display: Option<IntegerBounds>) -> Vec<u8> {
    let display = display.unwrap_or_else(|| IntegerBounds::new(Vec2(0, 0), SIZE));
    let named = |(i, mut layer): (usize, Layer<_>)| {
        layer.attributes.layer_name = Text::new_or_none(format!("part {i}"));
        layer
    };
    let layers: Layers<_> = layers.into_iter().enumerate().map(named).collect();
    let mut bytes = Vec::new();
    let image = Image { attributes: ImageAttributes::new(display), layer_data: layers };
    image.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).expect("encoded");
    bytes
}

fn read(folder: &Path, bytes: &[u8]) -> Result<Picture> {
    let path = folder.join("other.exr");
    fs::write(&path, bytes).expect("written");
    ours::read(&path, None)
}

fn assert_is_ours(picture: &Picture, what: &str) {
    assert_eq!((picture.width as usize, picture.height as usize), (SIZE.0, SIZE.1), "{what}");
    for (place, pixel) in picture.pixels.iter().enumerate() {
        assert_eq!(*pixel, [0, 1, 2].map(|colour| value(place, colour)), "{what}, pixel {place}");
    }
}

/// That the file is refused, with a message that holds all of `said`.
fn refused(folder: &Path, bytes: &[u8], said: &[&str]) {
    let error = read(folder, bytes).expect_err("refused");
    assert!(matches!(error, Error::Input { .. }), "{error}");
    let text = error.to_string();
    assert!(said.iter().all(|said| text.contains(said)), "{text}");
}

#[test]
fn colours_are_found_under_the_names_of_other_tools() {
    let folder = tempfile::tempdir().expect("a folder");
    for prefix in ["", "ViewLayer.Combined.", "Combined.", "color."] {
        let names = ["A", "B", "G", "R"].map(|channel| format!("{prefix}{channel}"));
        let mut names: Vec<&str> = names.iter().map(String::as_str).collect();
        names.extend(["ViewLayer.Depth.Z", "N.X", "N.Y", "N.Z"]);
        let bytes = file(vec![plain(&names)], None);
        assert_is_ours(&read(folder.path(), &bytes).expect(prefix), prefix);
    }
    // Of several layers, Blender's picture is the one called Combined.
    let noisy = ["ViewLayer.Noisy Image.R", "ViewLayer.Noisy Image.G", "ViewLayer.Noisy Image.B"];
    let combined = ["ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"];
    let bytes = file(vec![plain(&noisy), plain(&combined)], None);
    assert_is_ours(&read(folder.path(), &bytes).expect("combined"), "combined");
    // Plain names win over layers, in whatever part they are.
    let albedo = ["albedo.R", "albedo.G", "albedo.B"];
    let bytes = file(vec![plain(&albedo), plain(&["Z"]), plain(&["R", "G", "B"])], None);
    assert_is_ours(&read(folder.path(), &bytes).expect("plain"), "plain");
}

#[test]
fn every_sample_type_compression_and_order_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let tiles = Blocks::Tiles(Vec2(5, 4));
    let compressions = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
    ];
    for compression in compressions {
        for (blocks, line_order) in [
            (Blocks::ScanLines, LineOrder::Increasing),
            (Blocks::ScanLines, LineOrder::Decreasing),
            (tiles, LineOrder::Increasing),
            (tiles, LineOrder::Unspecified),
        ] {
            for kind in [SampleType::F16, SampleType::F32, SampleType::U32] {
                let encoding = Encoding { compression, blocks, line_order };
                let bytes = file(vec![layer(&["R", "G", "B"], kind, encoding, Vec2(0, 0))], None);
                let what = format!("{encoding:?} {kind:?}");
                assert_is_ours(&read(folder.path(), &bytes).expect(&what), &what);
            }
        }
    }
}

#[test]
fn luminance_alone_is_grey() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = read(folder.path(), &file(vec![plain(&["Y", "A"])], None)).expect("grey");
    assert!((0..SIZE.area()).all(|place| picture.pixels[place] == [value(place, 7); 3]));
}

#[test]
fn what_would_be_a_guess_is_refused_with_the_channels_there_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |layers: &[&[&str]], said: &[&str]| {
        refused(folder.path(), &file(layers.iter().map(|names| plain(names)).collect(), None), said);
    };
    refused(&[&["X", "Y", "Z"]], &["no channels R, G and B", "Its channels: part 0: X"]);
    refused(&[&["Y", "RY", "BY"]], &["no channels R, G and B", "RY"]);
    refused(&[&["R", "G", "b"]], &["no channels R, G and B"]);
    refused(&[&["a.R", "a.G", "b.B"]], &["no channels R, G and B", "part 0: a.G"]);
    refused(&[&["a.R", "a.G", "a.B", "b.R", "b.G", "b.B"]], &["2 of its layers", "part 0: b.R"]);
    let one = ["Combined.R", "Combined.G", "Combined.B"];
    refused(&[&one, &one], &["2 of its layers"]);
    refused(&[&["R", "G", "B"], &["R", "G", "B"]], &["2 of its layers", "part 1: R"]);
    let many: Vec<String> = (0..60).map(|i| format!("c{i}")).collect();
    refused(&[&many.iter().map(String::as_str).collect::<Vec<_>>()], &["and 20 more"]);
}

#[test]
fn the_picture_is_the_display_window() {
    let folder = tempfile::tempdir().expect("a folder");
    for (data, display) in [
        (Vec2(0, 0), IntegerBounds::new(Vec2(0, 0), Vec2(20, 9))),
        (Vec2(3, 1), IntegerBounds::new(Vec2(0, 0), Vec2(20, 9))),
        (Vec2(-4, -2), IntegerBounds::new(Vec2(0, 0), Vec2(5, 3))),
        (Vec2(-4, 100), IntegerBounds::new(Vec2(-6, 98), Vec2(30, 4))),
        (Vec2(900, 0), IntegerBounds::new(Vec2(0, 0), Vec2(5, 3))),
    ] {
        let bytes = file(vec![layer(&["R", "G", "B"], SampleType::F32, Encoding::FAST_LOSSLESS, data)], Some(display));
        let picture = read(folder.path(), &bytes).expect("read");
        assert_eq!((picture.width as usize, picture.height as usize), (display.size.0, display.size.1));
        for (i, pixel) in picture.pixels.iter().enumerate() {
            // Where the pixel lies in the data, if it does.
            let x = (i % display.size.0) as i32 + display.position.0 - data.0;
            let y = (i / display.size.0) as i32 + display.position.1 - data.1;
            let inside = (0..SIZE.0 as i32).contains(&x) && (0..SIZE.1 as i32).contains(&y);
            let place = (y * SIZE.0 as i32 + x) as usize;
            let expected = [0, 1, 2].map(|colour| if inside { value(place, colour) } else { 0.0 });
            assert_eq!(*pixel, expected, "data at {data:?}, {display:?}, pixel {i}");
        }
    }
}

/// The file with the value of its first attribute of this name and type replaced.
fn with(bytes: &[u8], attribute: &str, kind: &str, value: &[i32]) -> Vec<u8> {
    let head = format!("{attribute}\0{kind}\0").into_bytes();
    let at = bytes.windows(head.len()).position(|window| window == head).expect("the attribute") + head.len() + 4;
    let mut bytes = bytes.to_vec();
    for (i, number) in value.iter().enumerate() {
        bytes[at + 4 * i..][..4].copy_from_slice(&number.to_le_bytes());
    }
    bytes
}

#[test]
fn what_a_header_claims_is_checked_before_memory_is_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    let scan = file(vec![plain(&["R", "G", "B"])], None);
    let encoding = Encoding {
        compression: Compression::RLE,
        blocks: Blocks::Tiles(Vec2(8, 8)),
        line_order: LineOrder::Increasing,
    };
    let tiled = file(vec![layer(&["R", "G", "B"], SampleType::F32, encoding, Vec2(0, 0))], None);
    // Without the number of blocks, which would give the lie away by itself.
    let uncounted = |bytes: &[u8]| {
        let at = bytes.windows(10).position(|window| window == b"chunkCount").expect("the attribute");
        [&bytes[..at], b"chunkCoins", &bytes[at + 10..]].concat()
    };
    const HUGE: i32 = i32::MAX / 2 - 2;
    for bytes in [&uncounted(&scan), &uncounted(&tiled)] {
        for window in ["dataWindow", "displayWindow"] {
            for size in [[0, 0, HUGE, HUGE], [0, 0, HUGE, 1], [-HUGE, 3, -1, 9], [0, 0, 8_191, 8_192]] {
                refused(folder.path(), &with(bytes, window, "box2i", &size), &["1 to 8388608 are read"]);
            }
            refused(folder.path(), &with(bytes, window, "box2i", &[0, 0, i32::MAX, i32::MAX]), &["not an EXR picture"]);
        }
        // As many pixels as may be, and not their data.
        refused(folder.path(), &with(bytes, "dataWindow", "box2i", &[0, 0, 8_191, 8_191]), &["not an EXR picture"]);
    }
    for sides in [[HUGE, HUGE], [1 << 20, 1 << 10]] {
        refused(folder.path(), &with(&uncounted(&tiled), "tiles", "tiledesc", &sides), &["its blocks unpack to"]);
    }
    for sides in [[0, 8], [-1, -1]] {
        refused(folder.path(), &with(&tiled, "tiles", "tiledesc", &sides), &["not an EXR picture"]);
    }
    // The same tile twice, in place of both: the table's first entry points behind its second.
    let number = |at: usize| u64::from_le_bytes(tiled[at..at + 8].try_into().expect("eight bytes"));
    let table = (0..tiled.len() - 8).find(|&at| number(at) == at as u64 + 16).expect("the table of blocks");
    let mut twice = tiled.clone();
    twice.copy_within(table..table + 8, table + 8);
    refused(folder.path(), &twice, &["its table of blocks"]);
}

#[test]
fn thousands_of_broken_files_are_errors_and_no_panics() {
    let folder = tempfile::tempdir().expect("a folder");
    let tiles = Blocks::Tiles(Vec2(5, 4));
    let mut seeds = vec![file(vec![plain(&["R", "G", "B"]), plain(&["a.R", "Y"])], None)];
    for compression in [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
        Compression::B44A,
        Compression::DWAA(None),
        Compression::DWAB(None),
    ] {
        for (blocks, kind) in [(Blocks::ScanLines, SampleType::F16), (tiles, SampleType::F32)] {
            let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
            seeds.push(file(vec![layer(&["R", "G", "B"], kind, encoding, Vec2(0, 0))], None));
        }
    }
    let mut state = 1u64;
    let mut random = |below: usize| {
        // Knuth's MMIX generator.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let (mut whole, mut broken) = (0, 0);
    for round in 0..200 * seeds.len() {
        let mut bytes = seeds[round % seeds.len()].clone();
        // The header is a third of the file; half of the changes hit it.
        let reach = if random(2) == 0 { bytes.len().min(350) } else { bytes.len() };
        for _ in 0..=random(6) {
            let at = random(reach);
            match random(4) {
                0 => bytes[at] = random(256) as u8,
                1 => bytes[at] ^= 1 << random(8),
                2 => bytes[at] = [0, 0x7f, 0x80, 0xff][random(4)],
                _ => bytes[at] = bytes[at].wrapping_add(1),
            }
        }
        if random(8) == 0 {
            bytes.truncate(random(bytes.len()));
        }
        match read(folder.path(), &bytes) {
            Ok(_) => whole += 1,
            Err(Error::Input { .. }) => broken += 1,
            Err(other) => panic!("round {round}: {other}"),
        }
    }
    assert!(whole > 100 && broken > 1000, "{whole} were read, {broken} refused");
}

#[test]
fn other_primaries_are_turned_into_those_of_rec_709() {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |names: &[&str], chromaticities: Option<attribute::Chromaticities>| {
        let mut attributes = ImageAttributes::new(IntegerBounds::new(Vec2(0, 0), SIZE));
        attributes.chromaticities = chromaticities;
        let image = Image { attributes, layer_data: Layers::from_iter([plain(names)]) };
        let mut bytes = Vec::new();
        image.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).expect("encoded");
        read(folder.path(), &bytes)
    };
    let rec_709 = attribute::Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    };
    // Rec. 2020: the first row of its matrix, from ITU-R BT.2087, is 1.6605, -0.5876, -0.0728.
    let wide = attribute::Chromaticities {
        red: Vec2(0.708, 0.292),
        green: Vec2(0.170, 0.797),
        blue: Vec2(0.131, 0.046),
        ..rec_709
    };
    let rgb = ["R", "G", "B"];
    assert_is_ours(&of(&rgb, Some(rec_709)).expect("read"), "Rec. 709");
    let found = of(&rgb, Some(wide)).expect("read").pixels[5][0];
    let wanted = 1.6605 * value(5, 0) - 0.5876 * value(5, 1) - 0.0728 * value(5, 2);
    assert!((found - wanted).abs() < 2e-3 * wanted.abs() && found != value(5, 0), "{found} for {wanted}");
    let grey = of(&["Y"], Some(wide)).expect("read").pixels[5];
    assert_eq!(grey, [value(5, 7); 3], "grey has no primaries");
    let line = attribute::Chromaticities { green: rec_709.red, ..rec_709 };
    assert!(of(&rgb, Some(line)).expect_err("no colours").to_string().contains("chromaticities"));
}
