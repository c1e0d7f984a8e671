//! The main job: all strategies on one scene, interleaved, error against time.

use super::errors::Truth;
use super::films::Films;
use super::gate::Gate;
use super::observer::Observer;
use super::once::Once;
use super::oracle;
use super::plan::{self, Budget, Pilot};
use super::reference::{Reference, Wanted, scene_hash};
use super::summary::{blank, counts, summarise};
use super::target::Target;
use super::trials::shuffle;
use crate::base::error::{Error, Result};
use crate::base::random::RunKey;
use crate::record::store::RowWriter;
use crate::record::{ReferenceRecord, Row, SceneRecord, Summary};
use crate::strategy::Role;
use crate::strategy::registry::Configured;
use crate::visibility::stage::Stage;
use glam::Vec3;
use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// How a comparison is done.
pub struct Options<'a> {
    /// The strategies.
    pub strategies: &'a [Configured],
    /// What each may spend in one run.
    pub budget: Budget,
    /// Independent runs.
    pub repeats: u32,
    /// The user's seed.
    pub seed: u64,
    /// Runs side by side.
    pub threads: usize,
    /// Most counted work of a reference, in nominal CPU seconds.
    pub reference_work_s: f64,
    /// Folder of cached references.
    pub cache: &'a Path,
    /// The result folder.
    pub folder: &'a Path,
}

/// What a comparison found on one scene.
pub struct Compared<'a> {
    /// The frame, and where errors were taken.
    pub target: Target<'a>,
    /// The scene, with a summary of each strategy.
    pub scene: SceneRecord,
    /// All rows.
    pub rows: Vec<Row>,
    /// What errors were taken against, at the target's measured receivers.
    pub truth: Truth,
}

/// Compares strategies on a scene. Rows go to `rows` as they come; `before` holds those of finished runs, which are not
/// repeated: runs whose image is kept (see [`Films`]).
pub fn compare<'a>(
    stage: &'a Stage,
    file: &str,
    options: &Options<'_>,
    before: &[Row],
    rows: &mut RowWriter,
    watch: &dyn Observer,
) -> Result<Compared<'a>> {
    let target = Target::whole(stage);
    let pilots = pilots(&target, options, watch)?;
    let ladders: Vec<Vec<u32>> = options
        .strategies
        .iter()
        .zip(&pilots)
        .map(|(strategy, pilot)| ladder(strategy, pilot.as_ref().and_then(|p| p.as_ref().ok()), stage, options, before))
        .collect();
    let best = options.strategies.iter().zip(&pilots).zip(&ladders).filter_map(|((strategy, pilot), ladder)| {
        let pilot = pilot.as_ref()?.as_ref().ok().filter(|_| strategy.info().role == Role::Choosing)?;
        Some(pilot.expected_rel_mse(*ladder.last()?))
    });
    // A hundredth of the best row's error, with some room for the pilot's own noise; never below what f32 can hold.
    let own_rel_mse = best.fold(1e-2, f64::min).max(1e-8) / 150.0;
    let wanted = Wanted { work_s: options.reference_work_s, ..Wanted::new(own_rel_mse) };
    let (target, reference) = Reference::bounded(&target, wanted, options.cache, watch)?;
    let mut comparison = Comparison {
        target: &target,
        reference: &reference,
        options,
        ladders: &ladders,
        rows: Vec::new(),
        films: HashMap::new(),
    };
    comparison.run(before, rows, watch)?;

    let mut summaries: Vec<Summary> = options
        .strategies
        .iter()
        .zip(&pilots)
        .enumerate()
        .map(|(i, (strategy, pilot))| pilot.as_ref().map_or_else(|| blank(strategy), |p| comparison.summary(i, p)))
        .collect();
    let image = |index, run| comparison.films.get(&(index, run)).map(Vec::as_slice);
    let images = |index| (0..options.repeats).filter_map(|run| image(index, run)).collect();
    oracle::settle(&target, &reference.truth, options, images, &mut summaries, watch)?;
    let mut notes = stage.scene().notes().to_vec();
    notes.extend(reference.notes(&target, wanted));
    if !stage.needs().occlusion {
        notes.push("nothing can stand between a surface and a light: no shadow rays".into());
    }
    let left_out = stage.scene().lights().len() - stage.lights().len();
    if left_out > 0 {
        notes.push(format!("{left_out} lights face away from every visible point and were left out"));
    }
    let (scene, rows) = (record(&target, file, &reference, notes, summaries), comparison.rows);
    Ok(Compared { scene, rows, truth: reference.truth, target })
}

