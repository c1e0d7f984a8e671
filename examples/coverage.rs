//! How often do intervals of 16 runs hold what 1,600 runs say?
//!
//!     cargo run --release --example coverage [SCENE] [SEED] [RUNS]
//!
//! Renders a scene (`scenes/first-night.toml`) at 64x36 in 1,600 independent runs of each row's strategy, and takes
//! RUNS (16) of them 2,000 times. The truth is the figure of all 1,600; the intervals are those of tables, at 95 %. A
//! row without an upper end holds whatever is not below its lower end; how often that was said is printed too. CPU
//! times are the mean of the 1,600 with 3 % of noise for each run, so that other work on the machine has no part in it.
//! Seven minutes of one core.

use citylights::base::curve::seconds_to;
use citylights::base::error::{Error, Result};
use citylights::base::interval::{Estimate, LARGEST, Tail};
use citylights::base::random::{RunKey, Stream};
use citylights::measure::clock::timed;
use citylights::measure::errors::{Errors, Truth};
use citylights::measure::observer::Unobserved;
use citylights::measure::reference::Reference;
use citylights::measure::target::Target;
use citylights::render::film::Film;
use citylights::render::passes::Plan;
use citylights::scene::file::{Overrides, open};
use citylights::strategy::BuildContext;
use citylights::strategy::registry::parse;
use citylights::visibility::offset::Offset;
use citylights::visibility::stage::{LeaveOut, Stage};
use glam::Vec3;
use rayon::prelude::*;
use std::path::Path;

/// Each strategy with its passes, and those of them that are rows of the table.
const ROWS: [(&str, &[u32], &[u32]); 8] = [
    ("power", &[1, 4, 16, 64], &[4, 64]),
    ("light-tree", &[1, 4, 16, 64], &[4, 64]),
    ("visible", &[1, 4, 16, 64], &[4, 64]),
    ("stochastic-cull", &[1, 4, 16], &[4, 16]),
    ("uniform", &[1, 4], &[4]),
    ("intensity", &[1, 4, 16, 64], &[64]),
    ("resampled", &[1, 2, 8, 32], &[32]),
    ("influence-tail", &[1, 4, 16, 64], &[64]),
];
const ALL: usize = 1_600;
const REDRAWS: usize = 2_000;
const CONFIDENCE: f64 = 0.95;
const CPU_NOISE: f64 = 0.03;
const FIGURES: [&str; 4] = ["error", "V", "s to 0.1", "s to 0.01"];

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or_else(|| "scenes/first-night.toml".into());
    let mut number = |default: usize| {
        let Some(text) = arguments.next() else { return Ok(default) };
        text.parse().map_err(|_| Error::Invalid(format!("`{text}`: a whole number is right")))
    };
    let (seed, runs) = (number(1)? as u64, number(16)?.clamp(2, ALL / 4));
    let scene = open(Path::new(&file), &Overrides { resolution: Some((64, 36)), ..Overrides::default() })?;
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    let target = Target::whole(&stage);
    let truth = Reference::compute(&target, 1e-6, Path::new("target/citylights-references"), &Unobserved)?.truth;
    println!("{file} at 64x36, seed {seed}: {REDRAWS} times {runs} of {ALL} runs, intervals at 95 %");
    println!("of each figure: held %, truth above / below the interval %, no upper end %, upper end / figure (median)");
    println!("{:20}{}", "", FIGURES.map(|figure| format!("{figure:>36}")).concat());
    for (name, passes, rows) in ROWS {
        let curve = Curve::render(&target, &truth, name, passes, seed)?;
        for &row in rows {
            let rungs = passes.iter().take_while(|&&p| p <= row).count();
            let found = curve.coverage(rungs, runs, seed);
            println!("{:20}{}", format!("{name} {row}"), found.map(|tally| tally.to_string()).concat());
        }
    }
    Ok(())
}

/// What all runs of a strategy left.
struct Curve {
    setup_s: f64,
    /// Seconds of set-up and sampling after each number of passes: means.
    seconds: Vec<f64>,
    /// By number of passes, then run.
    errors: Vec<Vec<Errors>>,
    /// By number of passes, then run: what the image is off by, weighted so that its squares add up to relMSE.
    images: Vec<Vec<Vec<Vec3>>>,
}

impl Curve {
    fn render(target: &Target<'_>, truth: &Truth, name: &str, passes: &[u32], seed: u64) -> Result<Self> {
        let strategy = parse(name)?;
        let n = target.receivers.len();
        let weights: Vec<_> = (0..n).map(|i| (truth.weight(i) / (3 * n) as f64).map(f64::sqrt).as_vec3()).collect();
        let run = |run: usize| {
            let key = RunKey { seed, run: run as u32 };
            let context = BuildContext { stage: target.stage, seed: key.stream(u32::MAX, 0).bits() };
            let (sampler, setup) = timed(|| strategy.build(context));
            let sampler = sampler?;
            let plan = Plan { stage: target.stage, receivers: &target.receivers, sampler: sampler.as_ref(), key };
            let mut film = Film::new(n);
            let mut cpu = vec![setup.cpu];
            let left = passes.iter().map(|&passes| {
                let ((), block) = timed(|| plan.run(passes - film.passes(), &mut film));
                cpu.push(cpu[cpu.len() - 1] + block.cpu);
                let image = film.image();
                let off = image.iter().zip(truth.mean()).zip(&weights).map(|((x, r), w)| (*x - *r) * *w).collect();
                (truth.errors(&image), off)
            });
            let (errors, images): (Vec<Errors>, Vec<Vec<Vec3>>) = left.collect();
            Ok((cpu, errors, images))
        };
        let runs = (0..ALL).into_par_iter().map(run).collect::<Result<Vec<_>>>()?;
        let mean = |i: usize| runs.iter().map(|(cpu, ..)| cpu[i]).sum::<f64>() / ALL as f64;
        Ok(Self {
            setup_s: mean(0),
            seconds: (1..=passes.len()).map(mean).collect(),
            errors: (0..passes.len()).map(|b| runs.iter().map(|(_, errors, _)| errors[b]).collect()).collect(),
            images: (0..passes.len()).map(|b| runs.iter().map(|(.., images)| images[b].clone()).collect()).collect(),
        })
    }

