//! The means of many independent runs against the exact image, for strategies that look at a whole frame.

use crate::promises::common::sampler;
use citylights::base::colour::luminance;
use citylights::base::random::RunKey;
use citylights::base::statistics::{Moments, sidak, student_quantile};
use citylights::render::exact::exact;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::visibility::stage::Stage;
use rayon::prelude::*;

/// Images of independent runs as luminance, and the exact one.
pub(crate) struct Runs {
    images: Vec<Vec<f64>>,
    truth: Vec<f64>,
}

impl Runs {
    pub(crate) fn new(strategy: &str, stage: &Stage, runs: u32, passes: u32) -> Self {
        let sampler = sampler(strategy, stage);
        let images = (0..runs).into_par_iter().map(|run| {
            let mut film = Film::new(stage.receivers().len());
            let key = RunKey { seed: 5, run };
            Plan { stage, receivers: stage.receivers(), sampler: &*sampler, key }.run(passes, &mut film);
            film.image().iter().map(|&rgb| f64::from(luminance(rgb))).collect()
        });
        let truth = |at| f64::from(luminance(exact(stage, at, 4_000, 6).mean().as_vec3()));
        Self { images: images.collect(), truth: stage.receivers().par_iter().map(truth).collect() }
    }

    /// The mean of all receivers over the exact one, in each run.
    pub(crate) fn energy(&self) -> Moments {
        let exact: f64 = self.truth.iter().sum();
        Moments::of(self.images.iter().map(|image| image.iter().sum::<f64>() / exact))
    }

    /// Mean squared error of a run.
    pub(crate) fn mse(&self) -> f64 {
        let square = |image: &Vec<f64>| image.iter().zip(&self.truth).map(|(x, r)| (x - r).powi(2)).sum::<f64>();
        self.images.iter().map(square).sum::<f64>() / (self.images.len() * self.truth.len()) as f64
    }

    /// The greatest |t| of a receiver's mean against the exact one, and its limit at 1 % for all receivers together.
    pub(crate) fn worst(&self) -> (f64, f64) {
        let t = |i: usize| {
            let found = Moments::of(self.images.iter().map(|image| image[i]));
            let error = found.standard_error().hypot(2e-3 * self.truth[i]);
            if found.mean == self.truth[i] { 0.0 } else { ((found.mean - self.truth[i]) / error).abs() }
        };
        let worst = (0..self.truth.len()).map(t).fold(0.0, f64::max);
        let level = sidak(0.01, self.truth.len());
        (worst, student_quantile(1.0 - 0.5 * level, self.images.len() - 1))
    }

    /// The means of all receivers and of their sum are right.
    pub(crate) fn assert_unbiased(&self, name: &str) {
        let (worst, limit) = self.worst();
        assert!(worst <= limit, "{name}: |t| {worst} of a receiver, limit {limit}, seed 5");
        let energy = self.energy();
        let (off, limit) = (energy.mean - 1.0, energy.half_width(0.99).hypot(1e-4));
        println!("{name}: energy {off:+.5} ±{limit:.5}, worst |t| {worst:.2}, MSE {:.4e}", self.mse());
        assert!(off.abs() <= limit, "{name}: energy off by {off}, limit {limit}, seed 5");
    }
}
