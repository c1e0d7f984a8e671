//! The main job: all strategies on one scene, interleaved, error against time.

use super::curve::Curve;
use super::errors::Truth;
use super::experiment::{Experiment, Found, Keep, Runs};
use super::gate::Gate;
use super::headline::{self, Entry, Headline};
use super::image_store::ImageStore;
use super::observer::Observer;
use super::oracle;
use super::plan::{self, Pilot};
use super::reference::{self, Reference, Wanted, scene_hash};
use super::summary::{self, bias};
use super::target::Target;
use crate::base::claim::Claim;
use crate::base::error::Result;
use crate::base::statistics::sidak;
use crate::record::store::RowWriter;
use crate::record::{Interval, ReferenceRecord, Row, SceneRecord, SharedWork, Summary};
use crate::strategy::Configured;
use crate::visibility::stage::Stage;
use glam::Vec3;

pub(crate) use super::options::ComparisonOptions;

/// What a comparison found on one scene.
pub(crate) struct Compared<'a> {
    /// The scene, with a summary of each strategy.
    pub scene: SceneRecord,
    /// All rows.
    pub rows: Vec<Row>,
    /// The frame, and where errors were taken.
    pub target: Target<'a>,
    /// What they were taken against.
    pub truth: Truth,
    /// Why there was nothing to measure, if so: every summary is then of a strategy that was skipped.
    pub nothing: Option<String>,
}

/// Compares strategies on a scene. Rows go to `rows` as they come; `before` holds those of finished runs, which are not
/// repeated.
///
/// # Errors
/// A cache, rows or images that cannot be read or written; a reference whose halves are not independent; the user's
/// wish to stop. A strategy that fails is an error in its own summary alone.
pub(crate) fn compare<'a>(
    stage: &'a Stage,
    file: &str,
    options: &ComparisonOptions<'_>,
    before: &[Row],
    rows: &mut RowWriter,
    watch: &dyn Observer,
) -> Result<Compared<'a>> {
    let frame = Target::whole(stage);
    let pilots = pilots(&frame, options, watch)?;
    let ladder = |pilot: &Option<Trial>| {
        let pilot = pilot.as_ref().and_then(|pilot| pilot.as_ref().ok());
        pilot.map_or_else(Vec::new, |pilot| pilot.ladder(options.budget, options.repeats))
    };
    let mut ladders: Vec<Vec<u32>> = pilots.iter().map(ladder).collect();
    let most = reference::most_passes(&frame, options.reference_work_s);
    let cut = ladders.iter().flatten().any(|&passes| passes > most);
    ladders.iter_mut().for_each(|ladder| ladder.retain(|&passes| passes <= most));
    let wanted = Wanted { work_s: options.reference_work_s, ..Wanted::new(accuracy(options, &pilots, &ladders)) };
    let frame = frame.after(ladders.concat());
    let (target, reference) = Reference::bounded(&frame, wanted, options.cache, watch)?;
    if let Some(why) = nothing_lit(&target, &reference) {
        return Ok(unmeasured(target, file, reference, wanted, options, why));
    }

    let strategies: Vec<&Configured> = options.strategies.iter().collect();
    let experiment = Experiment {
        engine: options.engine,
        target: &target,
        truth: &reference.truth,
        strategies: &strategies,
        ladders: &ladders,
        runs: options.repeats,
        seed: options.seed,
    };
    let mut folder =
        Folder { scene: stage.scene().name(), films: options.films, before, rows, receivers: target.places.len() };
    let (runs, account) = experiment.run(&mut folder, watch)?;

    let mut summaries = Vec::new();
    let mut parts = Vec::new();
    for (((strategy, pilot), ladder), runs) in strategies.iter().zip(&pilots).zip(&ladders).zip(&runs) {
        let (summary, jackknife) = summary::of(strategy, pilot.as_ref(), ladder, runs, &reference.truth);
        summaries.push(summary);
        parts.push((Curve::of(runs, ladder), jackknife));
    }
    hold_to_claims(options, &mut summaries, &reference.truth, &runs);
    let entries =
        summaries.iter_mut().zip(parts).map(|(summary, (curve, jackknife))| Entry { summary, curve, jackknife });
    let headline = headline::settle(&mut entries.collect::<Vec<_>>());
    oracle::settle(&target, &reference.truth, options, &runs, &mut summaries, watch)?;

    let mut notes = notes(&target, &reference, wanted, account.stray_share());
    if cut {
        notes.push(format!(
            "no strategy goes beyond {most} passes: the truth at all that more of them visit would take more than {:.0} nominal CPU \
             s (--reference-work)",
            wanted.work_s
        ));
    }
    let scene = record(&target, file, &reference, &headline, notes, summaries);
    let rows = runs.into_iter().flat_map(|runs| runs.rows).collect();
    Ok(Compared { scene, rows, target, truth: reference.truth, nothing: None })
}

