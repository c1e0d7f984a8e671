//! How far apart are two pictures to an eye that flips between them?
//!
//! FLIP gives each pixel a difference from 0 to 1: of colour, after what the eye cannot resolve at this distance is
//! filtered away, raised where edges or points differ.
//!
//! Sources: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for
//! Alternating Images", HPG 2020; for high dynamic range Andersson, Nilsson, Shirley and Akenine-Möller, "Visualizing
//! Errors in Rendered High Dynamic Range Images", Eurographics 2021. `tests/flip.rs` holds figures of the authors' own
//! program.

mod colour;
mod exposure;
mod feature;
mod filter;

pub use exposure::{Exposures, hdr};

use colour::{Opponent, perceived, redistributed};
use feature::Features;
use filter::Contrast;
use glam::Vec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels per degree of the papers' viewer: 0.7 m before a screen 0.7 m wide with 3,840 pixels.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Largest pixels per degree that the filters are made for; they reach over an eighth of a degree each way.
pub const MOST_PIXELS_PER_DEGREE: f64 = 1000.0;

/// FLIP of two pictures as they are displayed, pixel by pixel, 0 to 1: row by row, `width` pixels each.
///
/// Values are linear Rec. 709; beyond `[0, 1]` they are clamped, as a display does. NaN is not allowed. Both pictures
/// have the same size; `pixels_per_degree` is 1 to [`MOST_PIXELS_PER_DEGREE`].
pub fn ldr(reference: &[Vec3], test: &[Vec3], width: usize, pixels_per_degree: f64) -> Vec<f32> {
    debug_assert_eq!(reference.len(), test.len());
    let opponent = Opponent::new();
    let contrast = Contrast::new(pixels_per_degree);
    let features = Features::new(pixels_per_degree);
    let see = |picture: &[Vec3]| {
        let planes = opponent.planes(picture);
        let colours = perceived(&opponent, &contrast.filter(&planes, width));
        (colours, features.of(&planes[0], width))
    };
    let (reference, test) = (see(reference), see(test));
    let redistribute = redistributed(&opponent);
    (0..reference.0.len())
        .into_par_iter()
        .map(|i| {
            let colour = redistribute(reference.0[i], test.0[i]);
            let feature = feature::difference(reference.1[i], test.1[i]);
            colour.powf(1.0 - feature)
        })
        .collect()
}

/// What a map of differences comes to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pooled {
    /// The mean.
    pub mean: f64,
    /// Half of the sum of all differences lies in pixels with this difference or less.
    pub weighted_median: f64,
    /// The largest.
    pub max: f64,
}

impl Pooled {
    /// Of these differences, 0 or more each; of none, all are 0.
    pub fn of(differences: &[f64]) -> Self {
        let mut sorted = differences.to_vec();
        sorted.sort_by(f64::total_cmp);
        let total: f64 = sorted.iter().sum();
        let mut below = 0.0;
        let half = sorted.iter().find(|&&difference| {
            below += difference;
            below >= 0.5 * total
        });
        Self {
            mean: total / sorted.len().max(1) as f64,
            weighted_median: half.copied().unwrap_or(0.0),
            max: sorted.last().copied().unwrap_or(0.0),
        }
    }
}
