//! `citylights compare`: error against run time.

use super::begun;
use super::folders::{CACHE, RESULTS};
use super::home::Home;
use super::outcome::Outcome;
use super::peer_options::PeerOptions;
use super::progress::Progress;
use super::replicates::{Entry, ReplicateOptions};
use super::scene::{SceneOptions, receivers};
use super::terminal::{print, say, width};
use super::threads::{pool, threads};
use super::tuning::{ByFamily, TuneOptions, Tuning};
use super::values::seconds;
use crate::base::claim::Claim;
use crate::base::error::{Error, Result};
use crate::measure::clock::Cpu;
use crate::measure::compare::{Compared, ComparisonOptions, compare};
use crate::measure::engine::Engine;
use crate::measure::image_store::ImageStore;
use crate::measure::plan::{Budget, budgets};
use crate::measure::reference::WORK_S;
use crate::measure::tuning_cities::{Ground, OWN_REL_MSE, PIXELS, Search, passes};
use crate::measure::work::RATES;
use crate::peers::{self, Peer};
use crate::record::environment;
use crate::record::store::{self, RowWriter, write_run};
use crate::record::{Kind, Parameters, ResultFolder, Row, RunRecord};
use crate::report;
use crate::report::{replicates, table};
use crate::strategy::Configured;
use crate::visibility::stage::Stage;
use crate::visibility::visits::Receivers;
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Args)]
pub(super) struct Arguments {
    /// The scene files: recipes (.toml) or glTF (.glb, .gltf)
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// The strategies, with parameters if any: uniform,influence-pick:picks=4; all by default
    #[arg(long, short, value_name = "A,B")]
    strategies: Option<String>,
    /// Most passes of a strategy in a run; budgets are 1, 4, 16 and so on up to it, each from nothing in one block. By
    /// default 64, and more for a strategy that needs them to see a bias of 5 % in the image's mean
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    budget: Option<u32>,
    /// Most counted work of a strategy in a run, in seconds at the committed rates: the same on every machine
    #[arg(long, value_name = "S", default_value = "1", value_parser = seconds)]
    seconds: f64,
    /// Independent runs
    #[arg(long, value_name = "K", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=256))]
    repeats: u32,
    #[command(flatten)]
    peers: PeerOptions,
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
    /// Which points the passes visit: what each pixel sees through its centre; spread: in each pass through another point
    /// of it; bounce: what a ray from there meets next, as in a path tracer. Where they move, each is arrived at once
    #[arg(long, value_name = "centre|spread|bounce", default_value = "centre", value_parser = receivers)]
    receivers: Receivers,
    /// Of many cities and views, the unbiased strategy that all others are held against: light-tree by default, or where that
    /// is not compared the first
    #[arg(long, value_name = "NAME")]
    base: Option<String>,
    #[command(flatten)]
    tuning: TuneOptions,
    #[command(flatten)]
    replicates: ReplicateOptions,
    #[command(flatten)]
    scene_options: SceneOptions,
}