/// Why no error can be measured: the camera sees no surface, or no light reaches one that it sees.
fn nothing_lit(target: &Target<'_>, reference: &Reference) -> Option<String> {
    let (points, lights) = (target.places.len(), target.stage.scene().lights().len());
    let is_black = reference.truth.mean().iter().all(|&radiance| radiance == Vec3::ZERO);
    let moves = target.stage.visits().moves();
    if moves && target.budgets().is_empty() {
        // Nobody can afford a pass, and every row says so.
        return None;
    }
    let why = match (points, lights) {
        (0, _) => "the camera sees no surface".to_owned(),
        _ if !is_black => return None,
        (_, 0) => "the scene has no lights".to_owned(),
        _ if moves && reference.visits == 0.0 => {
            format!("no pass of the {points} pixels that were looked at meets a surface")
        }
        _ if moves => {
            format!("none of {lights} lights reaches what passes visit of the {points} pixels that were looked at")
        }
        _ => format!("none of {lights} lights reaches any of the {points} visible points that were looked at"),
    };
    Some(format!("nothing can be measured: {why}"))
}

/// A scene on which nothing was measured.
fn unmeasured<'a>(
    target: Target<'a>,
    file: &str,
    reference: Reference,
    wanted: Wanted,
    options: &ComparisonOptions<'_>,
    why: String,
) -> Compared<'a> {
    let skipped = |strategy| Summary { skipped: Some(why.clone()), ..summary::blank(strategy) };
    let summaries = options.strategies.iter().map(skipped).collect();
    let headline = Headline { times_s: Vec::new(), ranked_by: 0 };
    let mut notes = notes(&target, &reference, wanted, 0.0);
    notes.push(why.clone());
    let scene = record(&target, file, &reference, &headline, notes, summaries);
    Compared { scene, rows: Vec::new(), target, truth: reference.truth, nothing: Some(why) }
}

/// A pilot, or why there is none; nothing of what is not run against the clock.
type Trial = Result<Pilot>;

fn pilots(target: &Target<'_>, options: &ComparisonOptions<'_>, watch: &dyn Observer) -> Result<Vec<Option<Trial>>> {
    let few = target.thinned(plan::RECEIVERS).after([plan::PASSES]);
    let rough = Reference::compute(&few, 1e-3, options.cache, watch)?.truth;
    watch.begin("checks and pilots", options.strategies.len() as u64);
    let gate = Gate::new(target.stage, options.typed, options.strategies.len(), options.seed);
    let mut pilots = Vec::new();
    for strategy in options.strategies {
        watch.check()?;
        let pilot = || -> Trial {
            gate.pass(strategy)?;
            let pilot = options.engine.alone(|meter| Pilot::run(target, &rough, strategy, options.seed, meter))??;
            gate.charged(strategy, pilot.account)?;
            Ok(pilot)
        };
        pilots.push((!oracle::is_oracle(strategy)).then(pilot));
        watch.advance(1);
    }
    watch.end();
    Ok(pilots)
}

/// The relMSE of its own that a reference may have: a hundredth of the best row's error, with some room for the pilot's
/// own noise; never below what f32 can hold.
fn accuracy(options: &ComparisonOptions<'_>, pilots: &[Option<Trial>], ladders: &[Vec<u32>]) -> f64 {
    let best = options.strategies.iter().zip(pilots).zip(ladders).filter_map(|((strategy, pilot), ladder)| {
        let pilot = pilot.as_ref()?.as_ref().ok().filter(|_| strategy.info().claim.chooses())?;
        Some(pilot.expected_rel_mse(*ladder.last()?))
    });
    best.fold(1e-2, f64::min).max(1e-8) / 150.0
}

