//! FLIP is the authors' FLIP: figures of their own program (flip-evaluator 1.7), on pictures that are made here.
use citylights::base::colour::srgb_decode;
use citylights::image::flip::{self, Exposures, PIXELS_PER_DEGREE, Pooled};
use glam::{DVec3, Vec3};

const SIDE: usize = 64;

/// SplitMix64 (Steele, Lea and Flood, OOPSLA 2014), the upper 24 bits of each number as a share of 1.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 40) as f64 / f64::from(1 << 24)
    }
}

fn picture(pixel: impl FnMut((usize, usize)) -> DVec3) -> Vec<Vec3> {
    (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE)).map(pixel).map(DVec3::as_vec3).collect()
}

fn noise(seed: u64, low: f64, high: f64) -> Vec<Vec3> {
    let mut stream = SplitMix(seed);
    picture(|_| DVec3::from_array(std::array::from_fn(|_| low + (high - low) * stream.next())))
}

/// Reference and test: noise against noise, a gradient against itself with noise, a chequerboard shifted by a pixel.
fn pairs() -> [(Vec<Vec3>, Vec<Vec3>); 3] {
    let gradient = picture(|(x, y)| DVec3::new(x as f64 / 63.0, y as f64 / 63.0, (x + y) as f64 / 126.0));
    let add = |(a, b): (&Vec3, Vec3)| (a.as_dvec3() + b.as_dvec3()).clamp(DVec3::ZERO, DVec3::ONE).as_vec3();
    let disturbed = gradient.iter().zip(noise(3, -0.1, 0.1)).map(add).collect();
    let board = |shift: usize| {
        picture(move |(x, y)| {
            let b = (((x + SIDE - shift) % SIDE / 8 + y / 8) % 2) as f64;
            DVec3::new(0.2 + 0.6 * b, 0.5 - 0.3 * b, 0.3 + 0.4 * b)
        })
    };
    [(noise(1, 0.0, 1.0), noise(2, 0.0, 1.0)), (gradient, disturbed), (board(0), board(1))]
}

fn ldr(reference: &[Vec3], test: &[Vec3]) -> Vec<f32> {
    flip::ldr(reference, test, SIDE, PIXELS_PER_DEGREE)
}

fn decoded(picture: &[Vec3]) -> Vec<Vec3> {
    picture.iter().map(|rgb| Vec3::from_array(rgb.to_array().map(srgb_decode))).collect()
}

/// `8 v^3`: from display values to a wide range.
fn bright(picture: &[Vec3]) -> Vec<Vec3> {
    picture.iter().map(|v| (8.0 * v.as_dvec3() * v.as_dvec3() * v.as_dvec3()).as_vec3()).collect()
}

fn mean(map: &[f32]) -> f64 {
    map.iter().map(|&x| f64::from(x)).sum::<f64>() / map.len() as f64
}

#[test]
fn the_golden_pictures_are_the_golden_pictures() {
    let sum = |picture: &[Vec3]| picture.iter().map(|v| v.as_dvec3().element_sum()).sum::<f64>();
    let sums = pairs().map(|(reference, test)| [sum(&reference), sum(&test)]);
    let expected = [
        [6063.226198673248, 6119.720601916313],
        [6144.000102780759, 6137.137802539743],
        [5529.600036621094, 5529.600036621094],
    ];
    for (sums, expected) in sums.iter().zip(expected) {
        assert!((0..2).all(|i| (sums[i] - expected[i]).abs() < 1e-6), "{sums:?}, not {expected:?}");
    }
    let near = |a: Vec3, b: [f32; 3]| assert!((a - Vec3::from_array(b)).abs().max_element() < 1e-7, "{a}, not {b:?}");
    let [noises, gradients, _] = pairs();
    near(noises.0[0], [0.566_561_5, 0.745_781_7, 0.971_002_7]);
    near(noises.1[3 * SIDE + 5], [0.512_684_3, 0.130_916_77, 0.761_200_4]);
    near(gradients.1[3 * SIDE + 5], [0.0, 0.050_733_76, 0.012_965_03]);
}

#[test]
fn ldr_flip_is_the_golden_one() {
    // Mean of sRGB inputs, of the same numbers as linear inputs, pixels (0, 0) and (32, 32) of the sRGB map.
    let golden = [
        (0.449_283_599_9, 0.399_593_561_9, [0.706_965_8, 0.362_887_5]),
        (0.115_638_047_5, 0.107_686_705_9, [0.074_637_3, 0.110_141]),
        (0.181_619_435_5, 0.205_626_830_5, [0.844_275_1, 0.222_381_2]),
    ];
    for ((reference, test), (srgb, linear, pixels)) in pairs().iter().zip(golden) {
        let map = ldr(&decoded(reference), &decoded(test));
        assert!((mean(&map) - srgb).abs() < 1e-4, "sRGB: {}, not {srgb}", mean(&map));
        let here = [map[0], map[32 * SIDE + 32]];
        // Single pixels of the chequerboard lie on its edges, where the program's rounding shows most.
        assert!((0..2).all(|i| (here[i] - pixels[i]).abs() < 1e-4), "{here:?}, not {pixels:?}");
        let map = ldr(reference, test);
        assert!((mean(&map) - linear).abs() < 1e-4, "linear: {}, not {linear}", mean(&map));
    }
}