fn record(
    target: &Target<'_>,
    file: &str,
    reference: &Reference,
    notes: Vec<String>,
    summaries: Vec<Summary>,
) -> SceneRecord {
    let stage = target.stage;
    let (width, height) = stage.view().resolution();
    let (sky_share, emitter_share) = stage.view().shares();
    SceneRecord {
        name: stage.scene().name().to_owned(),
        file: file.to_owned(),
        hash: scene_hash(stage.scene()),
        seed: stage.scene().seed(),
        lights: stage.scene().lights().len() as u64,
        width,
        height,
        pixels_measured: target.places.len() as u64,
        receivers: stage.receivers().len() as u64,
        sky_share,
        emitter_share,
        rel_mse_epsilon: reference.truth.epsilon().as_dvec3().to_array(),
        reference: ReferenceRecord {
            kind: if reference.exact_sum { "exact sum" } else { "stratified" }.into(),
            rel_mse: reference.truth.own_rel_mse(),
            energy_error: reference.truth.own_energy_error(),
            rays: reference.rays,
            cpu_s: reference.cpu_s,
            cached: reference.cached,
            subset: target.is_subset(),
        },
        notes,
        summaries,
    }
}

/// One for each strategy; none for those that are not run against the clock.
fn pilots(target: &Target<'_>, options: &Options<'_>, watch: &dyn Observer) -> Result<Vec<Option<Result<Pilot>>>> {
    let few = target.thinned(plan::RECEIVERS);
    let rough = Reference::compute(&few, 1e-3, options.cache, watch)?.truth;
    watch.begin("checks and pilots", options.strategies.len() as u64);
    let gate = Gate::new(target.stage, options.strategies.len(), options.seed);
    let mut pilots = Vec::new();
    for strategy in options.strategies {
        watch.check()?;
        let pilot = || gate.pass(strategy).and_then(|()| Pilot::run(target, &rough, strategy, options.seed));
        pilots.push((!oracle::is_oracle(strategy)).then(pilot));
        watch.advance(1);
    }
    watch.end();
    Ok(pilots)
}

/// The budgets of a strategy: those of its finished runs where a comparison is resumed, or what its pilot says.
fn ladder(
    strategy: &Configured,
    pilot: Option<&Pilot>,
    stage: &Stage,
    options: &Options<'_>,
    before: &[Row],
) -> Vec<u32> {
    let finished = before.iter().filter(|row| row.scene == stage.scene().name() && row.strategy == strategy.name());
    match (finished.map(|row| row.passes).max(), pilot) {
        (Some(most), _) => (0..31).map(|rung| 1 << rung).take_while(|&passes| passes <= most).collect(),
        (None, Some(pilot)) => pilot.ladder(options.budget, options.repeats),
        (None, None) => Vec::new(),
    }
}

/// The runs of one scene.
struct Comparison<'a> {
    target: &'a Target<'a>,
    reference: &'a Reference,
    options: &'a Options<'a>,
    ladders: &'a [Vec<u32>],
    rows: Vec<Row>,
    /// The last image of each finished (strategy, run).
    films: HashMap<(usize, u32), Vec<Vec3>>,
}

/// What a worker reports.
enum Report {
    Row(Row),
    Finished { strategy: usize, run: u32, image: Vec<Vec3> },
    Failed(Error),
}

