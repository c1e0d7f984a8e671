//! `citylights diff-image`: how far is a picture from another?

use super::outcome::Outcome;
use super::output::check_output;
use super::terminal::{print, say};
use super::values::{exposure, finite};
use crate::base::colour;
use crate::base::error::Error;
use crate::image::flip::{MOST_PIXELS_PER_DEGREE, PIXELS_PER_DEGREE, Pooled};
use crate::image::map::{Map, Scale};
use crate::image::metrics::Pair;
use crate::image::{self, Format, MOST_PIXELS};
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// relMSE of a pixel that is black in its map, and of one that is brightest.
const RELATIVE_DECADES: (f64, f64) = (1e-4, 1e2);

/// How far below the largest squared error its map is black.
const SQUARE_DECADES: f64 = 1e-6;

const HELP: &str = "\
Both pictures are EXR files of linear radiance, or both PNG files of displayed values. relMSE is the mean of \
(x - r)^2 / (r^2 + epsilon), epsilon = 0.01 mean(r)^2 per channel. FLIP is LDR-FLIP of what a display shows at the \
exposure; HDR-FLIP, for EXR files, is the largest at any exposure that shows the reference. A pixel with a component \
that is NaN or infinite is left out of all figures; their number is printed.";

#[derive(Args)]
#[command(after_help = HELP)]
pub(super) struct Arguments {
    /// What is taken for the truth: .exr or .png. relMSE is relative to it
    reference: PathBuf,
    /// What is compared to it, in the same format and size
    test: PathBuf,
    /// Write a map of the error: .png in colours (pixels left out are grey), .exr with the values (NaN there)
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// What the map shows and --fail-above looks at; hdr-flip for EXR files without an exposure, else flip
    #[arg(long)]
    metric: Option<Metric>,
    /// Leave out the pixels that are not 0 in this picture
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Factor from the pictures' values to displayed ones, for FLIP; 1 by default
    #[arg(long, value_name = "X", value_parser = exposure)]
    exposure: Option<f32>,
    /// Exposure value at ISO 100, instead of a factor: it is 1 / (1.2 * 2^X)
    #[arg(long, value_name = "X", value_parser = finite, allow_negative_numbers = true, conflicts_with = "exposure")]
    ev100: Option<f32>,
    /// Pixels per degree of the viewer's field, for FLIP; 0.7 m before a screen of 3,840 pixels on 0.7 m by default
    #[arg(long, value_name = "X", default_value_t = PIXELS_PER_DEGREE, value_parser = pixels_per_degree)]
    ppd: f64,
    /// Most pixels of each picture, whatever its file's size; by default 8,388,608, or 64 a byte of a larger file.
    /// The comparison takes 120 to 150 bytes of memory a pixel
    #[arg(long, value_name = "N", value_parser = most_pixels)]
    max_pixels: Option<usize>,
    /// Exit code 1 if the mean of the metric is above this
    #[arg(long, value_name = "X", value_parser = limit)]
    fail_above: Option<f64>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// An error that a pixel can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Metric {
    /// LDR-FLIP at the exposure, from 0 to 1
    Flip,
    /// HDR-FLIP, from 0 to 1
    HdrFlip,
    /// Relative squared error, in colours from 1e-4 to 100
    RelMse,
    /// Squared error, in colours over six decades below the largest
    Mse,
}

/// The figures, as they are printed to JSON.
#[derive(Serialize)]
struct Report {
    reference: String,
    test: String,
    width: u32,
    height: u32,
    pixels: usize,
    masked: usize,
    not_finite: usize,
    mean_reference: f64,
    mean_test: f64,
    /// Test over reference; `null` where the reference is black.
    mean_ratio: Option<f64>,
    mse: f64,
    rel_mse: f64,
    rel_mse_trimmed: f64,
    rel_mse_epsilon: [f32; 3],
    pixels_per_degree: f64,
    exposure: f32,
    flip: Pool,
    /// `null` for PNG files.
    hdr_flip: Option<HdrFlip>,
}

#[derive(Serialize)]
struct Pool {
    mean: f64,
    weighted_median: f64,
    max: f64,
}

#[derive(Serialize)]
struct HdrFlip {
    #[serde(flatten)]
    pool: Pool,
    start_stops: f64,
    stop_stops: f64,
    exposures: u32,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let radiance = Format::of(&arguments.reference)? == Format::Exr;
    if Format::of(&arguments.test)? != Format::of(&arguments.reference)? {
        let message = "one picture is EXR (radiance), the other PNG (displayed values): two of a kind are right";
        return Err(Error::Invalid(message.into()).into());
    }
    let given = arguments.ev100.map(colour::exposure).or(arguments.exposure);
    let default = if radiance && given.is_none() { Metric::HdrFlip } else { Metric::Flip };
    let metric = arguments.metric.unwrap_or(default);
    if metric == Metric::HdrFlip && !radiance {
        return Err(Error::Invalid("HDR-FLIP is of radiance: EXR files are right".into()).into());
    }
    arguments.output.as_deref().map_or(Ok(()), check_output)?;

