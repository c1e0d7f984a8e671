//! Does a sampler keep the promises that hold exactly?

use super::calls::{self, count_different};
use super::check::Check;
use super::impossible::{IDS, Impossible, VALID};
use super::moved::{MOVED, moved};
use super::observe::{Site, freedom};
use super::options::VerifyOptions;
use super::spread::spread;
use super::subject::Subject;
use super::truth::grey;
use super::weights::ROUNDING;
use crate::base::statistics::{sidak, student_quantile};
use crate::render::exact::shadowed;
use crate::render::film::Film;
use crate::render::passes::Plan;
use crate::scene::receiver::Receiver;
use crate::strategy::{Frame, Pick, PickBuffer};

/// The checks' names.
const SEED: &str = "same-seed";
const THREADS: &str = "threads";
const REPLAY: &str = "replay";
const ALLOCATION: &str = "allocation";
/// The checks that hold exactly.
pub(super) const NAMES: [&str; 8] = [IDS, VALID, SEED, THREADS, REPLAY, MOVED, ALLOCATION, RECIPROCAL];
pub(super) const PICKS: &str = "picks";
const RECIPROCAL: &str = "reciprocal";

/// f32 counts and weights; an entry of 10^-10 of a cumulative sum in f64 keeps five digits.
const RECIPROCAL_LIMIT: f64 = 1e-4;

/// Passes that are looked at.
const PASSES: u32 = 8;

/// Passes of the films that are compared with one another.
const FILM_PASSES: u32 = 3;

/// The first passes at each receiver, and at those that [`threads`] renders.
pub(super) fn impossible(subject: &Subject<'_>) -> Impossible {
    let (all, rendered) = (subject.frame, rendered(subject));
    let lights = subject.stage.scene().lights().len();
    let mut found = Impossible::default();
    for (frame, receivers, passes) in [(all, subject.receivers, PASSES), (&rendered, &rendered, FILM_PASSES)] {
        calls::visit(subject.sampler, Frame::new(frame, subject.key(0)), receivers, 0..passes, false, |i, _, call| {
            call.iter().for_each(|pick| {
                found.look(pick, receivers[i].pixel, lights);
            });
        });
    }
    if subject.stage.visits().moves() {
        // Films visit other places in each pass.
        let plan = plan(subject, subject.receivers);
        for visit in plan.visits(PASSES, &mut Film::new(subject.receivers.len())) {
            let frame = Frame::new(&visit.receivers, subject.key(0));
            calls::visit(subject.sampler, frame, &visit.receivers, visit.passes.clone(), false, |i, _, call| {
                call.iter().for_each(|pick| {
                    found.look(pick, visit.receivers[i].pixel, lights);
                });
            });
        }
    }
    found
}

fn plan<'s>(subject: &Subject<'s>, receivers: &'s [Receiver]) -> Plan<'s> {
    Plan { stage: subject.stage, receivers, sampler: subject.sampler, key: subject.key(0) }
}

/// The checks that need no statistics.
pub(super) fn exact(subject: &Subject<'_>) -> Vec<Check> {
    let mut checks = vec![same_seed(subject), threads(subject), replay(subject), moved(subject)];
    if let Some(counter) = subject.options.allocations {
        checks.push(allocation(subject, counter));
    }
    checks
}

/// The receivers that films are made of: more than one tile of 64.
fn rendered(subject: &Subject<'_>) -> Vec<Receiver> {
    spread(subject.frame, 80)
}

/// The same picks again from a new worker, from one that comes the other way round, and pass by pass.
fn same_seed(subject: &Subject<'_>) -> Check {
    let (frame, receivers) = (subject.frame, subject.receivers);
    let first = subject.calls(frame, receivers, 0..PASSES);
    let mut differ = count_different(&first, &subject.calls(frame, receivers, 0..PASSES));
    let backwards: Vec<Receiver> = receivers.iter().rev().copied().collect();
    let back = subject.calls(frame, &backwards, 0..PASSES);
    let turned: Vec<Vec<Pick>> = back.rchunks(PASSES as usize).flatten().cloned().collect();
    differ += count_different(&first, &turned);
    for pass in 0..PASSES {
        let alone = subject.calls(frame, receivers, pass..pass + 1);
        let among: Vec<Vec<Pick>> = first.iter().skip(pass as usize).step_by(PASSES as usize).cloned().collect();
        differ += count_different(&among, &alone);
    }
    let seed = subject.options.seed;
    let detail = format!("calls that differ when repeated, reversed or cut into passes; seed {seed}");
    Check::new(SEED, differ as f64, 0.0, detail)
}

