//! `citylights compare`: error against run time.

use super::progress::Progress;
use super::scene::{SceneOptions, pool, threads};
use super::{Outcome, command, print, say};
use crate::base::error::{Error, Result};
use crate::measure::compare::{Compared, Options, compare};
use crate::measure::environment;
use crate::measure::films::Films;
use crate::measure::plan::Budget;
use crate::measure::reference::{WORK_S, scene_hash};
use crate::peers::{self, Peer};
use crate::record::store::{RUN_FILE, RowWriter, create_folder, file_name, read_run, write_run};
use crate::record::{Machine, Row, RunRecord, SCHEMA};
use crate::report;
use crate::report::table;
use crate::scene::Scene;
use crate::strategy::registry::{Configured, STRATEGIES, parse_list};
use crate::visibility::stage::Stage;
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where finished tiles of references are kept.
pub(super) const CACHE: &str = "results/.references";

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene files: recipes (.toml) or glTF (.glb, .gltf)
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
    #[arg(long, value_name = "S", default_value = "1", value_parser = seconds)]
    seconds: f64,
    /// Independent runs
    #[arg(long, value_name = "K", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=256))]
    repeats: u32,
    /// Another renderer, on the exported scene, in the same table: mitsuba, cycles, cycles:light-tree=off; more than once
    /// for more than one. benches/peers/README.md says how to install them
    #[arg(long = "peer", value_name = "NAME")]
    peers: Vec<String>,
    /// The Python that has the peers; by default what CITYLIGHTS_PYTHON names, else benches/peers/.venv/bin/python where
    /// that is, else python3
    #[arg(long, value_name = "FILE")]
    peer_python: Option<PathBuf>,
    /// Seconds that a peer may take from one image to the next
    #[arg(long, value_name = "S", default_value = "1800", value_parser = seconds)]
    peer_patience: f64,
    /// The result folder; a new one under results/ by default. An interrupted comparison there is resumed
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Most work of a scene's reference, in nominal CPU seconds: 170 ns a shadow ray and 20 ns a light and receiver,
    /// whatever the machine takes. Where that is not enough, errors are taken at fewer receivers, 256 at least
    #[arg(long, value_name = "S", default_value_t = WORK_S, value_parser = seconds)]
    reference_work: f64,
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
    let peers = peers(&arguments.peers)?;
    let progress = Progress::new()?;
    let threads = arguments.threads.unwrap_or_else(|| environment::cores().min(2));
    pool(Some(threads))?.install(|| {
        // Every scene is read before anything is measured: a mistake in the last must not cost an hour.
        let scenes =
            arguments.scenes.iter().map(|file| arguments.scene_options.load(file)).collect::<Result<Vec<_>>>()?;
        let names: Vec<String> = scenes.iter().map(|scene| file_name(scene.name())).collect();
        if let Some(twice) = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
            return Err(
                Error::Invalid(format!("two scenes are named `{}`; rows could not be told apart", twice.1)).into()
            );
        }
        let asked = Asked { arguments, strategies: &strategies, peers: &peers, threads };
        let record = record(&asked, &scenes);
        if threads > environment::cores() {
            say(&format!(
                "{threads} runs side by side on {} cores: wall times will mean nothing",
                environment::cores()
            ));
        }
        let mut session = Session::open(arguments, record, &scenes)?;
        for (scene, file) in scenes.into_iter().zip(&arguments.scenes) {
            progress.scene(scene.name());
            let stage = arguments.scene_options.prepare(scene);
            session.scene(&stage, file, &asked, &progress)?;
        }
        session.finish()?;
        say(&format!("rows, tables and plots: {}", session.folder.display()));
        Ok(Outcome::Done)
    })
}

