//! Edges and points, which the eye finds first (section 4.2 of the paper of 2020).

use super::filter::{offsets, separable};
use std::f64::consts::FRAC_1_SQRT_2;

/// Width of the feature detectors, in degrees.
const WIDTH: f64 = 0.082;

/// Filters that find edges (first derivative of a Gaussian) and points (its second), along one axis, and the Gaussian
/// for the other.
pub(super) struct Features {
    gaussian: Vec<f32>,
    edge: Vec<f32>,
    point: Vec<f32>,
}

/// How much edge and how much point there is in a pixel.
#[derive(Clone, Copy)]
pub(super) struct Feature {
    edge: f32,
    point: f32,
}

impl Features {
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        let deviation = 0.5 * WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let taps = |factor: &dyn Fn(f64) -> f64| -> Vec<f64> {
            offsets(radius).map(|x| x / deviation).map(|x| factor(x) * (-0.5 * x * x).exp()).collect()
        };
        Self {
            gaussian: balanced(&taps(&|_| 1.0)),
            edge: balanced(&taps(&|x| -x)),
            point: balanced(&taps(&|x| x * x - 1.0)),
        }
    }

    /// The features of the plane Y of a picture.
    pub(super) fn of(&self, y: &[f32], width: usize) -> Vec<Feature> {
        let achromatic: Vec<f32> = y.iter().map(|y| (y + 16.0) / 116.0).collect();
        let strength = |kernel: &[f32]| {
            let across = separable(&achromatic, width, kernel, &self.gaussian);
            let down = separable(&achromatic, width, &self.gaussian, kernel);
            across.into_iter().zip(down).map(|(across, down)| across.hypot(down))
        };
        strength(&self.edge).zip(strength(&self.point)).map(|(edge, point)| Feature { edge, point }).collect()
    }
}

/// The difference of the features of two pixels, 0 to 1.
pub(super) fn difference(a: Feature, b: Feature) -> f32 {
    let larger = (a.edge - b.edge).abs().max((a.point - b.point).abs());
    (FRAC_1_SQRT_2 as f32 * larger).sqrt().min(1.0)
}

/// The taps with the positive ones scaled to a sum of 1, the negative ones to a sum of -1.
fn balanced(taps: &[f64]) -> Vec<f32> {
    let sum = |sign: f64| taps.iter().map(|tap| (sign * tap).max(0.0)).sum::<f64>();
    let (above, below) = (sum(1.0), sum(-1.0));
    taps.iter().map(|&tap| if tap > 0.0 { tap / above } else if tap < 0.0 { tap / below } else { 0.0 } as f32).collect()
}