#[test]
fn hdr_flip_is_the_golden_one() {
    let golden = [
        (0.509_018_898, (-1.817_637, 0.562_488, 3)),
        (0.168_441_698, (-1.916_703, 0.563_874, 3)),
        (0.343_430_638_3, (0.926_643, 0.926_643, 2)),
    ];
    for ((reference, test), (expected, (start, stop, count))) in pairs().iter().zip(golden) {
        let (reference, test) = (bright(reference), bright(test));
        let exposures = Exposures::of(reference.iter().copied());
        assert!((exposures.start - start).abs() < 1e-5 && (exposures.stop - stop).abs() < 1e-5, "{exposures:?}");
        assert_eq!(exposures.count, count);
        let map = flip::hdr(&reference, &test, SIDE, exposures, PIXELS_PER_DEGREE);
        assert!((mean(&map) - expected).abs() < 1e-4, "{}, not {expected}", mean(&map));
    }
}

#[test]
fn flip_is_0_of_equal_pictures_and_1_of_green_and_blue() {
    let [(picture, _), ..] = pairs();
    assert!(ldr(&picture, &picture).iter().all(|&x| x == 0.0));
    let whole = |colour| vec![colour; SIDE * SIDE];
    let map = ldr(&whole(Vec3::Y), &whole(Vec3::Z));
    assert!(map.iter().all(|&x| (x - 1.0).abs() < 1e-3), "{}", map[0]);
    // Beyond what a display shows there is no difference; and any size has a map, down to one pixel.
    assert!(ldr(&whole(Vec3::ONE), &whole(Vec3::splat(f32::INFINITY))).iter().all(|&x| x == 0.0));
    for ppd in [1.0, 67.0, 1000.0] {
        let one = flip::ldr(&[Vec3::ZERO], &[Vec3::ONE], 1, ppd);
        // Black against white differs by a lightness of 100, beyond the knee of 0.95.
        assert!(one[0] > 0.9 && one[0] <= 1.0, "{one:?}");
    }
}

#[test]
fn flip_sees_a_mirrored_pair_mirrored_and_a_turned_pair_turned() {
    let [(a, b), ..] = pairs();
    let turned =
        |picture: &[Vec3]| -> Vec<Vec3> { (0..SIDE * SIDE).map(|i| picture[i % SIDE * SIDE + i / SIDE]).collect() };
    let (straight, other) = (ldr(&a, &b), ldr(&turned(&a), &turned(&b)));
    assert!((0..SIDE * SIDE).all(|i| (straight[i % SIDE * SIDE + i / SIDE] - other[i]).abs() < 1e-4));
    let mirrored = |picture: &[Vec3]| picture.iter().rev().copied().collect::<Vec<_>>();
    let back = ldr(&mirrored(&a), &mirrored(&b));
    assert!((0..SIDE * SIDE).all(|i| (straight[SIDE * SIDE - 1 - i] - back[i]).abs() < 1e-4));
}

#[test]
fn hdr_flip_does_not_depend_on_the_unit_and_takes_any_picture() {
    let [(a, b), ..] = pairs();
    let of = |unit: f32| {
        let scaled = |picture: &[Vec3]| bright(picture).iter().map(|v| *v * unit).collect::<Vec<_>>();
        let (a, b) = (scaled(&a), scaled(&b));
        flip::hdr(&a, &b, SIDE, Exposures::of(a.iter().copied()), PIXELS_PER_DEGREE)
    };
    let (one, much) = (of(1.0), of(1e3));
    assert!((mean(&one) - mean(&much)).abs() < 1e-5, "{} and {}", mean(&one), mean(&much));
    // Black, and the brightest there is.
    let strange = [Vec3::ZERO, Vec3::splat(f32::MAX), Vec3::splat(-1.0), Vec3::splat(1e-30)];
    for reference in [[Vec3::ZERO; 4], strange] {
        let exposures = Exposures::of(reference.iter().copied());
        assert!((2..=200).contains(&exposures.count), "{exposures:?}");
        let map = flip::hdr(&reference, &strange, 2, exposures, PIXELS_PER_DEGREE);
        assert!(map.iter().all(|x| (0.0..=1.0).contains(x)), "{map:?}");
    }
}

#[test]
fn a_map_is_pooled_by_its_mean_its_weighted_median_and_its_largest() {
    // In order, 1 and 2 are less than half of the sum; with 3 they are more.
    let pooled = Pooled::of(&[0.0, 4.0, 1.0, 2.0, 3.0, 0.0]);
    assert_eq!(pooled, Pooled { mean: 10.0 / 6.0, weighted_median: 3.0, max: 4.0 });
    assert_eq!(Pooled::of(&[]), Pooled::default());
    assert_eq!(Pooled::of(&[0.0; 3]), Pooled::default());
}