pub(super) fn run(arguments: &Arguments, home: &Home<'_>) -> anyhow::Result<Outcome> {
    let contestants = arguments.tuning.contestants(arguments.strategies.as_deref(), home.registry)?;
    let strategies = &contestants.strategies[..];
    let peers = arguments.peers.peers(arguments.receivers.moves())?;
    let base = base(arguments, home, strategies)?;
    // A folder that cannot be used must not cost the reading of scenes.
    arguments.out.as_deref().map_or(Ok(()), |out| ResultFolder::check(out, Kind::Comparison))?;
    let progress = Progress::new()?;
    let threads = arguments.threads.unwrap_or_else(|| environment::cores().min(2));
    pool(Some(threads))?.install(|| {
        let scenes = arguments.replicates.entries(&arguments.scenes, &arguments.scene_options)?;
        let tuning = Tuning::new(&arguments.tuning, home.registry, &contestants, &scenes, arguments.receivers)?;
        let count = scenes.len();
        let asked = Asked { home, arguments, peers: &peers, threads, scenes: count };
        let plan = plan(&asked, &scenes, strategies) + &tuning.plan();
        let record = begun::record(home, plan, arguments.seed, arguments.repeats);
        let plan = base.iter().fold(record.plan.clone(), |plan, base| format!("{plan}; base {base}"));
        let record = RunRecord { base, plan, parameters: tuning.parameters(), ..record };
        if threads > environment::cores() {
            say(&format!(
                "{threads} runs side by side on {} cores: wall times will mean nothing",
                environment::cores()
            ));
        }
        let Some(mut session) = Session::open(arguments, record, &scenes)? else { return Ok(Outcome::Done) };
        progress.last_words(&kept(&session.folder));
        let tuned = session.tune(&tuning, &asked, &progress)?;
        for mut entry in scenes {
            let strategies = tuned.get(entry.group()).map_or(strategies, Vec::as_slice);
            progress.scene(&entry.name);
            let scene = entry.take()?;
            let stage = entry.options.prepare(scene, arguments.receivers);
            session.scene(&stage, &entry, strategies, &asked, &progress)?;
        }
        session.finish()?;
        print_families(&session.record)?;
        say(&format!("rows, tables and plots: {}", session.folder.path().display()));
        Ok(session.outcome())
    })
}

/// What the user asked for, understood.
struct Asked<'a> {
    home: &'a Home<'a>,
    arguments: &'a Arguments,
    peers: &'a [Peer],
    threads: u32,
    /// How many scenes are compared.
    scenes: usize,
}

/// A result folder being filled.
struct Session {
    folder: ResultFolder,
    record: RunRecord,
    rows: RowWriter,
    films: ImageStore,
    /// Rows of an interrupted comparison that is being resumed.
    before: Vec<Row>,
    /// Scenes on which nothing could be measured, and why.
    nothing: Vec<String>,
}

impl Session {
    /// Begins the comparison that `record` describes, or goes on with it where it was begun; one that has been finished
    /// is shown, and there is nothing to do.
    fn open(arguments: &Arguments, mut record: RunRecord, scenes: &[Entry]) -> anyhow::Result<Option<Self>> {
        let folder = match &arguments.out {
            Some(folder) => ResultFolder::open(folder, Kind::Comparison)?,
            None => {
                let names = arguments.replicates.folder_name(scenes);
                let RunRecord { date, revision, .. } = &record;
                ResultFolder::create(Path::new(RESULTS), date, &names, revision, Kind::Comparison)?
            }
        };
        std::fs::create_dir_all(&arguments.cache).map_err(Error::io("create", &arguments.cache))?;
        let films = ImageStore::of(folder.path(), &record.plan);
        match store::begun(folder.path(), &record)? {
            Some(earlier) if earlier.finished => {
                // Left by one that was killed at its very end.
                films.remove()?;
                return again(folder.path(), &earlier).map(|()| None);
            }
            Some(earlier) => (record.date, record.command) = (earlier.date, earlier.command),
            None => write_run(folder.path(), &record)?,
        }
        let (rows, before) = RowWriter::resume(folder.path())?;
        Ok(Some(Self { folder, record, rows, films, before, nothing: Vec::new() }))
    }

    /// The strategies of each family of scenes at the parameters that were found for it; none where nothing is tuned.
    fn tune(&mut self, tuning: &Tuning<'_>, asked: &Asked<'_>, progress: &Progress) -> anyhow::Result<ByFamily> {
        let Asked { home, arguments, threads, .. } = *asked;
        let clock = Cpu::new();
        let search = Search {
            engine: &Engine { clock: &clock, workers: threads as usize, seed: arguments.seed },
            time_s: arguments.tuning.tune_time,
            seed: arguments.seed,
            ground: Ground {
                passes: &passes(arguments.budget.unwrap_or(USUAL_PASSES), arguments.receivers.moves()),
                pixels: PIXELS,
                own_rel_mse: OWN_REL_MSE,
                reference_work_s: arguments.reference_work,
                cache: &arguments.cache,
            },
            program: home.foreign(),
        };
        let settled = tuning.settle(self.folder.path(), &search, arguments.receivers, progress);
        let (strategies, families) = settled.inspect_err(|error| self.resumable(error))?;
        if !families.is_empty() {
            self.record.parameters = Some(Parameters::Tuned(families));
            write_run(self.folder.path(), &self.record)?;
        }
        Ok(strategies)
    }