    let read = |path: &Path| image::read_within(path, arguments.max_pixels);
    let reference = read(&arguments.reference)?;
    let (width, height) = (reference.width, reference.height);
    let test = read(&arguments.test)?;
    let mask = arguments.mask.as_deref().map(read).transpose()?;
    let pair = Pair::new(&reference, &test, mask.as_ref())?;
    // Of large pictures that is much.
    drop((reference, test, mask));
    if pair.not_finite() > 0 {
        say(&format!("{} pixels are not finite and left out", pair.not_finite()));
    }
    let exposure = given.unwrap_or(1.0);
    let flip = pair.flip(exposure, arguments.ppd);
    let hdr = radiance.then(|| {
        let exposures = pair.exposures();
        (exposures, pair.hdr_flip(exposures, arguments.ppd))
    });
    let named = |path: &Path| path.display().to_string();
    let errors = pair.errors();
    let [mean_reference, mean_test] = errors.mean;
    let report = Report {
        reference: named(&arguments.reference),
        test: named(&arguments.test),
        width,
        height,
        pixels: pair.pixels(),
        masked: pair.masked(),
        not_finite: pair.not_finite(),
        mean_reference,
        mean_test,
        mean_ratio: (mean_reference != 0.0).then(|| mean_test / mean_reference),
        mse: errors.mse,
        rel_mse: errors.rel_mse.all,
        rel_mse_trimmed: errors.rel_mse.trimmed,
        rel_mse_epsilon: errors.epsilon.to_array(),
        pixels_per_degree: arguments.ppd,
        exposure,
        flip: Pool::of(&pair, &flip),
        hdr_flip: hdr.as_ref().map(|(exposures, map)| HdrFlip {
            pool: Pool::of(&pair, map),
            start_stops: exposures.start,
            stop_stops: exposures.stop,
            exposures: exposures.count,
        }),
    };
    print(&if arguments.json { format!("{}\n", serde_json::to_string_pretty(&report)?) } else { text(&report)? })?;

    let map = match (metric, hdr) {
        (Metric::HdrFlip, Some((_, map))) => map,
        (Metric::Flip | Metric::HdrFlip, _) => flip,
        (Metric::RelMse, _) => pair.relative_errors(),
        (Metric::Mse, _) => pair.squared_errors(),
    };
    if let Some(output) = &arguments.output {
        Map { width, height, values: &map, counted: pair.counted(), scale: scale(metric, &map) }.write(output)?;
    }
    let failed = arguments.fail_above.is_some_and(|limit| pair.pooled(&map).mean > limit);
    Ok(if failed { Outcome::CheckFailed } else { Outcome::Done })
}

impl Pool {
    fn of(pair: &Pair, map: &[f64]) -> Self {
        let Pooled { mean, weighted_median, max } = pair.pooled(map);
        Self { mean, weighted_median, max }
    }
}

fn text(r: &Report) -> Result<String, std::fmt::Error> {
    let mut out = String::new();
    writeln!(out, "{} against {}", r.test, r.reference)?;
    write!(out, "pixels      {} of {} x {}", r.pixels, r.width, r.height)?;
    writeln!(out, "; left out: {} masked, {} not finite", r.masked, r.not_finite)?;
    let ratio = r.mean_ratio.map_or_else(|| "none, black".to_owned(), |ratio| format!("{ratio:.5}"));
    writeln!(out, "luminance   mean {:.5e}, reference {:.5e}, ratio {ratio}", r.mean_test, r.mean_reference)?;
    writeln!(out, "MSE         {:.4e}", r.mse)?;
    let [red, green, blue] = r.rel_mse_epsilon;
    writeln!(
        out,
        "relMSE      {:.4e}, without the worst 0.1 % {:.4e} (epsilon {red:.3e}, {green:.3e}, {blue:.3e})",
        r.rel_mse, r.rel_mse_trimmed
    )?;
    writeln!(out, "FLIP        {} (exposure {})", pooled(&r.flip), r.exposure)?;
    if let Some(hdr) = &r.hdr_flip {
        let HdrFlip { pool, start_stops, stop_stops, exposures } = hdr;
        writeln!(
            out,
            "HDR-FLIP    {} ({exposures} exposures, {start_stops:.3} to {stop_stops:.3} stops)",
            pooled(pool)
        )?;
    }
    Ok(out)
}

fn pooled(pool: &Pool) -> String {
    let Pool { mean, weighted_median, max } = pool;
    format!("mean {mean:.5}, weighted median {weighted_median:.5}, max {max:.5}")
}

/// How the map of a metric is coloured.
fn scale(metric: Metric, map: &[f64]) -> Scale {
    match metric {
        Metric::Flip | Metric::HdrFlip => Scale::Unit,
        Metric::RelMse => Scale::Decades(RELATIVE_DECADES.0, RELATIVE_DECADES.1),
        Metric::Mse => {
            let largest = map.iter().copied().fold(f64::MIN_POSITIVE / SQUARE_DECADES, f64::max);
            Scale::Decades(SQUARE_DECADES * largest, largest)
        }
    }
}

fn pixels_per_degree(text: &str) -> Result<f64, String> {
    let right = 1.0..=MOST_PIXELS_PER_DEGREE;
    text.parse()
        .ok()
        .filter(|x| right.contains(x))
        .ok_or_else(|| format!("a number from 1 to {} is right", right.end()))
}

fn most_pixels(text: &str) -> Result<usize, String> {
    let right = 1..=MOST_PIXELS;
    text.parse()
        .ok()
        .filter(|n| right.contains(n))
        .ok_or_else(|| format!("a whole number from 1 to {MOST_PIXELS} is right"))
}

fn limit(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| *x >= 0.0).ok_or_else(|| "a number of 0 or more is right".into())
}