/// The chance that any one of all right strategies is found biased on any of the scenes of a comparison.
const LEVEL: f64 = 0.01;

/// Gives every unbiased row an interval of its bias that holds for all of them together; one whose interval is off 0 has
/// failed.
fn hold_to_claims(options: &ComparisonOptions<'_>, summaries: &mut [Summary], truth: &Truth, runs: &[Runs]) {
    let held = |s: &Summary| s.claim == Claim::Unbiased && s.error.is_none() && s.mean_bias.is_bounded();
    let level = sidak(LEVEL, options.scenes * summaries.iter().filter(|s| held(s)).count());
    for (summary, runs) in summaries.iter_mut().zip(runs).filter(|(summary, _)| held(summary)) {
        let found = bias(truth.after(summary.passes), &runs.at(summary.passes), 1.0 - level);
        summary.simultaneous_bias = found;
        if !found.holds(0.0) {
            let Interval { mean, low, high } = found.times(100.0);
            summary.error = Some(format!(
                "biased: the image's mean is off by {mean:+.3} % ({low:+.3} % to {high:+.3} %, simultaneous 99 % interval); \
                 {} --seed {} --strategies {} --only image-mean",
                options.typed, options.seed, summary.strategy
            ));
        }
    }
}

/// Work beyond the workers' clocks that is worth a word, as a share of what the process spent.
const STRAY: f64 = 0.1;

fn notes(target: &Target<'_>, reference: &Reference, wanted: Wanted, stray: f64) -> Vec<String> {
    let stage = target.stage;
    let mut notes = stage.scene().notes().to_vec();
    notes.extend(reference.notes(target, wanted));
    if !stage.needs().occlusion {
        notes.push("nothing can stand between a surface and a light: no shadow rays".into());
    }
    let left_out = stage.scene().lights().len() - stage.lights().len();
    if left_out > 0 {
        notes.push(format!("{left_out} lights face away from every visible point and were left out"));
    }
    if stray > STRAY {
        notes.push(format!(
            "{:.0} % of the CPU time of the runs was spent on threads that are on no strategy's clock: some strategy works \
             behind its call",
            100.0 * stray
        ));
    }
    notes
}

fn record(
    target: &Target<'_>,
    file: &str,
    reference: &Reference,
    headline: &Headline,
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
        family: None,
        view: None,
        visits: stage.visits().moves().then(|| stage.visits().name().to_owned()),
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
        shared: stage
            .shared()
            .iter()
            .map(|part| SharedWork { what: part.part.to_owned(), wall_s: part.wall_s })
            .collect(),
        errors: headline::ERRORS.to_vec(),
        times_s: headline.times_s.clone(),
        ranked_by: headline.ranked_by as u32,
        notes,
        summaries,
    }
}

/// Rows and images of one scene in a result folder.
struct Folder<'a> {
    scene: &'a str,
    films: &'a ImageStore,
    before: &'a [Row],
    rows: &'a mut RowWriter,
    receivers: usize,
}

impl Keep for Folder<'_> {
    fn take(&mut self, strategy: &str, run: u32, passes: u32, with_image: bool) -> Result<Option<Found>> {
        let key = (self.scene, strategy, run, passes);
        let Some(row) = self.before.iter().find(|row| row.key() == key) else { return Ok(None) };
        let image = if with_image { self.films.load(row, self.receivers) } else { None };
        if row.error.is_some() || (with_image && image.is_none()) {
            self.rows.forget(|row| row.key() == key)?;
            return Ok(None);
        }
        Ok(Some((row.clone(), image)))
    }

    fn keep(&mut self, (row, image): &Found) -> Result<()> {
        // The image first: a row whose image is missing would have to be measured again.
        if let Some(image) = image {
            self.films.save(row, image)?;
        }
        self.rows.write(row)
    }
}