    /// Says how to go on, where somebody wished to stop.
    fn resumable(&self, error: &Error) {
        if matches!(error, Error::Interrupted) {
            say(&kept(&self.folder));
        }
    }

    fn scene(
        &mut self,
        stage: &Stage,
        entry: &Entry,
        strategies: &[Configured],
        asked: &Asked<'_>,
        progress: &Progress,
    ) -> anyhow::Result<()> {
        let Asked { home, arguments, peers, threads, scenes } = *asked;
        let clock = Cpu::new();
        let engine = Engine { clock: &clock, workers: threads as usize, seed: arguments.seed };
        let options = ComparisonOptions {
            typed: &format!(
                "{} verify {}{}",
                home.program.name,
                entry.options.typed(&entry.file),
                if arguments.receivers.moves() {
                    format!(" --receivers {}", arguments.receivers.name())
                } else {
                    String::new()
                }
            ),
            strategies,
            scenes,
            budget: Budget {
                usual_passes: arguments.budget.unwrap_or(USUAL_PASSES),
                most_passes: arguments.budget.unwrap_or(1 << 20),
                work_s: arguments.seconds,
            },
            repeats: arguments.repeats,
            seed: arguments.seed,
            engine: &engine,
            reference_work_s: arguments.reference_work,
            cache: &arguments.cache,
            films: &self.films,
        };
        let file = entry.file.display().to_string();
        let compared = compare(stage, &file, &options, &self.before, &mut self.rows, progress);
        let Compared { mut scene, mut rows, truth, target, nothing } =
            compared.inspect_err(|error| self.resumable(error))?;
        let peers = if nothing.is_some() { &[] } else { peers };
        self.nothing.extend(nothing.map(|why| format!("{}: {why}", scene.name)));
        let options = peers::measure::PeerOptions {
            peers,
            python: &arguments.peers.python(),
            spp: &budgets(arguments.budget.unwrap_or(USUAL_PASSES)).collect::<Vec<u32>>(),
            times_s: &scene.times_s,
            runs: arguments.repeats.min(PEER_RUNS),
            seed: arguments.seed,
            folder: self.folder.path(),
            films: &self.films,
            patience: Duration::from_secs_f64(arguments.peers.peer_patience),
        };
        let others = peers::measure::measure(&target, &truth, &options, &self.before, &mut self.rows, progress);
        let others = others.inspect_err(|error| self.resumable(error))?;
        for summary in &others.summaries {
            if let Some(why) = summary.skipped.as_ref().or(summary.error.as_ref()) {
                say(&format!("peer `{}`: {why}", summary.strategy));
            }
        }
        scene.family.clone_from(&entry.family);
        scene.view = entry.options.view().map(|view| view.name().to_owned());
        scene.notes.extend(others.notes);
        scene.summaries.extend(others.summaries);
        rows.extend(others.rows);
        self.record.scenes.push(scene);
        write_run(self.folder.path(), &self.record)?;
        // This scene is finished, even where others are still to come.
        let record = RunRecord { finished: true, ..self.record.clone() };
        if let Some(scene) = record.scenes.last() {
            print(&format!("{}\n", table(&record, scene, &rows, width())))?;
        }
        Ok(())
    }

    /// Says which strategies failed, a line each, and which scenes had nothing to measure: a table that holds one has
    /// failed.
    fn outcome(&self) -> Outcome {
        let mut outcome = if self.nothing.is_empty() { Outcome::Done } else { Outcome::CheckFailed };
        self.nothing.iter().for_each(|why| say(why));
        for scene in &self.record.scenes {
            for summary in scene.summaries.iter().filter(|s| !s.claim.is_external()) {
                if let Some(error) = &summary.error {
                    say(&format!("{}: `{}` failed: {error}", scene.name, summary.strategy));
                    outcome = Outcome::CheckFailed;
                }
            }
        }
        outcome
    }

