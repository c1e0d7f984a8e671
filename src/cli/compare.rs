//! `citylights compare`: error against run time.

use super::progress::Progress;
use super::scene::{SceneOptions, pool, threads};
use super::{Outcome, print};
use crate::base::error::{Error, Result};
use crate::measure::compare::{Options, compare};
use crate::measure::environment;
use crate::measure::films::Films;
use crate::measure::plan::Budget;
use crate::record::store::{RowWriter, create_folder, read_run, write_run};
use crate::record::{Machine, Row, RunRecord, SCHEMA};
use crate::report;
use crate::report::table;
use crate::scene::Scene;
use crate::strategy::registry::{Configured, STRATEGIES, parse_list};
use crate::visibility::stage::Stage;
use clap::Args;
use std::path::{Path, PathBuf};

/// Where finished tiles of references are kept.
pub(super) const CACHE: &str = "results/.references";

#[derive(Args)]
pub(super) struct Arguments {
    /// The recipes
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// The strategies, with parameters if any: uniform,influence-pick:picks=4; all by default
    #[arg(long, short, value_name = "A,B")]
    strategies: Option<String>,
    /// Most passes of a strategy in a run; budgets double up to it. By default 64, and more for a strategy that needs
    /// them to see a bias of 5 % in the image's mean
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    budget: Option<u32>,
    /// Most CPU seconds of a strategy in a run
    #[arg(long, value_name = "S", default_value = "2", value_parser = seconds)]
    seconds: f64,
    /// Independent runs
    #[arg(long, value_name = "K", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    repeats: u32,
    /// The result folder; a new one under results/ by default. An interrupted comparison there is resumed
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder of finished tiles of references
    #[arg(long, value_name = "DIR", default_value = CACHE)]
    cache: PathBuf,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Runs side by side, each on one thread; 2 by default, or the number of cores where that is less
    #[arg(long, value_parser = threads)]
    threads: Option<u32>,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let every = STRATEGIES.iter().map(|entry| entry.info().name).collect::<Vec<_>>().join(",");
    let strategies = parse_list(arguments.strategies.as_deref().unwrap_or(&every))?;
    let progress = Progress::new()?;
    let threads = arguments.threads.unwrap_or_else(|| environment::cores().min(2));
    pool(Some(threads))?.install(|| {
        // Every recipe is read before anything is measured: a mistake in the last must not cost an hour.
        let scenes =
            arguments.scenes.iter().map(|file| arguments.scene_options.load(file)).collect::<Result<Vec<_>>>()?;
        let names: Vec<&str> = scenes.iter().map(Scene::name).collect();
        if let Some(twice) = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
            return Err(
                Error::Invalid(format!("two scenes are named `{}`; rows could not be told apart", twice.1)).into()
            );
        }
        let mut session = Session::open(arguments, &names)?;
        for (scene, file) in scenes.into_iter().zip(&arguments.scenes) {
            progress.scene(scene.name());
            let stage = arguments.scene_options.prepare(scene);
            session.scene(&stage, file, arguments, &strategies, threads, &progress)?;
        }
        session.finish()?;
        eprintln!("rows, tables and plots: {}", session.folder.display());
        Ok(Outcome::Done)
    })
}

/// A result folder being filled.
struct Session {
    folder: PathBuf,
    record: RunRecord,
    rows: RowWriter,
    /// Rows of an interrupted comparison that is being resumed.
    before: Vec<Row>,
}

impl Session {
    fn open(arguments: &Arguments, scenes: &[&str]) -> Result<Self> {
        let record = record(arguments);
        if let Some(folder) = arguments.out.as_deref().filter(|folder| folder.join("run.json").exists()) {
            let earlier = read_run(folder)?;
            if earlier.finished {
                return Err(Error::Invalid(format!(
                    "{} holds a finished comparison; results are never overwritten: name another folder",
                    folder.display()
                )));
            }
            if (earlier.seed, earlier.repeats) != (record.seed, record.repeats) || earlier.machine != record.machine {
                return Err(Error::Invalid(format!(
                    "{} holds another comparison, begun as `{}`; resume that, or name another folder",
                    folder.display(),
                    earlier.command
                )));
            }
            let (rows, before) = RowWriter::resume(folder)?;
            return Ok(Self { folder: folder.to_owned(), record, rows, before });
        }
        let folder = match &arguments.out {
            Some(folder) => {
                std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
                folder.clone()
            }
            None => create_folder(Path::new("results"), &record.date, &scenes.join("+"), &record.revision)?,
        };
        let rows = RowWriter::create(&folder)?;
        write_run(&folder, &record)?;
        Ok(Self { folder, record, rows, before: Vec::new() })
    }

    fn scene(
        &mut self,
        stage: &Stage,
        file: &Path,
        arguments: &Arguments,
        strategies: &[Configured],
        threads: u32,
        progress: &Progress,
    ) -> anyhow::Result<()> {
        let options = Options {
            strategies,
            budget: Budget {
                usual_passes: arguments.budget.unwrap_or(64),
                most_passes: arguments.budget.unwrap_or(1 << 20),
                seconds: arguments.seconds,
            },
            repeats: arguments.repeats,
            seed: arguments.seed,
            threads: threads as usize,
            cache: &arguments.cache,
            folder: &self.folder,
        };
        let file = file.display().to_string();
        let (scene, rows) =
            compare(stage, &file, &options, &self.before, &mut self.rows, progress).inspect_err(|error| {
                if matches!(error, Error::Interrupted) {
                    eprintln!(
                        "finished rows are in {0}; the same command with --out {0} goes on from there",
                        self.folder.display()
                    );
                }
            })?;
        self.record.scenes.push(scene);
        write_run(&self.folder, &self.record)?;
        // This scene is finished, even where others are still to come.
        let record = RunRecord { finished: true, ..self.record.clone() };
        if let Some(scene) = record.scenes.last() {
            print(&format!("{}\n", table(&record, scene, &rows)))?;
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.record.finished = true;
        write_run(&self.folder, &self.record)?;
        Films::of(&self.folder).remove()?;
        report::report(&self.folder).map(|_| ())
    }
}

fn record(arguments: &Arguments) -> RunRecord {
    RunRecord {
        schema: SCHEMA,
        command: std::iter::once("citylights".to_owned()).chain(std::env::args().skip(1)).collect::<Vec<_>>().join(" "),
        date: environment::date(),
        revision: environment::revision(),
        seed: arguments.seed,
        repeats: arguments.repeats,
        machine: Machine { cpu: environment::cpu(), cores: environment::cores(), os: environment::os() },
        compiler: environment::compiler(),
        flags: environment::flags(),
        warnings: environment::warnings(),
        finished: false,
        scenes: Vec::new(),
    }
}

fn seconds(text: &str) -> std::result::Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| *x > 0.0 && *x <= 86_400.0)
        .ok_or_else(|| "a number above 0, at most 86400, is right".into())
}
