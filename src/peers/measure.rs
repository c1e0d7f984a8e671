//! A peer's images as rows, on the same receivers and against the same reference as those of the strategies.
//!
//! A script renders all its runs in one process: what is paid once is its set-up, and each image is rendered in one block.
//! Its time is its own CPU time; what exactly, its remarks say.

use super::agreement::{Agreement, SIDE};
use super::mask;
use super::script::{self, Call, Image, Line, Trouble};
use super::{CONTRACT, Peer};
use crate::base::claim::Claim;
use crate::base::error::{Error, Result};
use crate::base::file::write_whole;
use crate::base::random::RunKey;
use crate::export::export;
use crate::image::exr;
use crate::measure::curve::Curve;
use crate::measure::errors::Truth;
use crate::measure::experiment::Runs;
use crate::measure::headline::Entry;
use crate::measure::image_store::ImageStore;
use crate::measure::observer::Observer;
use crate::measure::summary::summarise;
use crate::measure::target::Target;
use crate::record::store::RowWriter;
use crate::record::{Interval, Kind, ResultFolder, Row, Summary};
use crate::visibility::stage::Stage;
use glam::Vec3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How peers are run.
pub(crate) struct PeerOptions<'a> {
    /// The peers.
    pub peers: &'a [Peer],
    /// The Python that has them.
    pub python: &'a Path,
    /// Sample counts, ascending, as many as the passes of a strategy: [`budgets`](crate::measure::plan::budgets).
    pub spp: &'a [u32],
    /// CPU seconds at which errors are given: those of the scene.
    pub times_s: &'a [f64],
    /// Independent runs.
    pub runs: u32,
    /// The user's seed.
    pub seed: u64,
    /// The result folder, a marked one.
    pub folder: &'a Path,
    /// Where the last image of each finished run is kept.
    pub films: &'a ImageStore,
    /// How long a script may say nothing.
    pub patience: Duration,
}

/// What peers came to on one scene.
#[derive(Default)]
pub(crate) struct Measured {
    /// All their rows.
    pub rows: Vec<Row>,
    /// One for each peer.
    pub summaries: Vec<Summary>,
    /// What a reader of the table must know.
    pub notes: Vec<String>,
}

/// Runs peers on the scene of a target. `truth` is that at its measured receivers. Rows go to `writer` as they come; `before` holds those of
/// finished runs, which are not repeated: runs whose image is kept (see [`ImageStore`]).
///
/// # Errors
/// A result folder that cannot be written, or whose folder `peers` is another's or in use; the user's wish to stop.
pub(crate) fn measure(
    target: &Target<'_>,
    truth: &Truth,
    options: &PeerOptions<'_>,
    before: &[Row],
    writer: &mut RowWriter,
    watch: &dyn Observer,
) -> Result<Measured> {
    if options.peers.is_empty() {
        return Ok(Measured::default());
    }
    let (stage, receivers) = (target.stage, target.measured());
    let places = mask::clear(stage, &receivers);
    let ground = Ground {
        stage,
        truth: truth.only(&places),
        pixels: places.iter().map(|&i| receivers[i].pixel).collect(),
        folder: options.folder.join("peers"),
        options,
    };
    let mut measured = Measured::default();
    for peer in options.peers {
        // Exported scenes, scripts and images lie there while they are needed.
        let scratch = ResultFolder::open(&ground.folder, Kind::Scratch)?;
        let mut session = Session::new(&ground, peer, before);
        watch.begin(&peer.name, session.images());
        let outcome = session.run(writer, watch);
        watch.end();
        discard(&scratch);
        let (summary, notes) = match outcome {
            Err(Trouble::Stop(error)) => return Err(error),
            Err(Trouble::Missing(why)) => {
                let skipped = format!("skipped: {why}; see src/peers/scripts/README.md");
                (Summary { skipped: Some(skipped), ..session.blank() }, Vec::new())
            }
            Err(Trouble::Failed(why)) => {
                // It is recorded: where this machine keeps its files is nobody's business.
                let why = why.replace(&format!("{}/", ground.folder.display()), "");
                let row = Row::failed(session.scene(), peer.name.clone(), session.next_run(), 0, why.clone());
                writer.write(&row)?;
                session.rows.push(row);
                (Summary { error: Some(why), ..session.blank() }, Vec::new())
            }
            Ok(()) => (session.summary(), session.notes(receivers.len())),
        };
        measured.rows.extend(session.rows);
        measured.summaries.push(summary);
        measured.notes.extend(notes);
    }
    Ok(measured)
}

