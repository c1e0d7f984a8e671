//! How far are two pictures apart, in figures?

use super::flip::{self, Exposures, Pooled};
use super::picture::Picture;
use crate::base::colour::luminance;
use crate::base::error::{Error, Result};
use crate::base::rel_mse::{Means, RelMse};
use glam::{DVec3, Vec3};

/// Two pictures of one size and the pixels that count.
///
/// A pixel is left out where the mask says so, or where a component of either picture is NaN or infinite. Left-out
/// pixels are black in both, so that they add nothing to their neighbours' FLIP either.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    reference: Vec<Vec3>,
    test: Vec<Vec3>,
    width: usize,
    counted: Vec<bool>,
    masked: usize,
    not_finite: usize,
}

/// The errors of a test picture, over the pixels that count and their channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Errors {
    /// Mean luminance of reference and test.
    pub mean: [f64; 2],
    /// Mean squared error, in the square of the pictures' unit.
    pub mse: f64,
    /// relMSE: see [`RelMse`].
    pub rel_mse: Means,
    /// The epsilon of relMSE, per channel.
    pub epsilon: Vec3,
}

impl Pair {
    /// The test picture beside the reference; `mask` is not 0 where a pixel is left out.
    ///
    /// # Errors
    /// Pictures of different sizes; a mask and values that are not finite which leave no pixel.
    pub(crate) fn new(reference: &Picture, test: &Picture, mask: Option<&Picture>) -> Result<Self> {
        let size = |picture: &Picture| (picture.width, picture.height);
        for (name, other) in [("test", Some(test)), ("mask", mask)] {
            if let Some(other) = other.filter(|other| size(other) != size(reference)) {
                let ((w, h), (ow, oh)) = (size(reference), size(other));
                return Err(Error::Invalid(format!(
                    "the reference has {w} x {h} pixels, the {name} {ow} x {oh}; the same size is right"
                )));
            }
        }
        let masked = |i: usize| mask.is_some_and(|mask| mask.pixels[i] != [0.0; 3]);
        let finite = |pixel: &[f32; 3]| pixel.iter().all(|c| c.is_finite());
        let mut pair = Self {
            reference: reference.pixels.iter().map(|&rgb| Vec3::from_array(rgb)).collect(),
            test: test.pixels.iter().map(|&rgb| Vec3::from_array(rgb)).collect(),
            width: reference.width as usize,
            counted: vec![true; reference.pixels.len()],
            masked: 0,
            not_finite: 0,
        };
        for i in 0..pair.counted.len() {
            let (masked, finite) = (masked(i), finite(&reference.pixels[i]) && finite(&test.pixels[i]));
            if masked || !finite {
                (pair.counted[i], pair.reference[i], pair.test[i]) = (false, Vec3::ZERO, Vec3::ZERO);
                pair.masked += usize::from(masked);
                pair.not_finite += usize::from(!masked);
            }
        }
        if pair.pixels() == 0 {
            return Err(Error::Invalid(format!(
                "no pixel is left: {} masked, {} not finite",
                pair.masked, pair.not_finite
            )));
        }
        Ok(pair)
    }

    /// Whether each pixel counts, row by row from the top.
    pub(crate) fn counted(&self) -> &[bool] {
        &self.counted
    }

    /// How many pixels count.
    pub(crate) fn pixels(&self) -> usize {
        self.counted.len() - self.masked - self.not_finite
    }

    /// How many the mask leaves out.
    pub(crate) fn masked(&self) -> usize {
        self.masked
    }

    /// How many others are left out for a component that is not finite.
    pub(crate) fn not_finite(&self) -> usize {
        self.not_finite
    }

    /// The errors of the test picture.
    pub(crate) fn errors(&self) -> Errors {
        let mean = |picture: &[Vec3]| {
            self.those_counted(picture).map(|rgb| f64::from(luminance(rgb))).sum::<f64>() / self.pixels() as f64
        };
        let squares: Vec<f64> = self.those_counted(&self.squared_errors()).collect();
        let relative: Vec<f64> = self.those_counted(&self.relative_errors()).collect();
        Errors {
            mean: [mean(&self.reference), mean(&self.test)],
            mse: squares.iter().sum::<f64>() / squares.len() as f64,
            rel_mse: Means::of(&relative),
            epsilon: self.relative().epsilon(),
        }
    }

    /// Squared error of every pixel, the mean of its channels; 0 where a pixel is left out.
    pub(crate) fn squared_errors(&self) -> Vec<f64> {
        self.weighted_squares(|_| DVec3::ONE)
    }

    /// Relative squared error of every pixel, the mean of its channels; 0 where a pixel is left out.
    pub(crate) fn relative_errors(&self) -> Vec<f64> {
        let relative = self.relative();
        self.weighted_squares(|r| relative.weight(r))
    }

    /// FLIP of every pixel at this exposure (display units per unit of the pictures), 0 to 1.
    pub(crate) fn flip(&self, exposure: f32, pixels_per_degree: f64) -> Vec<f64> {
        let shown = |picture: &[Vec3]| picture.iter().map(|&rgb| rgb * exposure).collect::<Vec<_>>();
        widened(flip::ldr(&shown(&self.reference), &shown(&self.test), self.width, pixels_per_degree))
    }

    /// The exposures that show the reference's counted pixels.
    pub(crate) fn exposures(&self) -> Exposures {
        Exposures::of(self.those_counted(&self.reference))
    }

    /// HDR-FLIP of every pixel, 0 to 1.
    pub(crate) fn hdr_flip(&self, exposures: Exposures, pixels_per_degree: f64) -> Vec<f64> {
        widened(flip::hdr(&self.reference, &self.test, self.width, exposures, pixels_per_degree))
    }

    /// What a map comes to over the pixels that count.
    pub(crate) fn pooled(&self, map: &[f64]) -> Pooled {
        Pooled::of(&self.those_counted(map).collect::<Vec<_>>())
    }

    fn relative(&self) -> RelMse {
        RelMse::about(&self.those_counted(&self.reference).collect::<Vec<_>>())
    }

    fn weighted_squares(&self, weight: impl Fn(Vec3) -> DVec3) -> Vec<f64> {
        let square = |(&r, &x): (&Vec3, &Vec3)| {
            let difference = x.as_dvec3() - r.as_dvec3();
            (difference * difference * weight(r)).element_sum() / 3.0
        };
        self.reference.iter().zip(&self.test).map(square).collect()
    }

    fn those_counted<'a, T: Copy>(&'a self, values: &'a [T]) -> impl Iterator<Item = T> + 'a {
        values.iter().zip(&self.counted).filter(|(_, counted)| **counted).map(|(value, _)| *value)
    }
}

fn widened(map: Vec<f32>) -> Vec<f64> {
    map.into_iter().map(f64::from).collect()
}
