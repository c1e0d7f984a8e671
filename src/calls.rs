//! The main jobs as one call each, with their usual options.
//!
//! With options of their own, scenes are rendered by [`render`](crate::render) and strategies checked by
//! [`verify`](crate::verify); comparisons have theirs on the command line.

use crate::base::error::Result;
use crate::base::random::RunKey;
use crate::base::statistics::sidak;
use crate::image::Picture;
use crate::measure::clock::Cpu;
use crate::measure::compare::{self as comparison, ComparisonOptions};
use crate::measure::engine::Engine;
use crate::measure::image_store::ImageStore;
use crate::measure::observer::Unobserved;
use crate::measure::plan::Budget;
use crate::measure::reference::WORK_S;
use crate::record::SceneRecord;
use crate::record::store::RowWriter;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::render::picture::picture;
use crate::scene::{Parts, Scene};
use crate::strategy::{BuildContext, Configured};
use crate::verify::metamorphic::{self, Copies, Metamorphic};
use crate::verify::{self as checks, BY_CHANCE, Check, Verifier};
use crate::visibility::offset::Offset;
use crate::visibility::stage::{LeaveOut, Stage};
use std::path::Path;

/// The picture of a scene after so many passes, in cd/m^2.
///
/// # Errors
/// A strategy that cannot serve the scene.
pub fn render(strategy: &Configured, scene: Scene, passes: u32, seed: u64) -> Result<Picture> {
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    let key = RunKey { seed, run: 0 };
    let sampler = strategy.build(BuildContext { stage: &stage, seed })?;
    let mut film = Film::new(stage.receivers().len());
    Plan { stage: &stage, receivers: stage.receivers(), sampler: sampler.as_ref(), key }
        .run_parallel(passes, &mut film);
    let (width, height) = stage.view().resolution();
    Ok(Picture { width, height, pixels: picture(&stage, &film.image()) })
}

/// All checks of a strategy's contract on a scene; a right one fails any of them in one of a hundred seeds.
///
/// # Errors
/// A strategy that cannot serve the scene. One that breaks its contract is no error: look at [`Check::passed`].
pub fn verify(strategy: &Configured, scene: &Scene) -> Result<Vec<Check>> {
    let parts = scene.parts();
    let camera = parts.camera.shrunk(metamorphic::PIXELS);
    let stage = Stage::new(Scene::new(Parts { camera, ..parts })?, LeaveOut::Yes, Offset::SCALED);
    let by_chance = BY_CHANCE.len() + metamorphic::CHANCES;
    // A check fails only if it fails twice.
    let options = checks::VerifyOptions { level: sidak(0.01, by_chance).sqrt(), ..checks::VerifyOptions::default() };
    let mut found = Verifier::new(&stage, options).verify(strategy)?;
    let copies = Copies::new(scene, Offset::SCALED, stage.light_sampling())?;
    found.extend(Metamorphic::new(&copies, options.fewer()).verify(strategy)?);
    Ok(found)
}

/// Error against run time on a scene: 16 runs of up to 64 passes, two side by side. Rows and the cached reference go to
/// `folder`, which must exist and hold no rows yet.
///
/// # Errors
/// A folder that cannot be written, or that holds rows; a reference that its work does not suffice for. A strategy that fails a check is an
/// error in its own summary alone.
pub fn compare(strategies: &[Configured], scene: Scene, folder: &Path) -> Result<SceneRecord> {
    let stage = Stage::new(scene, LeaveOut::Yes, Offset::SCALED);
    let name = stage.scene().name();
    let clock = Cpu::new();
    let engine = Engine { clock: &clock, workers: 2, seed: 1 };
    let films = ImageStore::of(folder, name);
    let options = ComparisonOptions {
        scenes: 1,
        typed: &format!("citylights verify {name}"),
        strategies,
        budget: Budget::up_to(64, 1.0),
        repeats: 16,
        seed: 1,
        engine: &engine,
        reference_work_s: WORK_S,
        cache: folder,
        films: &films,
    };
    let mut rows = RowWriter::create(folder)?;
    let found = comparison::compare(&stage, name, &options, &[], &mut rows, &Unobserved)?.scene;
    films.remove()?;
    Ok(found)
}