/// Removes a scratch folder; one in which a process that was just stopped has a child that still writes, a moment later,
/// and if that is not enough it stays marked, for the next run to use.
fn discard(scratch: &ResultFolder) {
    for _ in 0..20 {
        if scratch.remove().is_ok() {
            return;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// What all peers share on a scene.
struct Ground<'a> {
    stage: &'a Stage,
    /// At the receivers that are compared.
    truth: Truth,
    /// The pixels of those.
    pixels: Vec<u32>,
    folder: PathBuf,
    options: &'a PeerOptions<'a>,
}

/// One peer at work.
struct Session<'a> {
    ground: &'a Ground<'a>,
    peer: &'a Peer,
    renderer: String,
    remarks: Vec<String>,
    rows: Vec<Row>,
    /// The last image of each finished run.
    images: BTreeMap<u32, Vec<Vec3>>,
}

impl<'a> Session<'a> {
    /// Takes over the finished runs of an interrupted comparison.
    fn new(ground: &'a Ground<'a>, peer: &'a Peer, before: &[Row]) -> Self {
        let mut session = Self {
            ground,
            peer,
            renderer: peer.name.clone(),
            remarks: Vec::new(),
            rows: Vec::new(),
            images: BTreeMap::new(),
        };
        let scene = session.scene();
        for run in 0..ground.options.runs {
            let rows: Vec<&Row> = before
                .iter()
                .filter(|r| r.scene == scene && r.strategy == peer.name && r.run == run && r.error.is_none())
                .collect();
            let last = session.last(run);
            let Some(film) = ground.options.films.load(&last, ground.pixels.len()) else { continue };
            if rows.len() == ground.options.spp.len() {
                session.rows.extend(rows.into_iter().cloned());
                session.images.insert(run, film);
            }
        }
        session
    }

    fn scene(&self) -> String {
        self.ground.stage.scene().name().to_owned()
    }

    /// The row of a run's largest sample count, without its numbers.
    fn last(&self, run: u32) -> Row {
        let spp = self.ground.options.spp.last().copied().unwrap_or(0);
        Row::blank(self.scene(), self.peer.name.clone(), run, spp)
    }

    /// The runs still to do, each with its seed.
    fn runs(&self) -> Vec<(u32, u32)> {
        let PeerOptions { runs, seed, .. } = *self.ground.options;
        // 31 bits: what every renderer takes.
        let seed = |run| (RunKey { seed, run }.stream(u32::MAX - 1, 0).bits() >> 33) as u32;
        (0..runs).filter(|run| !self.images.contains_key(run)).map(|run| (run, seed(run))).collect()
    }

    /// How many images are still to be made.
    fn images(&self) -> u64 {
        self.runs().len() as u64 * self.ground.options.spp.len() as u64
    }

    /// The first run that is not finished.
    fn next_run(&self) -> u32 {
        self.runs().first().map_or(0, |&(run, _)| run)
    }

    fn run(&mut self, writer: &mut RowWriter, watch: &dyn Observer) -> std::result::Result<(), Trouble> {
        let Ground { stage, folder, options, pixels, .. } = self.ground;
        if pixels.is_empty() {
            return Err(Trouble::Failed("no receiver is clear of emitters and silhouettes".into()));
        }
        let kind = self.peer.kind;
        let (scene, path) = (folder.join(kind.scene.1), folder.join(kind.script.0));
        let exported = export(stage.scene(), kind.scene.0, &scene).map_err(|error| failed(&error))?;
        exported.write()?;
        for (name, text) in [kind.script, CONTRACT] {
            write_whole(&folder.join(name), text.as_bytes())?;
        }
        self.remarks = exported.notes;
        let mut todo = self.runs();
        let seeds: Vec<u32> = todo.iter().map(|&(_, seed)| seed).collect();
        let call = Call {
            python: options.python,
            script: &path,
            scene: &scene,
            out: folder,
            spp: options.spp,
            seeds: &seeds,
            arguments: &self.peer.arguments,
            patience: options.patience,
        };
        let mut expected: Vec<(u32, u32)> =
            seeds.iter().flat_map(|&seed| options.spp.iter().map(move |&spp| (seed, spp))).collect();
        script::run(&call, watch, |line| {
            match line {
                Line::About { renderer, remarks } => {
                    self.renderer = renderer;
                    self.remarks.extend(remarks);
                }
                Line::Missing { why } => return Err(Trouble::Missing(why)),
                Line::Image(image) => {
                    let asked = expected.iter().position(|&(seed, spp)| (seed, spp) == (image.seed, image.spp));
                    let Some(asked) = asked else {
                        let Image { seed, spp, .. } = image;
                        return Err(Trouble::Failed(format!("gave an image nobody asked for: seed {seed}, {spp} spp")));
                    };
                    expected.swap_remove(asked);
                    let last = !expected.iter().any(|&(seed, _)| seed == image.seed);
                    let Some(run) = todo.iter().find(|&&(_, seed)| seed == image.seed).map(|&(run, _)| run) else {
                        return Ok(());
                    };
                    self.image(run, &image, last, writer)?;
                    todo.retain(|&(_, seed)| !last || seed != image.seed);
                    watch.advance(1);
                }
            }
            Ok(())
        })?;
        match expected.first() {
            None => Ok(()),
            Some((seed, spp)) => Err(Trouble::Failed(format!("gave no image of seed {seed} with {spp} spp"))),
        }
    }

    /// Takes in a finished image; the one that is the run's last is kept.
    fn image(
        &mut self,
        run: u32,
        image: &Image,
        last: bool,
        writer: &mut RowWriter,
    ) -> std::result::Result<(), Trouble> {
        let times = [image.setup_s, image.cpu_s, image.wall_s];
        if times.iter().any(|time| !(0.0..1e9).contains(time)) || image.cpu_s == 0.0 {
            return Err(Trouble::Failed(format!("gave times of {times:?} s")));
        }
        // Read and removed below: it must be one of the folder's own.
        if Path::new(&image.file).file_name() != Some(image.file.as_ref()) {
            return Err(Trouble::Failed(format!("gave `{}`, which is no plain file name", image.file)));
        }
        let path = self.ground.folder.join(&image.file);
        let picture = exr::read(&path, None).map_err(|error| failed(&error))?;
        let (width, height) = self.ground.stage.view().resolution();
        if (picture.width, picture.height) != (width, height) {
            let (w, h) = (picture.width, picture.height);
            return Err(Trouble::Failed(format!(
                "gave an image of {w} x {h} pixels where {width} x {height} are right"
            )));
        }
        let seen: Vec<Vec3> = self.ground.pixels.iter().map(|&i| Vec3::from(picture.pixels[i as usize])).collect();
        if seen.iter().any(|radiance| !radiance.is_finite()) {
            return Err(Trouble::Failed("gave an image with infinite or undefined radiance".into()));
        }
        std::fs::remove_file(&path).map_err(Error::io("remove", &path))?;
        let row = Row {
            setup_cpu_s: image.setup_s,
            cpu_s: image.cpu_s,
            wall_s: image.wall_s,
            ..Row::blank(self.scene(), self.peer.name.clone(), run, image.spp)
        };
        let row = self.ground.truth.errors(&seen).written_to(row);
        writer.write(&row)?;
        self.rows.push(row);
        if last {
            self.ground.options.films.save(&self.last(run), &seen)?;
            self.images.insert(run, seen);
        }
        Ok(())
    }

    fn blank(&self) -> Summary {
        Summary::blank(self.peer.name.clone(), Claim::External { renderer: self.renderer.clone() })
    }

    fn summary(&self) -> Summary {
        let PeerOptions { spp, times_s, .. } = *self.ground.options;
        let mut rows = self.rows.clone();
        rows.sort_by_key(|row| (row.passes, row.run));
        let runs = Runs { rows, images: self.images.values().cloned().collect() };
        let (mut summary, jackknife) = summarise(self.blank(), &self.ground.truth, &runs, spp);
        // Measured once, not once a run.
        summary.setup_cpu_s = Interval { mean: summary.setup_cpu_s.mean, low: f64::NEG_INFINITY, high: f64::INFINITY };
        // Read as the strategies are, at the same errors and times; but it says nothing of its bias, so it has no rank.
        Entry { summary: &mut summary, curve: Curve::of(&runs, spp), jackknife }.read_at(times_s);
        summary
    }

    /// What a reader must know, as lines under the scene.
    fn notes(&self, receivers: usize) -> Vec<String> {
        let Ground { truth, pixels, options, .. } = self.ground;
        let name = &self.peer.name;
        let mut notes = vec![format!(
            "`{name}`: {} runs; errors over {} of {receivers} receivers, those beside emitters and on silhouettes left out",
            options.runs,
            pixels.len(),
        )];
        notes.extend(self.remarks.iter().map(|remark| format!("`{name}`: {remark}")));
        let width = self.ground.stage.view().resolution().0;
        let places: Vec<(u32, u32)> = pixels.iter().map(|pixel| (pixel % width, pixel / width)).collect();
        let images: Vec<&[Vec3]> = self.images.values().map(Vec::as_slice).collect();
        if let Some(found) = Agreement::of(truth, &images, &places) {
            let Agreement { ratio, blocks, beyond_95, beyond_all, worst } = found;
            let worst =
                if beyond_all > 0 { format!(" (off by {:+.1} % at most)", 100.0 * worst) } else { String::new() };
            notes.push(format!(
                "`{name}` over the reference: mean {:.4} ± {:.4}; of {blocks} blocks of {SIDE} x {SIDE} pixels {:.1} % lie \
                 outside their 95 % interval and {beyond_all} outside the simultaneous 99 % one{worst}",
                ratio.mean,
                ratio.half_width(),
                100.0 * beyond_95 as f64 / blocks as f64,
            ));
        }
        notes
    }
}

fn failed(error: &Error) -> Trouble {
    Trouble::Failed(error.to_string())
}
