//! FLIP of high dynamic range: the largest difference at any exposure that shows the reference.

use super::ldr::ldr;
use crate::base::colour::luminance;
use glam::{DVec3, Vec3};

/// `f(x) = (x (a x + b)) / (x (c x + d) + e)`, with x the exposed value.
struct ToneMap {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
}

/// Narkowicz's fit of the ACES curve (2016), with his factor 0.6 before it: the papers' tone map.
const ACES: ToneMap = ToneMap { a: 0.36 * 2.51, b: 0.6 * 0.03, c: 0.36 * 2.43, d: 0.6 * 0.59, e: 0.14 };

/// Where on the curve the brightest luminance lies at the first exposure, and the median one at the last.
const SHOWN: f64 = 0.85;

/// A median (or a maximum) below this counts as this, so that a black picture has exposures too. The authors' program
/// has the same limit.
const DARKEST: f64 = f32::EPSILON as f64;

/// Exposures in stops (factors of two), evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exposures {
    /// The first: the brightest pixel is just not burnt out.
    pub start: f64,
    /// The last: half of the picture is at least as bright as the brightest pixel was.
    pub stop: f64,
    /// How many: no more than a stop apart, two at least.
    pub count: u32,
}

impl Exposures {
    /// Those that show a picture, from the luminances of its pixels; negative components count as 0.
    pub(crate) fn of(reference: impl Iterator<Item = Vec3>) -> Self {
        let mut luminances: Vec<f32> = reference.map(|rgb| luminance(rgb.max(Vec3::ZERO))).collect();
        luminances.sort_by(f32::total_cmp);
        let shown = ACES.inverse(SHOWN);
        let stops = |l: Option<&f32>| (shown / f64::from(l.copied().unwrap_or(0.0)).max(DARKEST)).log2();
        let (start, stop) = (stops(luminances.last()), stops(luminances.get(luminances.len() / 2)));
        Self { start, stop, count: ((stop - start).ceil() as u32).max(2) }
    }

    /// The factors on the picture.
    fn factors(self) -> impl Iterator<Item = f64> {
        let step = (self.stop - self.start) / f64::from(self.count - 1);
        (0..self.count).map(move |i| (self.start + f64::from(i) * step).exp2())
    }
}

/// HDR-FLIP of two pictures of linear radiance, pixel by pixel, 0 to 1: row by row, `width` pixels each.
///
/// In any unit: the exposures, [`Exposures::of`] the reference, take it away. Negative components count as 0; NaN is
/// not allowed.
pub(crate) fn hdr(
    reference: &[Vec3],
    test: &[Vec3],
    width: usize,
    exposures: Exposures,
    pixels_per_degree: f64,
) -> Vec<f32> {
    let mut largest = vec![0.0f32; reference.len()];
    for factor in exposures.factors() {
        let shown = |picture: &[Vec3]| picture.iter().map(|&rgb| ACES.apply(factor, rgb)).collect::<Vec<_>>();
        let map = ldr(&shown(reference), &shown(test), width, pixels_per_degree);
        largest.iter_mut().zip(map).for_each(|(largest, here)| *largest = largest.max(here));
    }
    largest
}

impl ToneMap {
    /// The exposed and mapped colour; f64, as the squares of bright radiances overflow f32.
    fn apply(&self, factor: f64, rgb: Vec3) -> Vec3 {
        let x = rgb.as_dvec3().max(DVec3::ZERO) * factor;
        (x * (x * self.a + self.b) / (x * (x * self.c + self.d) + self.e)).as_vec3()
    }

    /// The positive value that is mapped to `t`.
    fn inverse(&self, t: f64) -> f64 {
        // t times the denominator is the numerator: a quadratic in x.
        let (a, b, c) = (self.a - t * self.c, self.b - t * self.d, -t * self.e);
        (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)
    }
}
