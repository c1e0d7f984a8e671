//! `citylights study`: the experiments behind results/.

use super::folders::{CACHE, RESULTS};
use super::home::Home;
use super::outcome::Outcome;
use super::progress::Progress;
use super::terminal::{print, say, width};
use super::threads::{pool, threads};
use super::values::{resolution, seconds};
use crate::base::error::Error;
use crate::record::environment;
use crate::record::{Kind, ResultFolder};
use crate::report;
use crate::sources::Overrides;
use crate::study::{Entry, STUDIES, StudyOptions, find};
use clap::Args;
use std::cell::OnceCell;
use std::fmt::Display;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct Arguments {
    /// The study, or `all`: see `citylights list studies`
    #[arg(value_name = "NAME|all")]
    name: String,
    /// The strategies, with parameters if any, instead of the study's own (of `visible`, those of its sweep)
    #[arg(long, short, value_name = "A,B")]
    strategies: Option<String>,
    /// Scene files instead of the study's own; may be given more than once (`strategies`, `scaling` and `elsewhere`
    /// one, the sweep of `visible`)
    #[arg(long = "scene", value_name = "FILE")]
    scenes: Vec<PathBuf>,
    /// Seed of the cities, instead of the recipes'
    #[arg(long, value_name = "N")]
    scene_seed: Option<u64>,
    /// Pixels across and down, instead of the files'
    #[arg(long, value_name = "WxH", value_parser = resolution)]
    resolution: Option<(u32, u32)>,
    /// Receivers drawn by area of street and facade, for what needs no rays (`strategies`), or of all there is
    /// (`offsets`)
    #[arg(long, value_name = "N", default_value_t = 2_000, value_parser = clap::value_parser!(u32).range(2..=1 << 20))]
    receivers: u32,
    /// Most receivers of the frame that errors are taken at: by default 512, and of `scaling` all; fewer where their exact
    /// radiance takes too much work
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    pixels: Option<u32>,
    /// Most passes of a run
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    passes: u32,
    /// Most counted work of a strategy in a run, in seconds at the committed rates: the same on every machine. One that
    /// cannot do all passes in them does fewer: 1, 4, 16 and so on. Of `elsewhere` every run takes 0.1 times as long
    #[arg(long, value_name = "S", default_value = "1", value_parser = seconds)]
    seconds: f64,
    /// Independent runs; half as many of `elsewhere`
    #[arg(long, value_name = "K", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=256))]
    repeats: u32,
    /// Most lights of a series of growing scenes (`cutoff`, `scaling`, `visible`; of `elsewhere` 100,000 at most)
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(100..=10_000_000))]
    max_lights: u64,
    /// The result folder; a new one under results/ by default. With `all`, each study gets a folder in it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of finished tiles of references
    #[arg(long, value_name = "DIR", default_value = CACHE)]
    cache: PathBuf,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads, and runs side by side, each on one of them; 2 by default, or the number of cores where that is less
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
}

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let all = arguments.name == "all";
    let studies = if all { STUDIES.to_vec() } else { vec![find(&arguments.name)?] };
    // A folder that cannot be used must not cost the studies before it.
    if let Some(out) = &arguments.out {
        studies.iter().try_for_each(|study| ResultFolder::check(&folder(out, study, all), Kind::Study))?;
    }
    let progress = Progress::new()?;
    let options = options(arguments, home);
    pool(Some(options.threads as u32))?.install(|| {
        for study in studies {
            progress.scene(study.name);
            let made = OnceCell::new();
            let open = || {
                let folder = match &arguments.out {
                    Some(out) => ResultFolder::open(&folder(out, &study, all), Kind::Study)?,
                    None => {
                        let name = format!("study-{}", study.name);
                        let (date, revision) = (environment::date(), environment::revision());
                        ResultFolder::create(Path::new(RESULTS), &date, &name, &revision, Kind::Study)?
                    }
                };
                let path = made.get_or_init(|| folder.path().to_owned()).display();
                say(&format!("study {}: rows go to {path}", study.name));
                progress.last_words(&kept(path));
                Ok(folder)
            };
            let finished = study.run(&options, home.command(), &open, &progress).inspect_err(|error| {
                if let (Error::Interrupted, Some(path)) = (error, made.get()) {
                    say(&kept(path.display()));
                }
            })?;
            print(&format!("{}\n", report::study_text(&finished, width())))?;
            say(&format!("study {}: {:.0} s", study.name, finished.record.wall_s));
        }
        Ok(Outcome::Done)
    })
}

/// Where finished rows are, and how to go on.
fn kept(folder: impl Display) -> String {
    format!("finished rows are in {folder}; the same study with --out {folder} goes on from there")
}

/// The folder of a study where one is named; with `all` each has its own in there.
fn folder(out: &Path, study: &Entry, all: bool) -> PathBuf {
    if all { out.join(study.name) } else { out.to_owned() }
}

fn options(arguments: &Arguments, home: &Home<'_>) -> StudyOptions {
    let overrides = Overrides { seed: arguments.scene_seed, resolution: arguments.resolution, ..Overrides::default() };
    StudyOptions {
        registry: home.registry.clone(),
        program: home.foreign(),
        scenes: arguments.scenes.clone(),
        overrides,
        strategies: arguments.strategies.clone(),
        receivers: arguments.receivers as usize,
        pixels: arguments.pixels.map(|pixels| pixels as usize),
        passes: arguments.passes,
        seconds: arguments.seconds,
        repeats: arguments.repeats,
        max_lights: arguments.max_lights,
        seed: arguments.seed,
        threads: arguments.threads.unwrap_or_else(|| environment::cores().min(2)) as usize,
        cache: arguments.cache.clone(),
    }
}