/// One thread, two threads and a split of the passes: the same bytes.
fn threads(subject: &Subject<'_>) -> Check {
    let receivers = rendered(subject);
    let plan = plan(subject, &receivers);
    let film = |run: &dyn Fn(&mut Film)| {
        let mut film = Film::new(receivers.len());
        run(&mut film);
        film
    };
    let one = film(&|film| plan.run(FILM_PASSES, film));
    let split = film(&|film| {
        plan.run(1, film);
        plan.run(FILM_PASSES - 1, film);
    });
    let current = film(&|film| plan.run_parallel(FILM_PASSES, film));
    let mut differ = usize::from(one != split) + usize::from(one != current);
    match rayon::ThreadPoolBuilder::new().num_threads(2).build() {
        Ok(pool) => differ += usize::from(one != pool.install(|| film(&|film| plan.run_parallel(FILM_PASSES, film)))),
        Err(_) => differ += 1,
    }
    Check::new(THREADS, differ as f64, 0.0, "films that differ with threads or with a split of the passes, of 3".into())
}

/// The renderer's film against the same picks shaded one by one, every kind compiled in and every ray cast.
fn replay(subject: &Subject<'_>) -> Check {
    let (stage, receivers) = (subject.stage, subject.receivers);
    let plan = plan(subject, receivers);
    let (mut film, mut singly) = (Film::new(receivers.len()), Film::new(receivers.len()));
    plan.run(PASSES, &mut film);
    let lights = stage.scene().lights();
    for visit in plan.visits(PASSES, &mut singly) {
        // The film's frame is the receivers of a visit.
        let calls = subject.calls(&visit.receivers, &visit.receivers, visit.passes.clone());
        visit.onto(&mut singly, |sums| {
            for ((at, calls), sum) in visit.receivers.iter().zip(calls.chunks(visit.passes.len())).zip(sums) {
                for pick in calls.iter().flatten() {
                    let light = &lights[pick.light as usize];
                    let radiance = shadowed(stage, stage.light_sampling(), at, light, pick.uv, &mut 0);
                    *sum += radiance * f64::from(pick.weight);
                }
            }
        });
    }
    let mut worst = 0.0f64;
    for (wanted, found) in singly.image().into_iter().zip(film.image()) {
        let [wanted, found] = [wanted, found].map(|radiance| grey(radiance.as_dvec3()));
        worst = worst.max((found - wanted).abs() / wanted.max(f64::MIN_POSITIVE));
    }
    Check::new(REPLAY, worst, 1e-6, "greatest relative difference of the film from its picks shaded singly".into())
}

/// Allocations of a warm worker, by a counter of this thread's allocations.
fn allocation(subject: &Subject<'_>, counter: fn() -> u64) -> Check {
    let passes = 0..PASSES.min(subject.sampler.most_passes());
    let receivers = subject.receivers;
    let block = subject.sampler.begin(Frame::new(subject.frame, subject.key(0)), passes.clone());
    let found = allocations(counter, || {
        let (mut worker, mut buffer, passes) = (block.worker(false), PickBuffer::default(), passes.clone());
        move || worker.fill(receivers, passes.clone(), true, &mut buffer)
    });
    let calls = receivers.len() * passes.len();
    Check::new(ALLOCATION, found as f64, 0.0, format!("allocations of a warm worker in {calls} calls"))
}

/// Allocations that a piece of work makes when it is done again.
pub(crate) fn allocations<W: FnMut()>(counter: fn() -> u64, make: impl FnOnce() -> W) -> u64 {
    let mut work = make();
    work();
    work();
    let before = counter();
    work();
    counter() - before
}

/// The sum of the expected counts against the mean number of picks, at each receiver.
pub(super) fn picks(sites: &[Site<'_>], options: &VerifyOptions) -> Check {
    let limit = student_quantile(1.0 - 0.5 * sidak(options.level, sites.len()), freedom(sites));
    let mut worst = (0.0f64, None, String::new());
    for site in sites {
        let Some(counts) = site.expected() else { continue };
        let wanted: f64 = counts.iter().map(|&c| f64::from(c)).sum();
        let picks = site.picks();
        let error = (site.variance(picks, wanted, 1.0) + (ROUNDING * wanted).powi(2)).sqrt();
        let off = picks.mean - wanted;
        let t = if off == 0.0 { 0.0 } else { (off / error).abs() };
        if t.is_nan() || t > worst.0 {
            worst = (t, Some(site.at.pixel), format!(": {:.5} for {wanted:.5}", picks.mean));
        }
    }
    let detail = format!("greatest |t| of mean picks against expected ones{}, seed {}", worst.2, options.seed);
    Check::new(PICKS, worst.0, limit, detail).at(worst.1, None)
}

/// Each pick's weight against the reciprocal of its expected count, as independent picks have it.
pub(super) fn reciprocal(sites: &[Site<'_>]) -> Check {
    let mut worst =
        Check::new(RECIPROCAL, 0.0, RECIPROCAL_LIMIT, "greatest |weight x expected count - 1| of a pick".into());
    for site in sites {
        let (off, light) = site.worst_reciprocal;
        if off > worst.statistic {
            worst = Check::new(RECIPROCAL, off, RECIPROCAL_LIMIT, worst.detail).at(Some(site.at.pixel), Some(light));
        }
    }
    worst
}