/// What the user asked for, understood.
struct Asked<'a> {
    arguments: &'a Arguments,
    strategies: &'a [Configured],
    peers: &'a [Peer],
    threads: u32,
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
    fn open(arguments: &Arguments, record: RunRecord, scenes: &[Scene]) -> Result<Self> {
        std::fs::create_dir_all(&arguments.cache).map_err(Error::io("create", &arguments.cache))?;
        if let Some(folder) = arguments.out.as_deref().filter(|folder| folder.join(RUN_FILE).exists()) {
            let earlier = read_run(folder)?;
            let (folder_name, begun) = (folder.display(), &earlier.command);
            if earlier.finished {
                let text = "holds a finished comparison; results are never overwritten: name another folder";
                return Err(Error::Invalid(format!("{folder_name} {text}")));
            }
            if (&earlier.plan, &earlier.machine, &earlier.revision) != (&record.plan, &record.machine, &record.revision)
            {
                let text = "with the same recipes, options, machine and revision, or name another folder";
                return Err(Error::Invalid(format!(
                    "{folder_name} holds another comparison, begun as `{begun}`; resume that, {text}"
                )));
            }
            let films = Films::of(folder);
            let (rows, before) = RowWriter::resume(folder, |row| films.has(&row.scene, &row.strategy, row.run))?;
            return Ok(Self { folder: folder.to_owned(), record, rows, before });
        }
        let folder = match &arguments.out {
            Some(folder) => {
                std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
                folder.clone()
            }
            None => {
                let names: Vec<&str> = scenes.iter().map(Scene::name).collect();
                create_folder(Path::new("results"), &record.date, &names.join("+"), &record.revision)?
            }
        };
        let rows = RowWriter::create(&folder)?;
        write_run(&folder, &record)?;
        Ok(Self { folder, record, rows, before: Vec::new() })
    }

    fn scene(&mut self, stage: &Stage, file: &Path, asked: &Asked<'_>, progress: &Progress) -> anyhow::Result<()> {
        let Asked { arguments, strategies, peers, threads } = *asked;
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
            reference_work_s: arguments.reference_work,
            cache: &arguments.cache,
            folder: &self.folder,
        };
        let file = file.display().to_string();
        let resumable = |error: &Error| {
            if matches!(error, Error::Interrupted) {
                let folder = self.folder.display();
                say(&format!("finished rows are in {folder}; the same command with --out {folder} goes on from there"));
            }
        };
        let compared = compare(stage, &file, &options, &self.before, &mut self.rows, progress);
        let Compared { mut scene, mut rows, truth, target } = compared.inspect_err(resumable)?;
        let options = peers::measure::Options {
            peers,
            python: &python(arguments.peer_python.as_deref()),
            spp: &sample_counts(arguments.budget.unwrap_or(64)),
            runs: arguments.repeats.min(PEER_RUNS),
            seed: arguments.seed,
            folder: &self.folder,
            patience: Duration::from_secs_f64(arguments.peer_patience),
        };
        let others = peers::measure::measure(&target, &truth, &options, &self.before, &mut self.rows, progress);
        let others = others.inspect_err(resumable)?;
        for summary in &others.summaries {
            if let Some(why) = summary.skipped.as_ref().or(summary.error.as_ref()) {
                say(&format!("peer `{}`: {why}", summary.strategy));
            }
        }
        scene.notes.extend(others.notes);
        scene.summaries.extend(others.summaries);
        rows.extend(others.rows);
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
        report::report(&self.folder)?;
        Films::of(&self.folder).remove()
    }
}

fn record(asked: &Asked<'_>, scenes: &[Scene]) -> RunRecord {
    let Asked { arguments, strategies, peers, .. } = *asked;
    let strategies: Vec<&str> = strategies.iter().map(Configured::name).collect();
    let scenes: Vec<String> = scenes.iter().map(scene_hash).collect();
    RunRecord {
        plan: format!(
            "scenes {}; strategies {}{}; budget {:?}, {} s; {} runs; seed {}; reference {} s; {}",
            scenes.join(" "),
            strategies.join(" "),
            peers.iter().map(|peer| format!("; peer {}", peer.name())).collect::<String>(),
            arguments.budget,
            arguments.seconds,
            arguments.repeats,
            arguments.seed,
            arguments.reference_work,
            arguments.scene_options.describe()
        ),
        schema: SCHEMA,
        command: command(),
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

/// Most runs of a peer: they are dear, and each is a whole image at every sample count.
const PEER_RUNS: u32 = 8;

fn peers(given: &[String]) -> Result<Vec<Peer>> {
    let peers = given.iter().map(|text| Peer::parse(text)).collect::<Result<Vec<_>>>()?;
    let twice = peers.iter().enumerate().find(|(i, peer)| peers[..*i].iter().any(|other| other.name() == peer.name()));
    match twice {
        Some((_, peer)) => Err(Error::Invalid(format!("the peer `{}` is named twice", peer.name()))),
        None => Ok(peers),
    }
}

/// Sample counts of a peer: powers of 4 up to `most`.
fn sample_counts(most: u32) -> Vec<u32> {
    (0..16).map(|power| 1 << (2 * power)).take_while(|&spp| spp <= most).collect()
}

/// The Python that peers are run with.
fn python(given: Option<&Path>) -> PathBuf {
    let own = || Some(PathBuf::from("benches/peers/.venv/bin/python")).filter(|file| file.exists());
    let named = given.map(Path::to_owned).or_else(|| std::env::var_os("CITYLIGHTS_PYTHON").map(PathBuf::from));
    named.or_else(own).unwrap_or_else(|| "python3".into())
}

/// Parses a number of CPU seconds.
pub(super) fn seconds(text: &str) -> std::result::Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| *x > 0.0 && *x <= 86_400.0)
        .ok_or_else(|| "a number above 0, at most 86400, is right".into())
}
