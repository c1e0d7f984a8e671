//! Does a peer's image agree with the reference, as a whole and block by block?
//!
//! A mean may agree by chance while one corner is too bright and another too dark: so the means of blocks of pixels are
//! held against their own noise, which the independent runs tell.

use crate::base::colour::luminance;
use crate::base::statistics::{Moments, sidak, student_quantile};
use crate::measure::errors::Truth;
use crate::record::Interval;
use glam::Vec3;
use std::collections::BTreeMap;

/// The side of a block, in pixels.
pub(crate) const SIDE: u32 = 8;

/// How far images of independent runs are from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agreement {
    /// Mean luminance over that of the truth, with its 95 % interval over the runs and the truth's own error.
    pub ratio: Interval,
    /// Blocks of [`SIDE`] x [`SIDE`] pixels with something to compare in them.
    pub blocks: usize,
    /// Those whose mean is outside its own 95 % interval: a twentieth is expected.
    pub beyond_95: usize,
    /// Those outside an interval that would hold for all blocks together in 99 of 100 images (Sidak): none is expected.
    pub beyond_all: usize,
    /// The largest difference of a block's mean from the truth's, as a share of it, among those `beyond_all`.
    pub worst: f64,
}

impl Agreement {
    /// Compares the images of at least three runs with the truth; `pixels` are the column and row of each receiver.
    pub(crate) fn of(truth: &Truth, images: &[&[Vec3]], pixels: &[(u32, u32)]) -> Option<Self> {
        if images.len() < 3 || pixels.is_empty() {
            return None;
        }
        let mut blocks: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        for (i, (x, y)) in pixels.iter().enumerate() {
            blocks.entry((y / SIDE, x / SIDE)).or_default().push(i);
        }
        let freedom = images.len() - 1;
        let all: Vec<usize> = (0..pixels.len()).collect();
        let whole = Means::of(truth, images, &all);
        let half_width = student_quantile(0.975, freedom) * whole.noise() / whole.truth;
        let ratio = Interval::symmetric(whole.runs.mean / whole.truth, half_width);
        let [one, together] =
            [0.05, sidak(0.01, blocks.len())].map(|level| student_quantile(1.0 - 0.5 * level, freedom));
        let mut found = Self { ratio, blocks: blocks.len(), beyond_95: 0, beyond_all: 0, worst: 0.0 };
        for places in blocks.values() {
            let block = Means::of(truth, images, places);
            let (off, noise) = (block.runs.mean - block.truth, block.noise());
            found.beyond_95 += usize::from(off.abs() > one * noise);
            if off.abs() > together * noise {
                found.beyond_all += 1;
                let share = off / block.truth;
                if !share.is_finite() || share.abs() > found.worst.abs() {
                    found.worst = share;
                }
            }
        }
        Some(found)
    }
}

/// Mean luminance of some receivers: that of each run, and the truth's.
struct Means {
    runs: Moments,
    truth: f64,
    /// Variance of `truth`.
    own: f64,
}

impl Means {
    fn of(truth: &Truth, images: &[&[Vec3]], places: &[usize]) -> Self {
        let n = places.len() as f64;
        let mean = |image: &[Vec3]| places.iter().map(|&i| f64::from(luminance(image[i]))).sum::<f64>() / n;
        let runs: Vec<f64> = images.iter().map(|image| mean(image)).collect();
        let own = places.iter().map(|&i| truth.variance(i)).sum::<f64>() / (n * n);
        Self { runs: Moments::of(runs.iter().copied()), truth: mean(truth.mean()), own }
    }

    /// Standard error of the difference.
    fn noise(&self) -> f64 {
        self.runs.standard_error().hypot(self.own.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Stream;

    /// Runs of noise about `radiance` on a 64 x 64 film whose truth is 1.
    fn agreement(radiance: impl Fn(u32, u32) -> f32) -> Agreement {
        let pixels: Vec<(u32, u32)> = (0..64).flat_map(|y| (0..64).map(move |x| (x, y))).collect();
        let image = |run: u64| {
            let mut rng = Stream::keyed(&[run]);
            pixels.iter().map(|&(x, y)| Vec3::splat(radiance(x, y) * (0.5 + rng.uniform()))).collect::<Vec<_>>()
        };
        let images: Vec<Vec<Vec3>> = (0..8).map(image).collect();
        let images: Vec<&[Vec3]> = images.iter().map(Vec::as_slice).collect();
        let ones = vec![Vec3::ONE; pixels.len()];
        Agreement::of(&Truth::new([ones.clone(), ones]), &images, &pixels).expect("runs")
    }

    #[test]
    fn equal_images_agree_within_their_noise() {
        let found = agreement(|_, _| 1.0);
        assert!(
            (found.ratio.mean - 1.0).abs() < found.ratio.half_width() && found.ratio.half_width() < 0.01,
            "{found:?}"
        );
        assert!(found.blocks == 64 && found.beyond_95 < 10 && found.beyond_all == 0, "{found:?}");
    }

    #[test]
    fn a_corner_that_is_off_shows_where_the_mean_does_not() {
        let found = agreement(|x, y| match (x / 8, y / 8) {
            (0, 0) => 1.2,
            (7, 7) => 0.8,
            _ => 1.0,
        });
        assert!((found.ratio.mean - 1.0).abs() < found.ratio.half_width(), "{found:?}");
        assert_eq!(found.beyond_all, 2, "{found:?}");
        assert!((found.worst.abs() - 0.2).abs() < 0.05, "{found:?}");
    }
}
