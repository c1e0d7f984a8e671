//! What was measured against what, and what makes it doubtful: the lines above the tables of a scene.

use super::number::{digits, grouped, percent, short};
use super::order::{measured, ordered};
use crate::record::{Parameters, RunRecord, SceneRecord, Summary};
use std::fmt::Write;

/// What was measured against what, a line each.
pub(super) fn facts(run: &RunRecord, scene: &SceneRecord) -> Vec<String> {
    let SceneRecord { width, height, reference, .. } = scene;
    let share = |part: f64| percent(part, 1.0);
    let [red, green, blue] = scene.rel_mse_epsilon.map(short);
    let view = scene.view.as_ref().map(|view| format!(", view {view}")).unwrap_or_default();
    let mut facts = vec![
        format!("{} (hash {}, seed {}{view}), {} lights", scene.file, scene.hash, scene.seed, grouped(scene.lights)),
        format!(
            "{width} x {height} pixels: {} receivers, sky {} %, emitters {} %",
            grouped(scene.receivers),
            share(scene.sky_share),
            share(scene.emitter_share),
        ),
    ];
    facts.extend(scene.visits.as_deref().map(|visits| match visits {
        "bounce" => "receivers: in each pass what a ray meets that bounces off what another point of the pixel sees; each is \
                     arrived at once, and errors are of the choice of lights alone"
            .to_owned(),
        _ => "receivers: in each pass what another point of the pixel sees; each is arrived at once, and errors are of the \
              choice of lights alone"
            .to_owned(),
    }));
    if scene.pixels_measured < scene.receivers {
        facts.push(format!(
            "errors are taken at {} of the receivers, the same for all: a reference for more would take more work than its \
             bound; every image is rendered whole",
            grouped(scene.pixels_measured),
        ));
    }
    facts.push(format!("{} runs; relMSE with epsilon {red}, {green}, {blue} (red, green, blue)", run.repeats));
    facts.extend(parameters(run, scene.family.as_ref().unwrap_or(&scene.name)));
    let mut line = format!("reference: {}, {} shadow rays", reference.kind, grouped(reference.rays));
    _ = write!(line, ", {} CPU s{}", short(reference.cpu_s), if reference.cached { " (cached)" } else { "" });
    if reference.rel_mse > 0.0 {
        _ = write!(line, "; its own relMSE {}", short(reference.rel_mse));
    }
    facts.push(line);
    if !scene.shared.is_empty() {
        let shared: Vec<String> = scene.shared.iter().map(|w| format!("{} {}", w.what, short(w.wall_s))).collect();
        facts.push(format!("off the clock, shared by all strategies, wall seconds: {}", shared.join(", ")));
    }
    facts
}

/// How the parameters of the strategies were chosen for a scene, or for the replicates of one; nothing where none could be,
/// and in older records.
pub(super) fn parameters(run: &RunRecord, family: &str) -> Option<String> {
    match run.parameters.as_ref()? {
        Parameters::AsNamed => Some(
            "every strategy at its defaults or as named: an order can turn round where each is at its best (`--tune`)"
                .to_owned(),
        ),
        Parameters::Tuned(families) => {
            let own = families.iter().find(|own| own.family == family)?;
            let of = if own.cities == 1 { "city of another seed" } else { "cities of other seeds" };
            Some(format!("parameters found by tuning on {} {of} ({}); default rows beside them", own.cities, own.file))
        }
    }
}

/// What makes the figures of a scene doubtful.
pub(super) fn warnings(run: &RunRecord, scene: &SceneRecord) -> Vec<String> {
    let mut warnings = run.warnings.clone();
    if !run.finished {
        warnings.push("not finished: some strategies or runs are missing".to_owned());
    }
    warnings.extend(failures(scene));
    warnings.extend(doubt(scene));
    warnings.extend(blindness(scene));
    warnings
}

/// Strategies that failed.
fn failures(scene: &SceneRecord) -> Option<String> {
    named(scene, |s| s.error.is_some()).map(|names| format!("failed, without figures or rank: {names}"))
}

/// A reference whose own noise is not far below the best row's error.
fn doubt(scene: &SceneRecord) -> Option<String> {
    let chosen = scene.summaries.iter().filter(|s| s.chooses && measured(s) && s.rel_mse.mean > 0.0);
    let best = chosen.map(|s| s.rel_mse.mean).min_by(f64::total_cmp)?;
    // 100: the noise of the reference then adds at most 1 % to any error in the table.
    (100.0 * scene.reference.rel_mse > best).then(|| {
        let times = digits(best / scene.reference.rel_mse, 2);
        format!("the best error is only {times} times the reference's own: take errors near it with care")
    })
}

/// Strategies measured in so few or so noisy runs that a large bias of theirs would go unseen.
fn blindness(scene: &SceneRecord) -> Option<String> {
    // 10,000, the size of `downtown`: on larger scenes runs are dear, and the column of detectable bias has to do.
    if scene.lights > 10_000 {
        return None;
    }
    // 5 % of the image mean: what a strategy that drops one of twenty equal lights loses.
    let blind = named(scene, |s| measured(s) && s.detectable_bias > 0.05);
    blind.map(|names| format!("a bias of 5 % of the image mean could go unseen, for want of runs: {names}"))
}

/// The names of those that `is` holds for, in the order of the tables; none of none.
fn named(scene: &SceneRecord, is: impl Fn(&Summary) -> bool) -> Option<String> {
    let names: Vec<String> =
        ordered(scene).into_iter().filter(|s| is(s)).map(|s| format!("`{}`", s.strategy)).collect();
    (!names.is_empty()).then(|| names.join(", "))
}