    /// Inner products of the images of each two runs after a number of passes.
    fn products(&self, rung: usize) -> Vec<f32> {
        let images = &self.images[rung];
        let row = |i: usize| {
            let product = move |j: usize| images[i].iter().zip(&images[j]).map(|(a, b)| a.dot(*b)).sum::<f32>();
            (0..ALL).map(product)
        };
        (0..ALL).into_par_iter().flat_map_iter(row).collect()
    }

    /// How often the intervals of a row's figures hold them.
    fn coverage(&self, rungs: usize, runs: usize, seed: u64) -> [Tally; 4] {
        let everyone: Vec<usize> = (0..ALL).collect();
        let mut stream = Stream::keyed(&[seed, u64::from_le_bytes(*b"coverage")]);
        let products = self.products(rungs - 1);
        let truth = self.figures(rungs, &products, &everyone, &mut || 1.0);
        let mut tallies = truth.map(|estimate| Tally { truth: estimate.value(), ..Tally::default() });
        for _ in 0..REDRAWS {
            let mut chosen = everyone.clone();
            for i in 0..runs {
                chosen.swap(i, i + stream.below(ALL - i));
            }
            let mut noise = || 1.0 + CPU_NOISE * (12.0f64.sqrt() * (stream.uniform64() - 0.5));
            let figures = self.figures(rungs, &products, &chosen[..runs], &mut noise);
            tallies.iter_mut().zip(figures).for_each(|(tally, figure)| tally.take(&figure));
        }
        tallies
    }

    /// The figures of [`FIGURES`] by some of the runs.
    fn figures(
        &self,
        rungs: usize,
        products: &[f32],
        runs: &[usize],
        noise: &mut impl FnMut() -> f64,
    ) -> [Estimate; 4] {
        let seconds: Vec<Estimate> = (0..rungs)
            .map(|b| Estimate::new(runs.iter().map(|_| self.seconds[b] * noise()).collect(), Tail::NONE))
            .collect();
        let errors: Vec<(Vec<f64>, Tail)> = (0..rungs)
            .map(|b| {
                let values: Vec<f64> = runs.iter().map(|&run| self.errors[b][run].rel_mse).collect();
                let largest: Vec<[f64; LARGEST]> = runs.iter().map(|&run| self.errors[b][run].largest).collect();
                let tail = Tail::of(&values, &largest);
                (values, tail)
            })
            .collect();
        let last = rungs - 1;
        let variance = Estimate::new(variances(products, runs), errors[last].1);
        let errors: Vec<Estimate> = errors.into_iter().map(|(values, tail)| Estimate::new(values, tail)).collect();
        let curve: Vec<&Estimate> = seconds.iter().chain(&errors).collect();
        let until = |error| Estimate::of(&curve, |m| seconds_to(error, self.setup_s, &m[..rungs], &m[rungs..]));
        [
            errors[last].clone(),
            Estimate::of(&[&variance, &seconds[last]], |m| m[0] * (m[1] - self.setup_s)),
            until(0.1),
            until(0.01),
        ]
    }
}

/// Each run's share in the variance: its squared distance from the mean image, by K / (K - 1).
fn variances(products: &[f32], runs: &[usize]) -> Vec<f64> {
    let k = runs.len() as f64;
    let product = |i: usize, j: usize| f64::from(products[i * ALL + j]);
    let rows: Vec<f64> = runs.iter().map(|&i| runs.iter().map(|&j| product(i, j)).sum::<f64>() / k).collect();
    let mean = rows.iter().sum::<f64>() / k;
    runs.iter().zip(rows).map(|(&i, row)| (product(i, i) - 2.0 * row + mean) * k / (k - 1.0)).collect()
}

/// How one figure's intervals fared.
#[derive(Default)]
struct Tally {
    truth: f64,
    above: u32,
    below: u32,
    heavy: u32,
    reaches: Vec<f64>,
}

impl Tally {
    fn take(&mut self, figure: &Estimate) {
        let bounds = figure.bounds(CONFIDENCE);
        self.above += u32::from(self.truth > bounds.high);
        self.below += u32::from(self.truth < bounds.low);
        self.heavy += u32::from(figure.heavy());
        self.reaches.push(bounds.high / figure.value());
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let share = |count: u32| f64::from(count) / self.reaches.len() as f64 * 100.0;
        let mut reaches = self.reaches.clone();
        reaches.sort_by(f64::total_cmp);
        let held = 100.0 - share(self.above) - share(self.below);
        let (above, below, heavy) = (share(self.above), share(self.below), share(self.heavy));
        write!(f, "{held:9.1} {above:5.1} /{below:4.1} {heavy:6.1} {:7.2}", reaches[reaches.len() / 2])
    }
}