impl Comparison<'_> {
    fn run(&mut self, before: &[Row], writer: &mut RowWriter, watch: &dyn Observer) -> Result<()> {
        let films = Films::of(self.options.folder);
        let units = self.units(before, &films);
        watch.begin("runs", units.len() as u64);
        let next = AtomicUsize::new(0);
        let (send, receive) = mpsc::channel();
        let (this, units) = (&*self, &units);
        let (new_rows, new_films) = std::thread::scope(|scope| {
            for _ in 0..this.options.threads.clamp(1, units.len().max(1)) {
                let (send, next) = (send.clone(), &next);
                scope.spawn(move || {
                    while let Some(&(strategy, run)) = units.get(next.fetch_add(1, Ordering::Relaxed)) {
                        if let Err(error) = this.unit(strategy, run, &send, watch) {
                            // Nobody listens any more where the other end has failed first.
                            let _ = send.send(Report::Failed(error));
                            return;
                        }
                        watch.advance(1);
                    }
                });
            }
            drop(send);
            let (mut rows, mut images) = (Vec::new(), Vec::new());
            let mut first_failure = None;
            for report in receive {
                let stored = match report {
                    Report::Row(row) => {
                        let stored = writer.write(&row);
                        rows.push(row);
                        stored
                    }
                    Report::Finished { strategy, run, image } => {
                        let stored = films.save(this.scene(), this.options.strategies[strategy].name(), run, &image);
                        images.push(((strategy, run), image));
                        stored
                    }
                    Report::Failed(error) => Err(error),
                };
                if let Err(error) = stored {
                    first_failure.get_or_insert(error);
                    next.store(units.len(), Ordering::Relaxed);
                }
            }
            first_failure.map_or(Ok((rows, images)), Err)
        })?;
        watch.end();
        self.rows.extend(new_rows);
        self.films.extend(new_films);
        Ok(())
    }

    fn scene(&self) -> &str {
        self.target.stage.scene().name()
    }

    /// The (strategy, run) pairs still to do, in seeded random order; takes over what is finished.
    fn units(&mut self, before: &[Row], films: &Films) -> Vec<(usize, u32)> {
        let mut units = Vec::new();
        for (i, strategy) in self.options.strategies.iter().enumerate() {
            for run in 0..self.options.repeats {
                let Some(&last) = self.ladders[i].last() else { continue };
                let rows: Vec<&Row> = before
                    .iter()
                    .filter(|r| {
                        r.scene == self.scene() && r.strategy == strategy.name() && r.run == run && r.error.is_none()
                    })
                    .collect();
                let film = films.load(self.scene(), strategy.name(), run, self.target.places.len());
                match film.filter(|_| rows.iter().any(|row| row.passes == last)) {
                    Some(film) => {
                        self.rows.extend(rows.into_iter().cloned());
                        self.films.insert((i, run), film);
                    }
                    None => units.push((i, run)),
                }
            }
        }
        shuffle(&mut units, self.options.seed);
        units
    }

    /// One independent run of one strategy through all its budgets, on this thread.
    fn unit(&self, index: usize, run: u32, send: &mpsc::Sender<Report>, watch: &dyn Observer) -> Result<()> {
        let key = RunKey { seed: self.options.seed, run };
        let strategy = &self.options.strategies[index];
        let once = Once { target: self.target, truth: &self.reference.truth, strategy, key };
        let image = once.through(&self.ladders[index], |row| {
            send.send(Report::Row(row)).map_err(|_| Error::Interrupted)?;
            watch.check()
        })?;
        // A strategy that failed has its row and no image.
        let Some(image) = image else { return Ok(()) };
        send.send(Report::Finished { strategy: index, run, image }).map_err(|_| Error::Interrupted)
    }

    fn summary(&self, index: usize, pilot: &Result<Pilot>) -> Summary {
        let strategy = &self.options.strategies[index];
        let failed = |error: String| Summary { error: Some(error), ..blank(strategy) };
        let pilot = match pilot {
            Ok(pilot) => pilot,
            Err(error) => return failed(error.to_string()),
        };
        let Some(&last) = self.ladders[index].last() else {
            return Summary {
                skipped: Some(format!("skipped: about {:.2} s a pass", pilot.first_pass_s())),
                ..blank(strategy)
            };
        };
        let mine = self.rows.iter().filter(|row| row.strategy == strategy.name());
        if let Some(error) = mine.clone().find_map(|row| row.error.clone()) {
            return failed(error);
        }
        let mut rows: Vec<&Row> =
            mine.filter(|row| row.passes == last && self.films.contains_key(&(index, row.run))).collect();
        rows.sort_by_key(|row| row.run);
        let images: Vec<&[Vec3]> = rows.iter().map(|row| self.films[&(index, row.run)].as_slice()).collect();
        let blank = Summary { counts: counts(pilot.counts), ..blank(strategy) };
        summarise(blank, &self.reference.truth, &rows, &images)
    }
}