    /// Writes what follows from the rows, then that the comparison is finished: a kill in between is made good by the
    /// same command.
    fn finish(&mut self) -> Result<()> {
        self.record.finished = true;
        self.rows.sync()?;
        let folder = self.folder.path();
        report::write(folder, &report::derive_all(folder, &self.record, &store::read_rows(folder)?.rows)?)?;
        write_run(folder, &self.record)?;
        self.films.remove()
    }
}

/// Where finished rows are, and how to go on.
fn kept(folder: &ResultFolder) -> String {
    let folder = folder.path().display();
    format!("finished rows are in {folder}; the same command with --out {folder} goes on from there")
}

/// Shows a finished comparison.
fn again(folder: &Path, record: &RunRecord) -> anyhow::Result<()> {
    let rows = store::read_rows(folder)?.rows;
    record.scenes.iter().try_for_each(|scene| print(&format!("{}\n", table(record, scene, &rows, width()))))?;
    print_families(record)?;
    let (folder, date) = (folder.display(), &record.date);
    say(&format!(
        "{folder} holds this comparison, finished ({date}); results are never overwritten: nothing was measured"
    ));
    Ok(())
}

/// Shows what all cities and views of a recipe say together.
fn print_families(record: &RunRecord) -> anyhow::Result<()> {
    replicates::texts(record, width()).into_iter().try_for_each(|text| print(&format!("{text}\n")))
}

/// All that decides the rows, but for tuning.
fn plan(asked: &Asked<'_>, scenes: &[Entry], strategies: &[Configured]) -> String {
    let Asked { arguments, peers, .. } = *asked;
    let strategies: Vec<&str> = strategies.iter().map(Configured::name).collect();
    let scenes: Vec<String> = scenes.iter().map(|scene| format!("{}={}", scene.name, scene.hash)).collect();
    format!(
        "scenes {}; strategies {}{}; budget {:?}, {} s at rates {}; reference {} s; {} runs; seed {}; {}; receivers {}",
        scenes.join(" "),
        strategies.join(" "),
        peers.iter().map(|peer| format!("; peer {}", peer.name())).collect::<String>(),
        arguments.budget,
        arguments.seconds,
        RATES,
        arguments.reference_work,
        arguments.repeats,
        arguments.seed,
        arguments.scene_options.describe(),
        arguments.receivers.name(),
    )
}

/// The strategy that others are held against over many cities and views.
fn base(arguments: &Arguments, home: &Home<'_>, strategies: &[Configured]) -> Result<Option<String>> {
    let unbiased = || strategies.iter().filter(|s| s.info().claim == Claim::Unbiased).map(Configured::name);
    let listed = || format!("one of {} is right", unbiased().collect::<Vec<_>>().join(", "));
    match &arguments.base {
        Some(_) if !arguments.replicates.are_wanted() => {
            Err(Error::Invalid("--base is for many cities or views: it needs --cities or --views".into()))
        }
        None if !arguments.replicates.are_wanted() => Ok(None),
        Some(given) => {
            let base = home.registry.parse(given)?;
            let found = unbiased().find(|name| *name == base.name()).map(str::to_owned);
            let refuse =
                || Error::Invalid(format!("--base `{given}` is no unbiased strategy that is compared; {}", listed()));
            found.map(Some).ok_or_else(refuse)
        }
        None => Ok(unbiased().find(|name| *name == BASE).or_else(|| unbiased().next()).map(str::to_owned)),
    }
}

/// See [`base`].
const BASE: &str = "light-tree";

/// Most passes of a run where nobody says otherwise and no bias asks for more.
const USUAL_PASSES: u32 = 64;

/// Most runs of a peer: they are dear, and each is a whole image at every sample count.
const PEER_RUNS: u32 = 8;
