//! FLIP of pictures as they are displayed: a difference of colour for each pixel, raised where features differ.

use super::colour::{Opponent, perceived, redistributed};
use super::feature::{Features, difference};
use super::filter::Contrast;
use glam::Vec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels per degree of the papers' viewer: 0.7 m before a screen 0.7 m wide with 3,840 pixels.
pub(crate) const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Largest pixels per degree that the filters are made for; they reach over an eighth of a degree each way.
pub(crate) const MOST_PIXELS_PER_DEGREE: f64 = 1000.0;

/// FLIP of two pictures as they are displayed, pixel by pixel, 0 to 1: row by row, `width` pixels each.
///
/// Values are linear Rec. 709; beyond `[0, 1]` they are clamped, as a display does. NaN is not allowed. Both pictures
/// have the same size; `pixels_per_degree` is 1 to [`MOST_PIXELS_PER_DEGREE`].
pub(crate) fn ldr(reference: &[Vec3], test: &[Vec3], width: usize, pixels_per_degree: f64) -> Vec<f32> {
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
            let feature = difference(reference.1[i], test.1[i]);
            colour.powf(1.0 - feature)
        })
        .collect()
}
